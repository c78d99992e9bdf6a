// SPDX-License-Identifier: Apache-2.0
// Scene text -> files in a scratch folder -> film.
#include "support/scratch_scene.h"

#include "bvh/bvh.h"
#include "console/progress.h"
#include "effects/take_out.h"
#include "render/bvh_quality.h"
#include "render/kernels.h"
#include "render/scene_buffers.h"
#include "scene/load_scene.h"
#include "scene/sky_table.h"

#include <fmt/format.h>
#include <OpenImageIO/imageio.h>
#include <stdexcept>

namespace clrt {

namespace {

/// The side of look_at_point's picture over the distance, as an angle in degrees.
constexpr double POINT_FOV_DEGREES = 0.0573;

template <typename T>
void write_texture(const std::string& path, int width, int height, int channels, const std::vector<T>& values,
                   OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(width, height, channels, type);
    spec["oiio:UnassociatedAlpha"] = 1;
    const auto output = OIIO::ImageOutput::create(path);
    if (values.size() != size_t(width) * size_t(height) * size_t(channels) || !output ||
        !output->open(path, spec) || !output->write_image(type, values.data()) || !output->close())
        throw std::runtime_error("cannot write the texture " + path);
}

/// The programs of options that name their kernels.
const RenderPrograms& programs_for(const ProbeDevice& device, const Options& options, const Effects& effects,
                                   BvhLayout layout) {
    const std::string key =
        fmt::format("render: {} {} {} {:#x} {} {} {}", int(options.transport.integrator),
                    int(options.device.precision), int(options.sampling.sampler), effects.mask, int(layout),
                    fmt::join(path_defines(effects.paths), " "), options.device.kernels_folder);
    return device.once<RenderPrograms>(
        key, [&] { return build_render_programs(device, options, effects.mask, layout, effects.paths); });
}

/// Takes out what the options leave out and renders; `programs(effects, layout)` gives the programs.
template <typename Programs>
Render render_by(const ProbeDevice& device, Scene& scene, Options& options, const Programs& programs) {
    options = with_kernels_of(device, options);
    tabulate_sky(scene.environment, integrator_row(options.transport.integrator).sky);
    const Effects effects = find_effects(scene, options);
    take_out_effects(effects.left_out, scene, options);
    const BvhLayout layout = choose_layout(options.bvh.layout, device.info);
    const Bvh bvh = build_bvh(scene.positions, scene.triangles, layout,
                              choose_bvh_quality(options, scene.triangles.size()).quality);
    const SceneBuffers buffers = upload_scene(device, scene, bvh);
    Progress progress(Toggle::OFF, true);
    return render(device, programs(effects, layout), buffers, scene, options, progress);
}

} // namespace

ScratchScene::ScratchScene() {
    options.film.size = {16, 16};
    options.sampling.spp = 1024;
    options.sampling.replicates = 64;
    options.effects.all = true;
    options.light.studio = false;
}

void ScratchScene::look(const glm::dvec3& eye, const glm::dvec3& at, double fov_degrees) {
    options.camera.eye = eye;
    options.camera.at = at;
    options.camera.fov_degrees = fov_degrees;
    const glm::dvec3 way = at - eye;
    if (way.x == 0 && way.z == 0) // along the default up
        options.camera.up = glm::dvec3(0, 0, -1);
}

void ScratchScene::look_at_point(const glm::dvec3& eye, const glm::dvec3& at) {
    look(eye, at, POINT_FOV_DEGREES);
}

void ScratchScene::texture(const std::string& name, int width, int height, int channels,
                           const std::vector<float>& values) {
    write_texture(folder.file(name), width, height, channels, values, OIIO::TypeDesc::FLOAT);
}

void ScratchScene::texture8(const std::string& name, int width, int height, int channels,
                            const std::vector<unsigned char>& values) {
    write_texture(folder.file(name), width, height, channels, values, OIIO::TypeDesc::UINT8);
}

Scene ScratchScene::load() const {
    folder.write("scene.mtl", build.mtl());
    Options with_path = options;
    with_path.scene.path = folder.write("scene.obj", build.obj("scene.mtl", scale));
    Progress progress(Toggle::OFF, true);
    Scene scene = load_scene(with_path, progress);
    tabulate_sky(scene.environment, integrator_row(options.transport.integrator).sky);
    return scene;
}

Render ScratchScene::render(const ProbeDevice& device) const {
    return render_loaded(device, load(), options);
}

Options with_kernels_of(const ProbeDevice& device, Options options) {
    if (options.device.kernels_folder.empty())
        options.device.kernels_folder = device.kernels_folder();
    return options;
}

Render render_loaded(const ProbeDevice& device, Scene scene, Options options) {
    return render_by(device, scene, options,
                     [&](const Effects& effects, BvhLayout layout) -> const RenderPrograms& {
                         return programs_for(device, options, effects, layout);
                     });
}

Render render_afresh(const ProbeDevice& device, Scene scene, Options options, bool* from_cache) {
    return render_by(device, scene, options, [&](const Effects& effects, BvhLayout layout) {
        RenderPrograms programs = build_render_programs(device, options, effects.mask, layout, effects.paths);
        *from_cache = programs.picture.from_cache;
        return programs;
    });
}

} // namespace clrt
