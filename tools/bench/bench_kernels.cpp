// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_kernels.h"

#include "error.h"

namespace clrt {

namespace {

/// Gives a macro another value.
void redefine(KernelFiles& files, const std::string& file, const std::string& macro,
              const std::string& value) {
    const auto found = files.find(file);
    const std::string start = "#define " + macro + " ";
    const size_t at = found == files.end() ? std::string::npos : found->second.find(start);
    if (at == std::string::npos)
        throw SceneError(file, 0,
                         "expected the line '" + start +
                             "...' in this kernel file, found none; give a folder "
                             "of kernels of this version to --kernels");
    std::string& text = found->second;
    text.replace(at, text.find('\n', at) - at, start + value);
}

} // namespace

KernelFiles all_kernel_files(const std::string& folder) {
    KernelFiles files = folder.empty() ? embedded_kernel_files() : read_kernel_files(folder);
    files.insert(bench_kernel_files().begin(), bench_kernel_files().end());
    return files;
}

KernelFiles with_naive(KernelFiles files, bool triangle, bool box) {
    if (triangle)
        files["geometry/triangle.h"] = bench_kernel_files().at("naive/triangle.h");
    if (box) {
        redefine(files, "geometry/box.h", "BOX_PAD_ROUNDINGS", "REAL(0.0)");
        redefine(files, "geometry/box.h", "BOX_EXIT_FACTOR", "REAL(1.0)");
    }
    return files;
}

} // namespace clrt
