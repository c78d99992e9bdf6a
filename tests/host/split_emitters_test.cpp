// SPDX-License-Identifier: Apache-2.0
// Emissive triangles in parts: where the parts lie, when a map makes them, and what they are chosen by.
#include "scene/split_emitters.h"

#include "probes/random_inputs.h"
#include "probes/scratch_scene.h"
#include "scene/emission_map.h"
#include "scene/emitter_parts.h"
#include "scene/lights.h"
#include "scene/vectors.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <set>

namespace clrt {

namespace {

/// A lamp of 2 x 2 over a floor; the map's texels are 0 but for some.
struct MappedLamp : ScratchScene {
    explicit MappedLamp(const std::string& keys = "", int size = 32, double even = 0.001) {
        std::vector<float> texels(size_t(size) * size_t(size), float(even));
        for (const int at : {size * 5 + 7, size * 20 + 25})
            texels[size_t(at)] = 30;
        texture("spots.exr", size, size, 1, texels);
        build.material("floor", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nmap_Ke " + keys + "spots.exr");
        build.use("floor").floor(3).use("lamp");
        lamp(0);
    }
    void lamp(double x) {
        build.textured_quad({{x - 1, 1, -1}, {x + 1, 1, -1}, {x + 1, 1, 1}, {x - 1, 1, 1}});
    }
};

double sum_of_probabilities(const Scene& scene) {
    double sum = 0;
    for (u32 i = 0; i < scene.emitters.size(); ++i)
        sum += double(scene.emitters[i].pdf_a) * emitter_area(scene, i);
    return sum;
}

/// The mean over an emitter by 64 points.
double mean_over(const Scene& scene, const EmissionMap& map, u32 emitter) {
    const Triangle& t = scene.triangles[scene.emitters[emitter].triangle];
    const auto uv = [&](u32 i) { return glm::dvec2(scene.uvs[2 * size_t(i)], scene.uvs[2 * size_t(i) + 1]); };
    double sum = 0;
    for (u32 k = 0; k < 64; ++k) {
        const glm::dvec2 b = emitter_place(scene, emitter).at(part_place(3, k).centre());
        sum += map.mean_at(uv(t.t0) + b.x * (uv(t.t1) - uv(t.t0)) + b.y * (uv(t.t2) - uv(t.t0)), {}, {});
    }
    return sum / 64;
}

} // namespace

TEST(SplitEmitters, PartsTileTheTriangleAndAreFoundByAnyOfTheirPoints) {
    Random random(1);
    for (u32 level = 0; level <= 8; ++level)
        for (u32 i = 0; i < part_count(level); ++i) {
            const PartPlace place = part_place(level, i);
            ASSERT_EQ(std::abs(place.step), std::ldexp(1.0, -int(level)));
            for (const glm::dvec2& corner : {place.at({0, 0}), place.at({1, 0}), place.at({0, 1})})
                ASSERT_TRUE(corner.x >= 0 && corner.y >= 0 && corner.x + corner.y <= 1) << level << " " << i;
            double x = random.unit(), y = random.unit();
            if (x + y > 1)
                x = 1 - x, y = 1 - y;
            ASSERT_EQ(part_at(level, place.at({x, y})), i) << level;
            const EmitterPart part = emitter_part(level, i, 7);
            ASSERT_TRUE(part.step == float(place.step) && double(part.b1) == place.origin.x &&
                        double(part.b2) == place.origin.y);
            ASSERT_EQ(EMITTER_CODE_PARTS(part.code), 7u);
        }
}

TEST(SplitEmitters, PartsAreChosenByWhatTheMapSendsFromThem) {
    for (const char* keys :
         {"", "-s 1.5 0.7 1 ", "-o 0.3 -0.2 0 -s 2 2 1 ", "-clamp on -s 2 2 1 ", "-mm 0.01 2 "}) {
        const MappedLamp lamp(keys);
        const Scene scene = lamp.load();
        ASSERT_GT(scene.emitter_parts.size(), 50u) << keys;
        ASSERT_LT(scene.emitter_parts.size(), 2000u) << keys;
        EXPECT_EQ(count_emissive_triangles(scene).count, 2u);
        EXPECT_EQ(count_emissive_triangles(scene).parts, scene.emitters.size());
        EXPECT_NEAR(sum_of_probabilities(scene), 1, 1e-5) << keys;
        const EmissionMap map(scene, scene.materials[scene.triangles[scene.emitters[0].triangle].material]);
        double area = 0, power = 0, second = 0, even = 0;
        for (u32 i = 0; i < scene.emitters.size(); ++i) {
            const double mean = mean_over(scene, map, i), part = emitter_area(scene, i);
            area += part;
            power += part * mean;
            second += part * mean * mean / double(scene.emitters[i].pdf_a);
            even += part * mean * mean;
            ASSERT_GT(scene.emitters[i].pdf_a, 0) << "nothing is out of reach";
            const u32 first = scene.triangles[scene.emitters[i].triangle].emitter;
            ASSERT_TRUE(first <= i && i < first + EMITTER_CODE_PARTS(scene.emitter_parts[i].code));
            ASSERT_TRUE(i == first || EMITTER_CODE_DIGITS(scene.emitter_parts[i].code) >
                                          EMITTER_CODE_DIGITS(scene.emitter_parts[i - 1].code));
        }
        // In proportion the second moment would be the squared power; chosen evenly it is many times that.
        EXPECT_LT(second, 1.7 * power * power) << keys;
        EXPECT_GT(even * area, 10 * power * power) << keys;
    }
}

TEST(SplitEmitters, AMapThatReadsTheSecondCoordinatesMakesTheirParts) {
    const auto turned = [](const std::vector<float>& uvs) {
        std::vector<float> other;
        for (size_t i = 0; i < uvs.size(); ++i)
            other.push_back(uvs[i ^ 1]);
        return other;
    };
    Scene first = MappedLamp().load();
    unite_emitters(first);
    Scene second = first;
    first.uvs = turned(first.uvs);
    second.second_uvs = turned(second.uvs);
    for (Texture& texture : second.textures)
        texture.channel |= TEXTURE_SECOND_UV;
    split_emitters(first);
    split_emitters(second);
    ASSERT_GT(first.emitters.size(), 20u);
    ASSERT_EQ(first.emitters.size(), second.emitters.size());
    for (size_t i = 0; i < first.emitters.size(); ++i)
        EXPECT_EQ(first.emitters[i].pdf_a, second.emitters[i].pdf_a) << i;
}

TEST(SplitEmitters, EvenMapsLeaveTheTablesAsTheyAre) {
    const Scene spots = MappedLamp().load();
    Scene united = spots;
    unite_emitters(united);
    ASSERT_EQ(united.emitters.size(), 2u);
    EXPECT_TRUE(united.emitter_parts.empty() && united.emitter_exitance.empty());
    // A map that is even, and one that hardly is not.
    for (const double even : {30.0, 25.0}) {
        const Scene scene = MappedLamp("", 32, even).load();
        ASSERT_EQ(scene.emitters.size(), 2u) << even;
        EXPECT_TRUE(scene.emitter_parts.empty() && scene.emitter_exitance.empty());
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(scene.emitters[i].pdf_a, united.emitters[i].pdf_a);
            EXPECT_EQ(scene.emitters[i].threshold, united.emitters[i].threshold);
        }
    }
}

TEST(SplitEmitters, TheSizeOfTheSceneChangesNoPart) {
    MappedLamp lamp;
    const Scene scene = lamp.load();
    lamp.scale = 1024;
    const Scene large = lamp.load();
    ASSERT_EQ(scene.emitters.size(), large.emitters.size());
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        ASSERT_EQ(scene.emitter_parts[i].code, large.emitter_parts[i].code);
        ASSERT_EQ(scene.emitters[i].pdf_a, large.emitters[i].pdf_a);
        ASSERT_EQ(scene.emitters[i].threshold, large.emitters[i].threshold);
        ASSERT_EQ(scene.emitters[i].alias, large.emitters[i].alias);
    }
}

TEST(SplitEmitters, TrianglesThatTheMapLeavesDarkAreRarelyChosen) {
    // An atlas: of a thousand small triangles a few have the spots.
    ScratchScene scratch;
    std::vector<float> texels(64 * 64, 0);
    for (int y = 8; y < 12; ++y)
        for (int x = 8; x < 12; ++x)
            texels[size_t(64 * y + x)] = 1;
    scratch.texture("atlas.exr", 64, 64, 1, texels);
    scratch.build.material("lamp", "Kd 0 0 0\nmap_Ke atlas.exr").use("lamp");
    for (int i = 0; i < 32; ++i)
        for (int k = 0; k < 32; ++k) {
            const double x = i / 32.0, y = k / 32.0, d = 1 / 32.0;
            for (const auto& [u, v] : {std::pair(x, y), {x + d, y}, {x + d, y + d}, {x, y + d}})
                scratch.build.raw("v " + std::to_string(u) + " " + std::to_string(v) + " 0\nvt " +
                                  std::to_string(u) + " " + std::to_string(v));
            scratch.build.raw("f -4/-4 -3/-3 -2/-2 -1/-1");
        }
    const Scene scene = scratch.load();
    EXPECT_EQ(count_emissive_triangles(scene).count, 2048u);
    double bright = 0;
    for (u32 i = 0; i < scene.emitters.size(); ++i) {
        const auto corners = emitter_corners(scene, i);
        const glm::dvec3 p =
            to_dvec3(to_vec4((corners[0] + corners[1] + corners[2]) / 3.0)) / scene.normalisation.scale +
            scene.normalisation.centre;
        ASSERT_GT(scene.emitters[i].pdf_a, 0);
        if (p.x > 7 / 64.0 && p.x < 13 / 64.0 && p.y > 1 - 13 / 64.0 && p.y < 1 - 7 / 64.0)
            bright += double(scene.emitters[i].pdf_a) * emitter_area(scene, i);
    }
    EXPECT_GT(bright, 0.9); // of 0.4 % of the area
}

TEST(SplitEmitters, PartsAreBounded) {
    MappedLamp lamp("", 1024, 0);
    for (int i = 1; i < 2000; ++i)
        lamp.lamp(3 * i);
    const Scene scene = lamp.load();
    const EmissiveTriangles triangles = count_emissive_triangles(scene);
    EXPECT_EQ(triangles.count, 4000u);
    EXPECT_LE(triangles.parts, MOST_EMITTER_PARTS + triangles.split);
    EXPECT_GT(triangles.parts, MOST_EMITTER_PARTS / 8);
}

} // namespace clrt
