// SPDX-License-Identifier: Apache-2.0
// A loaded scene with programs and buffers of its own, to be rendered again and again: on any device, by
// kernels whose text was changed.
#pragma once

#include "probes/scratch_scene.h"

#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// A place in the kernels and what stands there instead.
struct KernelPatch {
    std::string file; ///< below kernels/
    std::string from, to;
};

/// Kernels with patches, as a folder for --kernels. Throws where a text is not found.
class PatchedKernels {
public:
    PatchedKernels(KernelFiles files, const std::vector<KernelPatch>& patches);
    const std::string& path() const { return path_; }

private:
    ScratchFolder folder_;
    std::string path_;
};

class PreparedRender {
public:
    /// Takes the kernels of options.device.kernels_folder, else the device's. The device must outlive it.
    PreparedRender(const ProbeDevice& device, Scene scene, Options options)
        : prepared_(prepare_loaded(device, std::move(scene), std::move(options))) {}

    Render run() const { return render_silently(prepared_); }

private:
    PreparedScene prepared_;
};

} // namespace clrt
