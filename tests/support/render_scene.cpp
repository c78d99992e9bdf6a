// SPDX-License-Identifier: Apache-2.0
// Scene text -> files in a scratch folder -> film.
#include "support/render_scene.h"

#include "bvh/bvh.h"
#include "console/progress.h"
#include "effects/take_out.h"
#include "render/bvh_quality.h"
#include "render/kernels.h"
#include "render/scene_buffers.h"
#include "scene/load_scene.h"
#include "support/kernel_probe.h"

#include <cstdlib>
#include <map>
#include <OpenImageIO/imageio.h>
#include <stdexcept>
#include <tuple>

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

RenderPrograms build_programs(Options options, const Effects& effects, BvhLayout layout) {
    const char* folder = std::getenv("CLRT_TEST_KERNELS");
    if (options.device.kernels_folder.empty() && folder)
        options.device.kernels_folder = folder;
    return build_render_programs(test_device(), options, effects.mask, layout, effects.paths);
}

const RenderPrograms& programs_for(const Options& options, const Effects& effects, BvhLayout layout) {
    using Key = std::tuple<Integrator, Precision, SamplerChoice, u32, BvhLayout, std::vector<std::string>,
                           std::string>;
    // Never freed: at exit some drivers are gone before our statics.
    static auto* const programs = new std::map<Key, RenderPrograms>;
    const Key key{options.transport.integrator,
                  options.device.precision,
                  options.sampling.sampler,
                  effects.mask,
                  layout,
                  path_defines(effects.paths),
                  options.device.kernels_folder};
    const auto found = programs->find(key);
    if (found != programs->end())
        return found->second;
    return programs->emplace(key, build_programs(options, effects, layout)).first->second;
}

/// Takes out what the options leave out and renders; `programs(effects, layout)` gives the programs.
template <typename Programs>
Render render_by(Scene& scene, Options& options, const Programs& programs) {
    const Device& device = test_device();
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

Render render_loaded(Scene scene, Options options) {
    return render_by(scene, options, [&](const Effects& effects, BvhLayout layout) -> const RenderPrograms& {
        return programs_for(options, effects, layout);
    });
}

Render render_afresh(Scene scene, Options options, bool* from_cache) {
    return render_by(scene, options, [&](const Effects& effects, BvhLayout layout) {
        RenderPrograms programs = build_programs(options, effects, layout);
        *from_cache = programs.picture.from_cache;
        return programs;
    });
}

} // namespace clrt
