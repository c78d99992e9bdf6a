// SPDX-License-Identifier: Apache-2.0
// Scene text -> files in a scratch folder -> film.
#include "support/render_scene.h"

#include "console/progress.h"
#include "scene/load_scene.h"
#include "support/kernel_probe.h"

#include <cstdlib>
#include <map>
#include <OpenImageIO/imageio.h>
#include <stdexcept>
#include <tuple>
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

/// Programs of the test device, compiled once a process.
std::shared_ptr<const RenderPrograms> programs_for(const PlannedScene& planned) {
    using Key = std::tuple<Integrator, Precision, SamplerChoice, u32, BvhLayout, std::vector<std::string>,
                           std::string, bool>;
    // Never freed: at exit some drivers are gone before our statics.
    static auto* const programs = new std::map<Key, std::shared_ptr<const RenderPrograms>>;
    const Options& options = planned.options;
    std::shared_ptr<const RenderPrograms>& made = (*programs)[{
        options.transport.integrator, options.device.precision, options.sampling.sampler,
        planned.effects.mask, choose_layout(options.bvh.layout, test_device().info),
        path_defines(planned.effects.paths), options.device.kernels_folder, wants_layers(options)}];
    if (!made)
        made = plan_programs(test_device(), planned);
    return made;
}

} // namespace

TestScene::TestScene() {
    options.film.size = {16, 16};
    options.sampling.spp = 1024;
    options.sampling.replicates = 64;
    options.effects.all = true;
    options.light.studio = false;
}

void TestScene::look(const glm::dvec3& eye, const glm::dvec3& at, double fov_degrees) {
    options.camera.eye = eye;
    options.camera.at = at;
    options.camera.fov_degrees = fov_degrees;
    const glm::dvec3 way = at - eye;
    if (way.x == 0 && way.z == 0) // along the default up
        options.camera.up = glm::dvec3(0, 0, -1);
}

void TestScene::look_at_point(const glm::dvec3& eye, const glm::dvec3& at) {
    look(eye, at, POINT_FOV_DEGREES);
}

void TestScene::texture(const std::string& name, int width, int height, int channels,
                        const std::vector<float>& values) {
    write_texture(folder.file(name), width, height, channels, values, OIIO::TypeDesc::FLOAT);
}

void TestScene::texture8(const std::string& name, int width, int height, int channels,
                         const std::vector<unsigned char>& values) {
    write_texture(folder.file(name), width, height, channels, values, OIIO::TypeDesc::UINT8);
}

Scene TestScene::load() const {
    folder.write("scene.mtl", build.mtl());
    Options with_path = options;
    with_path.scene.path = folder.write("scene.obj", build.obj("scene.mtl", scale));
    Progress progress(Toggle::OFF, true);
    return load_scene(with_path, progress);
}

Render TestScene::render() const {
    return render_loaded(load(), options);
}

std::shared_ptr<PlannedScene> plan_for_test(Scene scene, Options options) {
    const char* folder = std::getenv("CLRT_TEST_KERNELS");
    if (options.device.kernels_folder.empty() && folder)
        options.device.kernels_folder = folder;
    return plan_scene(std::move(scene), std::move(options));
}

PreparedScene prepare_for_test(Scene scene, Options options, const Device& device) {
    return prepare_render(device, plan_for_test(std::move(scene), std::move(options)));
}

Render render_silently(const PreparedScene& prepared) {
    Progress silent(Toggle::OFF, true);
    return render(prepared, silent);
}

Render render_loaded(Scene scene, Options options) {
    const auto planned = plan_for_test(std::move(scene), std::move(options));
    return render_silently(prepare_render(test_device(), planned, {nullptr, programs_for(*planned)}));
}

Render render_afresh(Scene scene, Options options, bool* from_cache) {
    const PreparedScene prepared = prepare_for_test(std::move(scene), std::move(options), test_device());
    *from_cache = prepared.programs->picture.from_cache;
    return render_silently(prepared);
}

} // namespace clrt
