// SPDX-License-Identifier: Apache-2.0
// Scene text -> files in a scratch folder -> film.
#include "support/render_scene.h"

#include "app/progress.h"
#include "bvh/bvh.h"
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

const RenderPrograms& programs_for(const Options& options, u32 mask, BvhLayout layout) {
    using Key = std::tuple<Integrator, Precision, u32, BvhLayout>;
    // Never freed: at exit some drivers are gone before our statics.
    static auto* const programs = new std::map<Key, RenderPrograms>;
    const Key key{options.integrator, options.precision, mask, layout};
    const auto found = programs->find(key);
    if (found != programs->end())
        return found->second;
    Options with_kernels = options;
    const char* folder = std::getenv("CLRT_TEST_KERNELS");
    with_kernels.kernels_folder = folder ? folder : "";
    return programs->emplace(key, build_render_programs(test_device(), with_kernels, mask, layout))
        .first->second;
}

} // namespace

TestScene::TestScene() {
    options.size = {16, 16};
    options.spp = 1024;
    options.replicates = 64;
    options.all_effects = true;
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
    with_path.scene_path = folder.write("scene.obj", build.obj("scene.mtl", scale));
    Progress progress(Toggle::OFF, true);
    return load_scene(with_path, progress);
}

Render TestScene::render() const {
    return render_loaded(load(), options);
}

Render render_loaded(const Scene& scene, const Options& options) {
    const Device& device = test_device();
    const BvhLayout layout = choose_layout(options.bvh, device.info);
    const Bvh bvh = build_bvh(scene.positions, scene.triangles, layout,
                              choose_bvh_quality(options, scene.triangles.size()).quality);
    const RenderPrograms& programs = programs_for(options, find_effects(scene, options).mask, layout);
    const SceneBuffers buffers = upload_scene(device, scene, bvh);
    Progress progress(Toggle::OFF, true);
    return render(device, programs, buffers, scene, options, progress);
}

} // namespace clrt
