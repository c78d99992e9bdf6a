// SPDX-License-Identifier: Apache-2.0
// Kernel files: clrt's and the bench's own beside them.
#pragma once

#include "naive/naive_kernels.h"

#include <string>

namespace clrt {

/// The files below tools/bench/kernels, inside the program: entry points.
const KernelFiles& bench_kernel_files();

/// clrt's kernels, those inside the program or in a folder (empty: none), and the bench's own. Throws
/// SceneError for a folder without kernels.
KernelFiles all_kernel_files(const std::string& folder);

} // namespace clrt
