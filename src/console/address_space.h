// SPDX-License-Identifier: Apache-2.0
// Room under the limit of the process's address space (RLIMIT_AS, `ulimit -v`). Libraries that meet this
// limit do not report it: drivers of OpenCL abort or wait for ever, picture libraries abort while they are
// loaded. So the room is asked for before they are.
#pragma once

#include <cstddef>
#include <string>

namespace clrt {

/// What loading OpenImageIO takes: its 250 libraries, and four threads of a stack (8 MiB by default) and a
/// heap each.
constexpr size_t IMAGE_LIBRARY_BYTES = size_t(512) << 20;

/// What opening a driver takes: PoCL 3.1 with LLVM 14 maps 300 MiB and compiles a kernel in another 100.
constexpr size_t DRIVER_BYTES = size_t(448) << 20;

/// What compiling a kernel takes once the driver is open.
constexpr size_t COMPILER_BYTES = size_t(160) << 20;

/// Why `whom` cannot get the `bytes` more that it needs, for a message; empty if they can be mapped or there
/// is no limit.
std::string address_space_obstacle(size_t bytes, const char* whom);

} // namespace clrt
