// SPDX-License-Identifier: Apache-2.0
// Kernel files: clrt's, the bench's own beside them, and the simpler variants that show what robustness
// costs.
#pragma once

#include "device/kernel_source.h"

#include <string>

namespace clrt {

/// The files below tools/bench/kernels, inside the program: bench/ are entry points, naive/ are variants.
const KernelFiles& bench_kernel_files();

/// clrt's kernels, those inside the program or in a folder (empty: none), and the bench's own. Throws
/// SceneError for a folder without kernels.
KernelFiles all_kernel_files(const std::string& folder);

/// Replaces the watertight triangle test by Moeller and Trumbore's; takes pad and exit factor off the
/// conservative box test, which makes plain slabs of it. Throws SceneError for kernels that define neither.
KernelFiles with_naive(KernelFiles files, bool triangle, bool box);

} // namespace clrt
