// SPDX-License-Identifier: Apache-2.0
// clrt's kernel files with a robust function replaced by the textbook's, to show what robustness costs and
// prevents.
#pragma once

#include "device/kernel_source.h"

#include <string>

namespace clrt {

/// Replaces the watertight triangle test by Moeller and Trumbore's; takes pad and exit factor off the
/// conservative box test, which makes plain slabs of it. Throws SceneError for kernels that define neither.
KernelFiles with_naive(KernelFiles files, bool triangle, bool box);

/// Replaces the offset by each hit's error bound by that of Waechter and Binder. Throws SceneError for
/// kernels without the function.
KernelFiles with_naive_offset(KernelFiles files);

/// Replaces part of a kernel file. Throws SceneError where `from` is not in it.
void replace_in_kernel(KernelFiles& files, const std::string& file, const std::string& from,
                       const std::string& to);

/// Writes kernel files into a folder, which is made, for --kernels.
void write_kernel_files(const KernelFiles& files, const std::string& folder);

} // namespace clrt
