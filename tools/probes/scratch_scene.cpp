// SPDX-License-Identifier: Apache-2.0
// Scene text -> files in a scratch folder -> film.
#include "probes/scratch_scene.h"

#include "console/progress.h"
#include "scene/load_scene.h"
#include "scene/sky_table.h"

#include <fmt/format.h>
#include <OpenImageIO/imageio.h>
#include <stdexcept>
#include <utility>

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

/// The programs of a plan, compiled once a device.
std::shared_ptr<const RenderPrograms> programs_for(const ProbeDevice& device, const PlannedScene& planned) {
    const Options& options = planned.options;
    const std::string key = fmt::format(
        "render: {} {} {} {} {:#x} {} {} {} {} {} {} {} {}", int(options.transport.integrator),
        options.transport.path_reuse == Toggle::ON, int(options.device.precision),
        int(options.sampling.sampler), planned.effects.mask,
        int(choose_layout(options.bvh.layout, device.info)), wants_layers(options), wants_mattes(options),
        fmt::join(path_defines(planned.effects.paths), " "),
        fmt::join(waiting_defines(options.transport), " "), fmt::join(vertex_defines(options.transport), " "),
        fmt::join(strategy_defines(options), " "), options.device.kernels_folder);
    return device.once<std::shared_ptr<const RenderPrograms>>(key,
                                                              [&] { return plan_programs(device, planned); });
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
    if (finish)
        finish(scene);
    tabulate_sky(scene.environment, integrator_row(options.transport.integrator).sky);
    return scene;
}

Render ScratchScene::render(const ProbeDevice& device) const {
    return render_loaded(device, load(), options);
}

std::shared_ptr<PlannedScene> plan_loaded(const ProbeDevice& device, Scene scene, Options options) {
    if (options.device.kernels_folder.empty())
        options.device.kernels_folder = device.kernels_folder();
    return plan_scene(std::move(scene), std::move(options));
}

PreparedScene prepare_loaded(const ProbeDevice& device, Scene scene, Options options) {
    return prepare_render(device, plan_loaded(device, std::move(scene), std::move(options)));
}

Render render_silently(const PreparedScene& prepared) {
    Progress silent(Toggle::OFF, true);
    return render(prepared, silent);
}

Render render_loaded(const ProbeDevice& device, Scene scene, Options options) {
    const auto planned = plan_loaded(device, std::move(scene), std::move(options));
    return render_silently(prepare_render(device, planned, {nullptr, programs_for(device, *planned)}));
}

Render render_afresh(const ProbeDevice& device, Scene scene, Options options, bool* from_cache) {
    const PreparedScene prepared = prepare_loaded(device, std::move(scene), std::move(options));
    *from_cache = prepared.programs->picture.from_cache;
    return render_silently(prepared);
}

} // namespace clrt
