// SPDX-License-Identifier: Apache-2.0
// The identity of a film: the same for the same scene and options, another for whatever changes a bit.
#include "film/film_identity.h"

#include "console/progress.h"
#include "render/render_params.h"
#include "scene/load_scene.h"
#include "scene_support.h"

#include <functional>
#include <gtest/gtest.h>

namespace clrt {

namespace {

class FilmIdentityTest : public testing::Test {
protected:
    FilmIdentityTest() {
        write("s.mtl", "newmtl m\nKd 0.5 0.5 0.5\nnewmtl l\nKe 3 3 3\n");
        write("s.obj",
              "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl m\nf 1 2 3\nusemtl l\nf 1 2 4\n");
    }
    void write(const std::string& name, const std::string& text) const { folder.write(name, text); }
    Scene load(Options options = {}) const {
        options.scene.path = folder.path("s.obj");
        Progress progress(Toggle::OFF, true);
        return load_scene(options, progress);
    }
    FilmIdentity identity(const Options& options) const {
        const Scene scene = load(options);
        return film_identity(scene, options, make_render_params(scene, options, {1, 2}), {1, 2});
    }
    /// The field that tells changed options from the default ones.
    std::string field(const std::function<void(Options&)>& change) const {
        Options options;
        const FilmIdentity before = identity(options);
        change(options);
        const std::string difference = identity_difference(before, identity(options)).value_or("none");
        return difference.substr(0, difference.find(':'));
    }
    TemporaryFolder folder;
};

} // namespace

TEST_F(FilmIdentityTest, TheSameFilesHaveTheSameHash) {
    EXPECT_EQ(scene_hash(load()), scene_hash(load()));
    EXPECT_EQ(scene_hash(load()).size(), 32u);
}

TEST_F(FilmIdentityTest, EveryPartOfTheSceneIsInItsHash) {
    const Scene scene = load();
    const std::function<void(Scene&)> changes[] = {
        [](Scene& s) { s.positions[0].x += 1e-6f; },
        [](Scene& s) {
            s.normals.push_back({0, 1, 0, 0});
        },
        [](Scene& s) {
            s.position_moves.push_back({0, 1, 0, 0});
        },
        [](Scene& s) {
            s.normal_moves.push_back({0, 1, 0, 0});
        },
        [](Scene& s) { s.uvs.push_back(0); },
        [](Scene& s) { s.second_uvs.push_back(0); },
        [](Scene& s) { s.triangles[0].material = 1; },
        [](Scene& s) { s.triangles.pop_back(); },
        [](Scene& s) { s.materials[0].matte.x = 0.51f; },
        [](Scene& s) { s.textures.emplace_back(); },
        [](Scene& s) { s.texel_words.push_back(0); },
        [](Scene& s) { s.emitters[0].pdf_a *= 2; },
        [](Scene& s) { s.lights.emplace_back(); },
        [](Scene& s) { s.environment.texels.emplace_back(); },
        [](Scene& s) { s.environment.tiles.emplace_back(); },
        [](Scene& s) { s.environment.texel_format ^= 1; },
        [](Scene& s) { s.environment.radiance.y += 1; },
        [](Scene& s) { s.environment.rotation_degrees = 1; },
        [](Scene& s) { s.camera.eye.z += 1; },
        [](Scene& s) { s.camera.at.z += 1; },
        [](Scene& s) { s.camera.up.x += 1; },
        [](Scene& s) { s.camera.fov_degrees += 1; },
        [](Scene& s) { s.camera.projection = PROJECTION_ORTHOGRAPHIC; },
        [](Scene& s) { s.camera.ortho_height += 1; },
        [](Scene& s) { s.camera.shift.y += 1; },
        [](Scene& s) { s.camera.aperture += 1; },
        [](Scene& s) { s.camera.focus += 1; },
        [](Scene& s) { s.camera.blades += 1; },
        [](Scene& s) {
            s.camera.end = CameraPose{s.camera.eye, s.camera.at, s.camera.up};
        },
        [](Scene& s) { s.normalisation.scale *= 2; },
    };
    for (size_t i = 0; i < std::size(changes); ++i) {
        Scene changed = scene;
        changes[i](changed);
        EXPECT_NE(scene_hash(changed), scene_hash(scene)) << "change " << i;
    }
    Scene named = scene;
    named.material_names[0] = "other";
    named.notices.emplace_back("something");
    EXPECT_EQ(scene_hash(named), scene_hash(scene)) << "names change no pixel";
}

TEST_F(FilmIdentityTest, OptionsThatChangeThePictureAreFields) {
    EXPECT_EQ(field([](Options& o) { o.transport.integrator = Integrator::WHITTED; }), "integrator");
    EXPECT_EQ(field([](Options& o) { o.device.precision = Precision::DOUBLE; }), "precision");
    EXPECT_EQ(field([](Options& o) { o.sampling.seed = 1; }), "seed");
    EXPECT_EQ(field([](Options& o) { o.sampling.replicates = 8; }), "replicates");
    EXPECT_EQ(field([](Options& o) { o.film.crop = Crop{0, 0, 8, 8}; }), "window");
    EXPECT_EQ(field([](Options& o) { o.film.filter = Filter::TENT; }), "filter");
    EXPECT_EQ(field([](Options& o) { o.film.filter_radius = 0.7; }), "filter_radius");
    EXPECT_EQ(field([](Options& o) { o.scene.texture_filter = TextureFilter::FOOTPRINT; }), "texture_filter");
    EXPECT_EQ(field([](Options& o) { o.transport.max_depth = 5; }), "max_depth");
    EXPECT_EQ(field([](Options& o) { o.transport.roulette_depth = 9; }), "roulette_depth");
    for (const ErrorMeasure measure : {ErrorMeasure::MSE, ErrorMeasure::RELATIVE})
        EXPECT_EQ(field([&](Options& o) { o.sampling.adaptive = measure; }), "adaptive");
    EXPECT_EQ(field([](Options& o) { o.sampling.sampler = SamplerChoice::INDEPENDENT; }), "sampler");
    EXPECT_EQ(field([](Options& o) { o.sampling.light_sampler = LightSampler::POWER; }), "light_sampler");
    EXPECT_EQ(field([](Options& o) { o.transport.min_contribution = 0.1; }), "min_contribution");
    EXPECT_EQ(field([](Options& o) { o.transport.shadow_rays = 8; }), "shadow_rays");
    EXPECT_EQ(field([](Options& o) { o.transport.gloss_rays = 8; }), "gloss_rays");
    EXPECT_EQ(field([](Options& o) { o.transport.translucent_rays = 8; }), "translucent_rays");
    EXPECT_EQ(field([](Options& o) { o.transport.paths = "LDE"; }), "paths");
    EXPECT_EQ(field([](Options& o) { o.output.path_layers = {{"direct", "LDE"}}; }), "layers");
    EXPECT_EQ(field([](Options& o) { o.film.size = {800, 599}; }), "size");
    EXPECT_EQ(field([](Options& o) { o.camera.fov_degrees = 30; }), "scene");
    EXPECT_EQ(field([](Options& o) { o.camera.aperture = 0.1; }), "scene");
    EXPECT_EQ(field([](Options& o) { o.camera.end_eye = glm::dvec3(9); }), "scene");
    EXPECT_EQ(field([](Options& o) { o.light.environment = glm::dvec3(1); }), "scene");
}

TEST_F(FilmIdentityTest, OptionsThatChangeNoBitAreNone) {
    const std::function<void(Options&)> changes[] = {
        [](Options& o) { o.sampling.spp = 5; },          [](Options& o) { o.sampling.first_sample = 5; },
        [](Options& o) { o.sampling.time_seconds = 5; }, [](Options& o) { o.sampling.error = 0.5; },
        [](Options& o) { o.effects.all = true; },        [](Options& o) { o.bvh.layout = BvhLayout::BVH2; },
        [](Options& o) { o.device.threads = 1; },        [](Options& o) { o.output.exposure_ev = 1; },
        [](Options& o) { o.output.files = {"a.exr"}; },
    };
    for (size_t i = 0; i < std::size(changes); ++i)
        EXPECT_EQ(field(changes[i]), "none") << "change " << i;
}

} // namespace clrt
