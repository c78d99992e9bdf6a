// SPDX-License-Identifier: Apache-2.0
// Runs statements that read a scene: textures, surfaces, materials, lights, film positions. The kernel
// functions get a Scene and RenderParams of the test's own making.
#pragma once

#include "kernels/shared/render_types.h"
#include "probes/kernel_probe.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// One program of statement lists over a scene.
class SceneProbe {
public:
    /// `headers` by their path below kernels/; `text` stands between them and the kernels.
    SceneProbe(const ProbeDevice& device, std::vector<std::string> headers, const std::string& text = "",
               const ProbeOptions& options = {});

    /// Registers statements. They read `scene` and `params` (pointers), vec4 inputs a, b, c and the index i,
    /// and assign vec4 outputs first, second, third, which are 0 before.
    void add(const std::string& name, const std::string& statements);

    struct Outputs {
        std::vector<vec4> first, second, third;
    };

    /// Runs statements for every element of `a`; inputs that are not given read as 0.
    Outputs run(const std::string& name, const Scene& scene, const RenderParams& params,
                const std::vector<vec4>& a, std::vector<vec4> b = {}, std::vector<vec4> c = {});

private:
    const ProbeDevice& device_;
    KernelProbe probe_;
};

} // namespace clrt
