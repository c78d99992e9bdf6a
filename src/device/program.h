// SPDX-License-Identifier: Apache-2.0
// Kernel programs: options, build with log, disk cache, arguments bound by name.
#pragma once

#include "device/device.h"
#include "device/opencl_error.h"
#include "options/device_options.h"

#include <map>
#include <string>
#include <type_traits>

namespace clrt {

/// Where compiled programs are kept and whether.
struct ProgramCache {
    Toggle use = Toggle::AUTO; ///< AUTO: off where the driver caches by itself (PoCL, NVIDIA)
    std::string folder;        ///< empty: $XDG_CACHE_HOME/clrt, else ~/.cache/clrt
};

/// What to compile. `defines` are "NAME=value"; they are sorted, so their order does not matter.
struct ProgramRequest {
    std::string name;   ///< for messages and dumped files, such as "path"
    std::string source; ///< expanded (kernel_source.h)
    std::vector<std::string> defines;
    Precision precision = Precision::SINGLE;
    bool warnings_are_errors = false; ///< for tests; other compilers than ours warn of other things
    std::string dump_folder; ///< empty: the source is dumped only on failure, to the temporary folder
    ProgramCache cache;
};

/// Argument positions by kernel name and argument name.
using KernelArguments = std::map<std::string, std::map<std::string, unsigned>>;

/// A built program and what building took.
struct Program {
    cl::Program handle;
    double seconds = 0;
    bool from_cache = false; ///< from our own cache; a driver's own cannot be seen
    std::string log;
    KernelArguments arguments;
};

/// The compiler options for a precision on a device (DESIGN.md section 4): -cl-std=CL1.2 -cl-kernel-arg-info,
/// correctly rounded division where listed, REAL_IS_DOUBLE / REAL_IS_FAST defines, relaxed maths instead of
/// it for FAST only. Throws DeviceError when DOUBLE is asked of a device without fp64.
std::string build_options(const DeviceInfo& device, Precision precision);

/// Where --dump-kernels writes a program: its source, and the options that it is compiled with.
struct DumpPaths {
    std::string source, options;
};
DumpPaths dump_paths(const std::string& folder, const std::string& program);

/// Builds or loads a program. Throws KernelBuildError with the compiler's log and the dumped source's path.
Program build_program(const Device& device, const ProgramRequest& request);

/// One kernel of a program whose arguments are set by name.
class Kernel {
public:
    /// Throws DeviceError when the program has no such kernel.
    Kernel(const Program& program, const std::string& name);

    /// Sets an argument. Throws DeviceError naming kernel and argument when there is none of that name or the
    /// value does not fit. A buffer is kept alive, which OpenCL itself does not do.
    template <class T>
    void set(const std::string& argument, const T& value) {
        check_opencl("setting argument " + argument + " of kernel " + name_,
                     [&] { handle_.setArg(position(argument), value); });
        if constexpr (std::is_same_v<T, cl::Buffer>)
            buffers_[argument] = value;
    }
    /// True if the kernel has an argument of that name.
    bool has(const std::string& argument) const;
    const cl::Kernel& handle() const { return handle_; }
    const std::string& name() const { return name_; }

private:
    unsigned position(const std::string& argument) const;
    cl::Kernel handle_;
    std::string name_;
    std::map<std::string, unsigned> positions_;
    std::map<std::string, cl::Buffer> buffers_;
};

} // namespace clrt
