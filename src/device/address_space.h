// SPDX-License-Identifier: Apache-2.0
// Room under the limit of the process's address space (RLIMIT_AS, `ulimit -v`). Libraries that meet this
// limit do not report it: drivers of OpenCL abort or wait for ever, picture libraries abort before main()
// begins. So the room is asked for before they are.
#pragma once

#include <cstddef>

namespace clrt {

/// What the libraries that are linked take before main(): OpenImageIO's start four threads of a stack
/// (8 MiB by default) and a heap each.
constexpr size_t START_BYTES = size_t(128) << 20;

/// What opening a driver takes: PoCL 3.1 with LLVM 14 maps 300 MiB and compiles a kernel in another 100.
constexpr size_t DRIVER_BYTES = size_t(448) << 20;

/// What compiling a kernel takes once the driver is open.
constexpr size_t COMPILER_BYTES = size_t(160) << 20;

/// True if `bytes` more can be mapped, or if there is no limit.
bool has_address_space(size_t bytes);

/// Throws DeviceError if `bytes` more cannot be mapped; `whom` needs them.
void require_address_space(size_t bytes, const char* whom);

} // namespace clrt
