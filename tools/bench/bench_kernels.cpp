// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_kernels.h"

namespace clrt {

KernelFiles all_kernel_files(const std::string& folder) {
    KernelFiles files = folder.empty() ? embedded_kernel_files() : read_kernel_files(folder);
    files.insert(bench_kernel_files().begin(), bench_kernel_files().end());
    return files;
}

} // namespace clrt
