// SPDX-License-Identifier: Apache-2.0
// Pictures that must be the same to the last bit: two renders on one device in every test.
#include "kernels/shared/effects.h"
#include "probes/effect_masks.h"
#include "probes/film_estimate.h"
#include "probes/kernel_probe.h"
#include "probes/merl_file.h"
#include "probes/meshes.h"
#include "render/kernels.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A room of two colours with a lamp and a box: area lights, matte.
void make_lit_room(TestScene& scene) {
    scene.build.material("white", "Kd 0.7 0.7 0.7").material("red", "Kd 0.6 0.1 0.1");
    scene.build.material("lamp", "Kd 0 0 0\nKe 8 7 5");
    scene.build.use("white").box({-1, 0, -1}, {1, 2, 1}, Facing::INWARD);
    scene.build.use("lamp").polygon({{-0.4, 1.9, -0.4}, {0.4, 1.9, -0.4}, {0.4, 1.9, 0.4}, {-0.4, 1.9, 0.4}});
    scene.build.use("red").box({-0.5, 0.01, -0.5}, {0.1, 0.8, 0.2});
    scene.look({0.2, 1, 0.9}, {0, 0.7, -1}, 80);
}

/// A smooth ball of glass, a mirror and copper over a floor: sun, point and spot, refraction, mirror,
/// conductor, smooth normals.
void make_optics(TestScene& scene) {
    scene.build.material("white", "Kd 0.7 0.7 0.7").material("glass", "Ni 1.5\nTf 0.9 1 0.9\nillum 7");
    scene.build.material("mirror", "Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.7\nillum 3");
    scene.build.use("white").floor(4);
    scene.build.use("glass").icosphere({-0.5, 0.6, 0}, 0.5, 2, Facing::OUTWARD, Shading::SMOOTH);
    scene.build.use("mirror").box({0.3, 0.01, -0.6}, {1.1, 0.9, 0.2});
    scene.build.material("copper", "conductor copper").use("copper").box({-0.1, 0.01, 0.6}, {0.3, 0.3, 0.9});
    scene.options.light.suns.push_back({{1, 2, 1}, {3, 3, 2}, 3});
    scene.options.light.points.push_back({{-1, 2, 1}, {2, 2, 4}});
    scene.options.light.points.push_back({{1, 2, 1}, {4, 3, 2}, SpotCone{{-1, -2, -1}, 30, 10}, "--spot"});
    scene.look({0, 1.5, 3}, {0, 0.4, 0}, 45);
}

/// Everything that maps and rough lobes need, and a filter wider than a pixel.
void make_maps(TestScene& scene) {
    std::vector<unsigned char> colour, mask;
    std::vector<float> sky, normal;
    for (int i = 0; i < 64; ++i) {
        colour.insert(colour.end(),
                      {(unsigned char)(i * 97), (unsigned char)(i * 31), (unsigned char)(200 - i)});
        mask.push_back((unsigned char)(i * 53));
        normal.insert(normal.end(), {0.5f + 0.1f * float(i % 3), 0.5f - 0.1f * float(i % 2), 0.95f});
        sky.insert(sky.end(), {0.1f + float(i % 7), 0.3f, float(i % 5)});
    }
    scene.texture8("colour.png", 8, 8, 3, colour);
    scene.texture8("mask.png", 8, 8, 1, mask);
    std::vector<unsigned char> spots(64, 20);
    spots[9] = spots[44] = 255;
    scene.texture8("spots.png", 8, 8, 1, spots);
    scene.texture("normal.exr", 8, 8, 3, normal);
    scene.texture("sky.exr", 8, 8, 3, sky);
    scene.build.material("mapped", "Kd 0.8 0.8 0.8\nmap_Kd colour.png\nnorm normal.exr");
    scene.build.material("leaf", "Kd 0.5 0.7 0.2\nmap_d mask.png");
    scene.build.material("rough", "Kd 0.2 0.2 0.2\nKs 0.6 0.6 0.6\nNs 30\nillum 2");
    scene.build.material("frosted", "Ni 1.4\nillum 7\nPr 0.3");
    scene.build.use("mapped").textured_quad({{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}});
    scene.build.use("leaf").textured_quad({{-1, 0.1, 0.5}, {1, 0.1, 0.5}, {1, 1.5, 0.3}, {-1, 1.5, 0.3}});
    scene.build.use("rough").icosphere({0.6, 0.5, -0.4}, 0.4, 1);
    scene.build.use("frosted").icosphere({-0.6, 0.5, -0.4}, 0.4, 1);
    scene.build.material("lamp", "Kd 0 0 0\nKe 8 7 5\nmap_Ke spots.png")
        .use("lamp")
        .textured_quad({{-1.5, 1.8, 0}, {-1, 1.8, 0}, {-1, 1.9, 0.5}, {-1.5, 1.9, 0.5}});
    scene.options.light.environment_file = scene.folder.file("sky.exr");
    scene.options.film.filter = Filter::GAUSSIAN;
    scene.options.scene.texture_filter = TextureFilter::FOOTPRINT;
    scene.finish = [](Scene& loaded) { read_by_second_uvs("colour.png", loaded); };
    scene.look({0, 1.2, 3}, {0, 0.5, 0}, 40);
}

/// Balls of what lies above others or lets light into it, and of a measured BRDF, under a lamp and a thin
/// wall of glass.
void make_covers(TestScene& scene) {
    const std::pair<const char*, const char*> balls[] = {
        {"lacquer", "Kd 0.6 0.1 0.1\nPm 0\nPr 0.4\nPc 0.9\nPcr 0.2"},
        {"velvet", "Kd 0.2 0.1 0.4\nPm 0\nPr 0.9\nPs 0.8"},
        {"honey", "Ni 1.4\nillum 7\nattenuation 0.9 0.6 0.2\nattenuation_distance 0.3"},
        {"flint", "Ni 1.7\nillum 7\nabbe 20"},
        {"ice", "Ni 1.3\nillum 7\npriority 1"},
        {"stained", "Kd 0.3 0.7 0.4\nPm 0\nPr 0.3\nNi 1.5\nTf 0.6"},
        {"brushed", "Kd 0.8 0.7 0.6\nPm 1\nPr 0.4\naniso 0.7\nanisor 0.2"},
        {"sample", "merl sample.binary"}};
    scene.folder.write("sample.binary",
                       merl_file(matte_and_glossy(glm::dvec3(0.3), glm::dvec3(0.4), 0.3), {12, 8, 8}));
    double x = -1.8;
    for (const auto& [name, keys] : balls) {
        scene.build.material(name, keys).use(name).icosphere({x, 0.3, 0}, 0.25, 1);
        x += 0.6;
    }
    scene.build.material("white", "Kd 0.7 0.7 0.7").use("white").floor(3);
    scene.build.material("pane", "Ni 1.5\nillum 7\nthin_walled 1")
        .use("pane")
        .textured_quad({{-1, 0.2, 0.6}, {1, 0.2, 0.6}, {1, 1, 0.5}, {-1, 1, 0.5}});
    scene.build.use("brushed").textured_quad({{-1, 0, -1}, {1, 0, -1}, {1, 1, -1.2}, {-1, 1, -1.2}});
    scene.build.material("lamp", "Kd 0 0 0\nKe 8 7 5")
        .use("lamp")
        .polygon({{-0.4, 2, -0.4}, {0.4, 2, -0.4}, {0.4, 2, 0.4}, {-0.4, 2, 0.4}});
    scene.look({0, 1.2, 3}, {0, 0.4, 0}, 45);
}

/// One ball at three places, once turned round by a mirror.
void make_repeated(TestScene& scene) {
    scene.build.material("white", "Kd 0.7 0.7 0.7").use("white").floor(3);
    scene.build.material("lamp", "Kd 0 0 0\nKe 8 7 5")
        .use("lamp")
        .polygon({{-0.4, 2, -0.4}, {0.4, 2, -0.4}, {0.4, 2, 0.4}, {-0.4, 2, 0.4}});
    scene.look({0, 1.2, 3}, {0, 0.4, 0}, 45);
    scene.finish = [](Scene& loaded) {
        std::vector<glm::dmat4> maps; // in the frame where the scene's extent is about 1
        for (const glm::dvec3& place : {glm::dvec3(-0.2, 0, 0), {0.1, 0, 0.1}, {0.2, -0.1, -0.1}})
            maps.push_back(
                glm::scale(glm::translate(glm::dmat4(1), place), {0.1, 0.1, place.x < 0 ? -0.1 : 0.1}));
        add_instances(loaded, make_ball(8, 6), maps);
        for (Instance& instance : loaded.instances)
            instance.object = 0;
    };
}

using Maker = void (*)(TestScene&);
const std::pair<const char*, Maker> SCENES[] = {{"room", make_lit_room},
                                                {"optics", make_optics},
                                                {"maps", make_maps},
                                                {"covers", make_covers},
                                                {"repeated", make_repeated}};

/// A scene with few samples, enough for every kind of path to occur.
struct SmallScene : TestScene {
    explicit SmallScene(Maker make) {
        make(*this);
        options.film.size = {48, 32};
        options.sampling.spp = 16;
        options.sampling.replicates = 8;
    }
    void add_line(const std::string& text) { build.raw(text); }
};

/// How many sums differ, so that a failure prints a number and no film.
size_t count_differences(const Film& a, const Film& b) {
    EXPECT_EQ(a.sums.size(), b.sums.size());
    size_t count = 0;
    for (size_t i = 0; i < std::min(a.sums.size(), b.sums.size()); ++i)
        count += a.sums[i] != b.sums[i];
    return count;
}

} // namespace

TEST(SameBits, AbsentEffectsChangeNothing) {
    for (const auto& [name, make] : SCENES)
        for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED, Integrator::RAYCAST}) {
            SmallScene scene(make);
            scene.options.transport.integrator = integrator;
            const Render all = scene.render();
            scene.options.effects.all = false;
            const Effects effects = find_effects(scene.load(), scene.options);
            EXPECT_NE(effects.mask, EFFECT_ALL) << name;
            const Render needed = scene.render();
            EXPECT_EQ(count_differences(all.film, needed.film), 0u) << name << ", " << name_of(integrator);
            EXPECT_EQ(all.counts.rays(), needed.counts.rays()) << name << ", " << name_of(integrator);
            EXPECT_EQ(all.counts.bad(), 0u);
        }
}

TEST(SameBits, AMapOfRoughnessDoesNotMakeSmoothGlassOrAMirrorRough) {
    // The specialised kernel knows no rough refraction here; the full one must not find any in the map.
    for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED}) {
        TestScene scene;
        scene.texture8("half.png", 1, 1, 1, {128});
        scene.build.material("floor", "Kd 0.6 0.5 0.4\nmap_Kd half.png");
        scene.build.material("glass", "Ni 1.5\nillum 7\nPr 0.009\nmap_Pr half.png");
        scene.build.material("mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3\nPr 0.009\nmap_Pr half.png");
        scene.build.use("floor").floor(3).use("glass").textured_quad(
            {{-1, 0.5, 1}, {1, 0.5, 1}, {1, 0.8, -1}, {-1, 0.8, -1}});
        scene.build.use("mirror").textured_quad(
            {{-1, 0.1, -1.2}, {1, 0.1, -1.2}, {1, 2, -1.4}, {-1, 2, -1.4}});
        scene.options.light.suns.push_back({{1, 2, 1}, {3, 3, 2}, 3});
        scene.options.transport.integrator = integrator;
        scene.options.sampling.spp = 64;
        scene.look({0, 2, 3}, {0, 0.4, 0}, 45);
        const Film full = scene.render().film;
        scene.options.effects.all = false;
        EXPECT_EQ(count_differences(scene.render().film, full), 0u) << name_of(integrator);
    }
}

TEST(SameBits, EveryEffectIsPresentInSomeSceneAndAbsentInAnother) {
    EffectMask present = 0, absent = 0;
    for (const auto& [name, make] : SCENES) {
        SmallScene scene(make);
        scene.options.effects.all = false;
        if (make == make_lit_room) {
            scene.options.transport.paths = "LDE";
            scene.options.camera.aperture = 0.1;
            scene.options.camera.end_up = glm::dvec3(0.1, 1, 0);
        }
        const EffectMask mask = find_effects(scene.load(), scene.options).mask;
        present |= mask;
        absent |= ~mask;
    }
    EXPECT_EQ(present, EFFECT_ALL);
    EXPECT_EQ(absent & EFFECT_ALL, EffectMask(EFFECT_ALL & ~EFFECT_MATTE));
}

TEST(SameBits, AWindowHoldsWhatTheWholePictureHoldsThere) {
    for (const auto& [name, make] : SCENES) {
        SmallScene scene(make);
        const Film whole = scene.render().film;
        const Crop window{13, 5, 40, 30}; // no side on a tile's edge
        scene.options.film.crop = window;
        const Film part = scene.render().film;
        ASSERT_EQ(part.width, 27);
        ASSERT_EQ(part.height, 25);
        EXPECT_EQ(part.scale.quantum, whole.scale.quantum);
        size_t differences = 0;
        for (int r = 0; r < 8; ++r)
            for (int y = 0; y < part.height; ++y)
                for (int i = 0; i < 3 * part.width; ++i) {
                    const size_t in_part = size_t((r * part.height + y) * part.width * 3 + i);
                    const size_t in_whole = size_t(((r * 32 + y + window.y0) * 48 + window.x0) * 3 + i);
                    differences += part.sums[in_part] != whole.sums[in_whole];
                }
        EXPECT_EQ(differences, 0u) << name;
    }
}

TEST(SameBits, SamplesGoRoundTheReplicates) {
    SmallScene scene(make_lit_room);
    scene.options.sampling.spp = 3;
    scene.options.sampling.first_sample = 6; // samples 6, 7 and 8 belong to replicates 6, 7 and 0
    const Film film = scene.render().film;
    const size_t plane = film.sums.size() / 8;
    for (int r = 0; r < 8; ++r) {
        const auto begin = film.sums.begin() + std::ptrdiff_t(size_t(r) * plane);
        const bool any =
            std::any_of(begin, begin + std::ptrdiff_t(plane), [](std::int64_t sum) { return sum != 0; });
        EXPECT_EQ(any, r == 6 || r == 7 || r == 0) << r;
        EXPECT_EQ(film_replicate_samples(film, r), any ? 1u : 0u);
    }
}

TEST(SameBits, AllTreesFindTheSameHits) {
    for (const auto& [name, make] : SCENES) {
        SmallScene scene(make);
        scene.options.bvh.layout = BvhLayout::BVH8;
        const Render wide = scene.render();
        for (const BvhLayout choice : ALL_LAYOUTS)
            for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH}) {
                scene.options.bvh.layout = choice;
                scene.options.bvh.quality = quality;
                const Render other = scene.render();
                EXPECT_EQ(count_differences(wide.film, other.film), 0u)
                    << name << ", " << int(choice) << ", " << int(quality);
                EXPECT_EQ(wide.counts.rays(), other.counts.rays())
                    << name << ", " << int(choice) << ", " << int(quality);
            }
    }
}

TEST(SameBits, TheSameRunTwiceGivesTheSameFilmAndAnotherSeedAnother) {
    SmallScene scene(make_optics);
    const Film first = scene.render().film;
    EXPECT_EQ(count_differences(first, scene.render().film), 0u);
    scene.options.sampling.seed = 1;
    EXPECT_GT(count_differences(first, scene.render().film), first.sums.size() / 4);
}

TEST(SameBits, DoublePrecisionFollowsTheSamePaths) {
    if (!test_device().info.fp64) {
        SmallScene scene(make_lit_room);
        scene.options.device.precision = Precision::DOUBLE;
        EXPECT_THROW(scene.render(), std::exception);
        return;
    }
    for (const auto& [name, make] : SCENES) {
        SmallScene scene(make);
        scene.options.sampling.spp = 64;
        const Film single = scene.render().film;
        scene.options.device.precision = Precision::DOUBLE;
        const std::vector<float> a = film_mean(single), b = film_mean(scene.render().film);
        // A rounding may send a path another way, so single pixels may differ; half of them must not.
        std::vector<double> differences;
        double sum_a = 0, sum_b = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            differences.push_back(std::abs(a[i] - b[i]) / std::max(b[i], 1e-3f));
            sum_a += a[i];
            sum_b += b[i];
        }
        std::nth_element(differences.begin(), differences.begin() + std::ptrdiff_t(differences.size() / 2),
                         differences.end());
        EXPECT_LT(differences[differences.size() / 2], 1e-4) << name;
        EXPECT_NEAR(sum_a, sum_b, 2e-3 * sum_b) << name;
    }
}

} // namespace clrt
