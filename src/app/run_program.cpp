// SPDX-License-Identifier: Apache-2.0
#include "app/run_program.h"

#include "error.h"
#include "exit_code.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

namespace clrt {

namespace {

/// What oneTBB says where it cannot start another thread.
constexpr char NO_THREAD[] = "pthread_create has failed";

} // namespace

int run_program(const char* name, const std::function<int()>& program) {
    const auto report = [&](int code, const char* what) {
        std::fprintf(stderr, "%s: error: %s\n", name, what);
        return code;
    };
    try {
        const int code = program();
        // What was printed may still be in a buffer; a full disk shows now.
        if (std::fflush(stdout) == 0 && !std::ferror(stdout))
            return code;
        report(code, (std::string("cannot write to the standard output: ") + std::strerror(errno)).c_str());
        return code == EXIT_DONE ? EXIT_SCENE : code;
    } catch (const UsageError& error) {
        return report(EXIT_USAGE, error.what());
    } catch (const StoppedError& error) {
        return report(128 + error.signal_number, error.what());
    } catch (const SceneError& error) {
        return report(EXIT_SCENE, error.what());
    } catch (const DeviceError& error) {
        return report(EXIT_DEVICE, error.what());
    } catch (const std::bad_alloc&) {
        return report(EXIT_SCENE,
                      "not enough memory: expected a smaller scene, smaller textures or a smaller "
                      "--size; --crop renders a large picture in parts");
    } catch (const std::exception& error) {
        if (std::strncmp(error.what(), NO_THREAD, sizeof NO_THREAD - 1) == 0)
            return report(EXIT_SCENE, "not enough memory for another thread, or too many of them: expected "
                                      "higher limits (ulimit -v, ulimit -u) or a smaller -j");
        return report(EXIT_SCENE, error.what());
    }
}

} // namespace clrt
