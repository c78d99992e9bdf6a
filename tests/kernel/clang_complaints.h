// SPDX-License-Identifier: Apache-2.0
// What clang says about OpenCL C, for tests that need no device. CLRT_CLANG is the compiler.
#pragma once

#include "support/run_command.h"

#include <fmt/format.h>
#include <string>
#include <vector>

namespace clrt {

/// The programs of several integrators as one text: one run of the compiler checks them all. Each takes
/// integrators/entry_point.h, and the replay.h that builds with CLRT_TRACE have instead, anew; their
/// functions then have other names.
inline std::string entry_points(const std::vector<std::string>& integrators) {
    std::string text;
    for (const std::string& name : integrators) {
        for (const char* guard : {"CLRT_INTEGRATORS_ENTRY_POINT_H", "CLRT_INTEGRATORS_REPLAY_H",
                                  "INTEGRATOR_KERNEL", "INTEGRATOR_RADIANCE"})
            text += fmt::format("#undef {}\n", guard);
        for (const char* function : {"work_item_render", "trace_counter", "trace_film", "trace_finish",
                                     "replay_emission", "replay_sample", "replay_samples"})
            text += fmt::format("#undef {0}\n#define {0} {1}_{0}\n", function, name);
        text += fmt::format("#include \"integrators/{}.cl\"\n", name);
    }
    return text;
}

/// All that clang writes about a file of OpenCL C, compiled with further options: nothing if it takes it
/// without a warning. The file includes kernels by their path below kernels/.
inline std::string clang_complaints(const std::string& file, const std::vector<std::string>& options) {
    const std::string kernels = CLRT_KERNELS_FOLDER;
    std::vector<std::string> command = {CLRT_CLANG,
                                        "-x",
                                        "cl",
                                        "-Xclang",
                                        "-finclude-default-header",
                                        "-Xclang",
                                        "-fdeclare-opencl-builtins",
                                        "-Wall",
                                        "-Wextra",
                                        "-Werror",
                                        "-Wno-unused-parameter",
                                        "-Wno-unused-function",
                                        "-Wno-constant-logical-operand",
                                        "-I" + kernels,
                                        "-I" + kernels + "/integrators"};
    command.insert(command.end(), options.begin(), options.end());
    command.push_back(file);
    const CommandResult result = run_command(command);
    return result.exit_code == 0 && result.err.empty() ? "" : result.err + result.out + "(no success)";
}

} // namespace clrt
