// SPDX-License-Identifier: Apache-2.0
#include "app/run_program.h"

#include "error.h"
#include "exit_code.h"

#include <cstdio>
#include <new>

namespace clrt {

int run_program(const char* name, const std::function<int()>& program) {
    const auto report = [&](int code, const char* what) {
        std::fprintf(stderr, "%s: error: %s\n", name, what);
        return code;
    };
    try {
        return program();
    } catch (const UsageError& error) {
        return report(EXIT_USAGE, error.what());
    } catch (const SceneError& error) {
        return report(EXIT_SCENE, error.what());
    } catch (const DeviceError& error) {
        return report(EXIT_DEVICE, error.what());
    } catch (const std::bad_alloc&) {
        return report(EXIT_SCENE, "not enough memory");
    } catch (const std::exception& error) {
        return report(EXIT_SCENE, error.what());
    }
}

} // namespace clrt
