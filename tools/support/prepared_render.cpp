// SPDX-License-Identifier: Apache-2.0
#include "support/prepared_render.h"

#include "effects/take_out.h"
#include "render/bvh_quality.h"
#include "scene/sky_table.h"

#include <filesystem>
#include <stdexcept>

namespace clrt {

namespace {

Effects take_out_unwanted(Scene& scene, Options& options) {
    tabulate_sky(scene.environment, integrator_row(options.transport.integrator).sky);
    Effects effects = find_effects(scene, options);
    take_out_effects(effects.left_out, scene, options);
    return effects;
}

} // namespace

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

PreparedRender::PreparedRender(const ProbeDevice& device, Scene scene, Options options)
    : device_(device), scene_(std::move(scene)), options_(with_kernels_of(device, std::move(options))),
      effects_(take_out_unwanted(scene_, options_)),
      programs_(build_render_programs(device, options_, effects_.mask,
                                      choose_layout(options_.bvh.layout, device.info), effects_.paths)),
      bvh_(build_bvh(scene_.positions, scene_.triangles, choose_layout(options_.bvh.layout, device.info),
                     choose_bvh_quality(options_, scene_.triangles.size()).quality)),
      buffers_(upload_scene(device, scene_, bvh_)) {}

Render PreparedRender::run() const {
    Progress progress(Toggle::OFF, true);
    return render(device_, programs_, buffers_, scene_, options_, progress);
}

} // namespace clrt
