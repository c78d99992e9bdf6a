// SPDX-License-Identifier: Apache-2.0
// Rays that see through cut-outs meet every layer once and in order.
#include "probes/meshes.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace clrt {
namespace {

constexpr u32 CUT_OUT = 0x1000u; // EFFECT_CUT_OUT

/// Squares [-1, 1]^2 at heights z, of one material each with the given coverage.
struct Layer {
    double z;
    double coverage;
};

Scene make_layers(const std::vector<Layer>& layers) {
    Scene scene = make_empty_scene();
    scene.materials.clear();
    for (const Layer& layer : layers) {
        const u32 first = add_position(scene, {-1, -1, layer.z});
        add_position(scene, {1, -1, layer.z});
        add_position(scene, {1, 1, layer.z});
        add_position(scene, {-1, 1, layer.z});
        add_triangle(scene, first, first + 1, first + 2);
        add_triangle(scene, first, first + 2, first + 3);
        const u32 material = u32(scene.materials.size());
        scene.triangles[scene.triangles.size() - 1].material = material;
        scene.triangles[scene.triangles.size() - 2].material = material;
        Material cut_out{};
        cut_out.matte.w = float(layer.coverage);
        cut_out.map_coverage = NO_INDEX;
        cut_out.flags = MATERIAL_CUT_OUT;
        scene.materials.push_back(cut_out);
    }
    return scene;
}

/// Rays from above through the squares' inside, off the diagonals where two triangles meet.
std::vector<TestRay> rays_down(size_t count, u32 seed) {
    Random random(seed);
    std::vector<TestRay> rays;
    while (rays.size() < count) {
        const double x = random.between(-0.5, 0.5), y = random.between(-0.5, 0.5);
        if (std::abs(x - y) > 0.2)
            rays.push_back(make_ray_to({x, y, 4}, {x + random.between(-0.01, 0.01), y, -4}));
    }
    return rays;
}

/// The square of a triangle.
u32 square_of(u32 triangle) {
    return triangle / 2;
}

} // namespace

// Squares 1 to 4 coincide, and so do 6 and 7.
TEST(Visibility, EveryLayerIsMetOnceAndInOrder) {
    const Scene scene =
        make_layers({{2, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 0}, {0.5, 0}, {-1, 0}, {-1, 0}, {-1.0000001, 0}});
    for (const BvhLayout layout : ALL_LAYOUTS) {
        size_t wrong = 0;
        for (const std::vector<u32>& layers :
             RayDevice(test_device(), scene, layout, Precision::SINGLE, CUT_OUT)
                 .layers(rays_down(20000, 1))) {
            bool right = layers.size() == 9;
            for (size_t i = 0; right && i < layers.size(); ++i)
                right = square_of(layers[i]) == i;
            wrong += !right;
        }
        EXPECT_EQ(wrong, 0u) << name_of(layout);
    }
}

TEST(Visibility, LayersOfASoupAreAllItsHits) {
    Scene soup = make_soup(300, 0.4, 2);
    Random random(2);
    std::vector<TestRay> rays;
    for (int i = 0; i < 2000; ++i)
        rays.push_back(make_ray_to(random.in_cube(2), random.in_cube(0.5)));
    std::vector<std::vector<u32>> wide;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), soup, layout, Precision::SINGLE, CUT_OUT);
        const std::vector<std::vector<u32>> layers = device.layers(rays);
        // The next layer is what remains when those before are taken away.
        size_t wrong = 0;
        for (size_t ray = 0; ray < 50; ++ray) {
            Scene rest = soup;
            for (size_t layer = 0; layer <= layers[ray].size(); ++layer) {
                const std::vector<TestHit> hit =
                    RayDevice(test_device(), rest, layout, Precision::SINGLE, CUT_OUT).closest({rays[ray]});
                const bool is_last = layer == layers[ray].size();
                wrong += hit[0].triangle != (is_last ? NO_INDEX : layers[ray][layer]);
                if (is_last || wrong)
                    break;
                Triangle& taken = rest.triangles[layers[ray][layer]];
                taken.v1 = taken.v2 = taken.v0;
            }
        }
        EXPECT_EQ(wrong, 0u) << name_of(layout);
        if (wide.empty())
            wide = layers;
        EXPECT_EQ(layers, wide) << name_of(layout);
    }
}

TEST(Visibility, AHitIsTheFirstLayerThatCovers) {
    const std::vector<TestRay> rays = rays_down(5000, 3);
    for (const BvhLayout layout : ALL_LAYOUTS)
        for (u32 covering = 0; covering <= 5; ++covering) {
            std::vector<Layer> layers = {{2, 0}, {1, 0}, {1, 0}, {0, 0}, {-1, 0}};
            if (covering < 5)
                layers[covering].coverage = 1;
            size_t wrong = 0;
            for (const u32 found :
                 RayDevice(test_device(), make_layers(layers), layout, Precision::SINGLE, CUT_OUT)
                     .visible(rays))
                wrong += covering < 5 ? square_of(found) != covering : found != NO_INDEX;
            EXPECT_EQ(wrong, 0u) << covering << ", " << name_of(layout);
        }
}

TEST(Visibility, HitsFallToTheLayersByTheirCoverage) {
    const Scene scene = make_layers({{2, 0.5}, {1, 0.25}, {1, 0.25}, {0, 0.5}});
    const std::vector<double> expected = {0.5, 0.125, 0.09375, 0.140625, 0.140625}; // the last: none
    const std::vector<TestRay> rays = rays_down(100000, 4);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        std::vector<double> counts(5);
        for (const u32 found :
             RayDevice(test_device(), scene, layout, Precision::SINGLE, CUT_OUT).visible(rays))
            counts[found == NO_INDEX ? 4 : square_of(found)] += 1;
        EXPECT_GT(chi_squared_test(counts, expected).p_value, SMALLEST_P) << name_of(layout);
    }
}

// Products of powers of two are exact, so a layer that is missed or met twice shows.
TEST(Visibility, AShareIsTheProductOfWhatLayersLetPass) {
    std::vector<TestRay> rays = rays_down(5000, 5);
    const Scene scene = make_layers({{2, 0.5}, {1, 0.75}, {1, 0.75}, {0, 0.5}, {-1, 1}});
    const std::vector<std::pair<float, float>> share_at_length = {
        {1.5f, 1.0f}, {2.5f, 0.5f}, {3.5f, 0x1p-5f}, {4.5f, 0x1p-6f}, {6.0f, 0.0f}};
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), scene, layout, Precision::SINGLE, CUT_OUT),
            opaque(test_device(), scene, layout);
        for (const auto& [length, share] : share_at_length) {
            for (TestRay& ray : rays)
                ray.origin.w = length;
            const std::vector<float> got = device.shares(rays), solid = opaque.shares(rays);
            EXPECT_EQ(std::count(got.begin(), got.end(), share), long(rays.size())) << length;
            EXPECT_EQ(std::count(solid.begin(), solid.end(), length < 2 ? 1.0f : 0.0f), long(rays.size()));
        }
    }
}

} // namespace clrt
