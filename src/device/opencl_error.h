// SPDX-License-Identifier: Apache-2.0
// OpenCL's error codes as names, and its exceptions as DeviceError.
#pragma once

#include "device/opencl.h"
#include "error.h"

#include <string>

namespace clrt {

/// The name of an OpenCL error code, such as "CL_OUT_OF_RESOURCES"; "unknown error" for codes not in the
/// headers.
std::string opencl_error_name(int code);

/// "clCreateContext failed with CL_OUT_OF_HOST_MEMORY (-6) while opening the device".
std::string opencl_error_text(const cl::Error& error, const std::string& doing);

/// Runs `call` and returns its result; a cl::Error becomes a DeviceError that names the OpenCL function, the
/// error and what was being done. Every OpenCL call that can fail goes through here.
/// `doing` completes "while ...", such as "starting kernel render_path".
template <class Call>
auto check_opencl(const std::string& doing, Call&& call) {
    try {
        return call();
    } catch (const cl::Error& error) {
        throw DeviceError(opencl_error_text(error, doing));
    }
}

} // namespace clrt
