// SPDX-License-Identifier: Apache-2.0
#include "probes/prepared_render.h"

#include <filesystem>
#include <stdexcept>

namespace clrt {

PatchedKernels::PatchedKernels(KernelFiles files, const std::vector<KernelPatch>& patches) {
    for (const KernelPatch& patch : patches) {
        std::string& text = files[patch.file];
        const size_t place = text.find(patch.from);
        if (place == std::string::npos)
            throw std::runtime_error("kernels/" + patch.file + " has no text \"" + patch.from +
                                     "\" to replace");
        text.replace(place, patch.from.size(), patch.to);
    }
    path_ = std::filesystem::path(folder_.file("x")).parent_path().string();
    for (const auto& [name, text] : files) {
        std::filesystem::create_directories(std::filesystem::path(folder_.file(name)).parent_path());
        folder_.write(name, text);
    }
}

} // namespace clrt
