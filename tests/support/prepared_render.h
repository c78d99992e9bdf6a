// SPDX-License-Identifier: Apache-2.0
// A loaded scene with programs and buffers of its own, to be rendered again and again: on any device, by
// kernels whose text was changed.
#pragma once

#include "support/kernel_probe.h"
#include "support/render_scene.h"

#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// A place in the kernels and what stands there instead.
struct KernelPatch {
    std::string file; ///< below kernels/
    std::string from, to;
};

/// The kernels under test with patches, as a folder for --kernels. Throws where a text is not found.
class PatchedKernels {
public:
    explicit PatchedKernels(const std::vector<KernelPatch>& patches);
    const std::string& path() const { return path_; }

private:
    ScratchFolder folder_;
    std::string path_;
};

class PreparedRender {
public:
    /// Takes the kernels of options.device.kernels_folder, else those under test. The device must outlive it.
    PreparedRender(Scene scene, Options options, const Device& device = test_device())
        : prepared_(prepare_for_test(std::move(scene), std::move(options), device)) {}

    Render run() const { return render_silently(prepared_); }

private:
    PreparedScene prepared_;
};

} // namespace clrt
