// SPDX-License-Identifier: Apache-2.0
// Kernel source text: embedded in the binary, or from a folder, with includes expanded on the host (some
// drivers' caches do not see changed includes).
#pragma once

#include <map>
#include <string>

namespace clrt {

/// All kernel files by their path below kernels/, such as "numerics/real.h".
using KernelFiles = std::map<std::string, std::string>;

/// The files embedded at build time.
const KernelFiles& embedded_kernel_files();

/// Reads all *.h and *.cl below `folder`. Throws SceneError when there is none.
KernelFiles read_kernel_files(const std::string& folder);

/// Those of a folder, or the embedded ones where it is "".
KernelFiles kernel_files(const std::string& folder);

/// The text of `entry` (such as "integrators/path.cl") with every #include "..." replaced once by the file's
/// text (include guards are honoured by expanding a file only once), #line directives in between so that
/// compiler messages name the right file and line. Includes are relative to the including file or to
/// kernels/. Throws SceneError for a missing file, naming the including file and line.
std::string expand_kernel_source(const KernelFiles& files, const std::string& entry);

} // namespace clrt
