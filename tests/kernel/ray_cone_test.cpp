// SPDX-License-Identifier: Apache-2.0
// geometry/ray_cone.h and what becomes of a cone at a surface: footprints in texture coordinates.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

using namespace clrt;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"camera/camera.h", "geometry/surface.h"});
        // a: sample's number within its replicate, density
        made.add("begin", "Ray ray = ray_make((real3)(REAL(0.0)), (real3)(REAL(0.0)), REAL(0.0));"
                          "const Sampler sampler = sampler_at(7u, as_uint(a.x));"
                          "ray_cone_begin(params, &sampler, (real)a.y, &ray);"
                          "first.x = ray.spread;"
                          "ray_cone_scatter(params, &sampler, (real)a.z, &ray); first.y = ray.spread;");
        // a: direction to the middle of the triangle's plane z = 0, distance; b: width, spread
        made.add("footprint",
                 "Ray ray = ray_make((real3)(REAL(0.0)), vector_from(a), REAL(0.0));"
                 "ray.width = b.x; ray.spread = b.y;"
                 "Hit hit = hit_none(REAL_FAR); hit_set_triangle(0u, 0u, &hit); hit.t = a.w; hit.b1 = hit.b2 "
                 "= REAL(0.25);"
                 "const Surface surface = surface_at(scene, &hit, &ray);"
                 "const Ray next = surface_ray(&surface, true, surface.normal_g);"
                 "first = (vec4)(surface_uv_area(&surface).x, surface.width, next.width, next.spread);"
                 "second.x = surface_uv_area(&surface).y;");
        return made;
    }();
    return instance;
}

/// A triangle of area 2 whose part of the texture has the area 8, and 0.5 by its second coordinates.
Scene textured_triangle() {
    Scene scene;
    scene.positions = {{0, 0, 0, 0}, {2, 0, 0, 0}, {0, 2, 0, 0}};
    scene.uvs = {0, 0, 4, 0, 0, 4};
    scene.second_uvs = {0, 0, 1, 0, 0, 1};
    Triangle triangle{0, 1, 2, NO_INDEX, NO_INDEX, NO_INDEX, 0, 1, 2, 0, NO_INDEX, 0};
    scene.triangles = {triangle};
    scene.materials.resize(1);
    return scene;
}

RenderParams filtering() {
    RenderParams params{};
    params.replicates = 4;
    params.texture_filter = 1;
    return params;
}

} // namespace

TEST(RayCone, ASampleStandsForItsShareOfTheDirections) {
    std::vector<vec4> inputs;
    for (const u32 index : {0u, 1u, 3u, 100u})
        inputs.push_back({bits_to_float(index), 1e6f, 0, 0});
    const std::vector<vec4> got = probe().run("begin", Scene{}, filtering(), inputs).first;
    const double samples[] = {1, 5, 13, 401};
    for (size_t i = 0; i < inputs.size(); ++i) {
        EXPECT_NEAR(got[i].x * 1e6 * samples[i], 1, 1e-6);
        EXPECT_EQ(got[i].y, got[i].x) << "a mirror keeps the cone";
    }
    RenderParams off = filtering();
    off.texture_filter = 0;
    for (const vec4& cone : probe().run("begin", Scene{}, off, inputs).first)
        EXPECT_TRUE(cone.x == 0 && cone.y == 0);
}

TEST(RayCone, ScatteringAddsASolidAngleThatFadesWithSamples) {
    const std::vector<vec4> got =
        probe()
            .run("begin", Scene{}, filtering(), {{bits_to_float(9u), 1e6f, 2, 0}, {0, 1e6f, 0.1f, 0}})
            .first;
    EXPECT_NEAR(got[0].y, 1e-6 / 37 + 0.5 / 37, 1e-7);
    EXPECT_EQ(got[1].y, 0.25f) << "no wider";
}

TEST(RayCone, FootprintsGrowWithTheSquareOfTheDistanceAndOneOverTheCosine) {
    const double slant = 1 / std::sqrt(2.0), angle = 1e-4; // radians
    std::vector<vec4> a, b;
    for (const float distance : {1.f, 2.f, 8.f})
        for (const double cosine : {1.0, slant}) {
            a.push_back({float(std::sqrt(1 - cosine * cosine)), 0, float(-cosine), distance});
            b.push_back({0, float(angle * angle), 0, 0});
        }
    const SceneProbe::Outputs run = probe().run("footprint", textured_triangle(), filtering(), a, b);
    const std::vector<vec4>& got = run.first;
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(run.second[i].x / got[i].x, 0.0625, 1e-7) << "by the second coordinates";
        const double width = angle * double(a[i].w), cosine = i % 2 ? slant : 1;
        EXPECT_NEAR(got[i].y / width, 1, 1e-6);
        EXPECT_NEAR(got[i].x / (width * width * 4 / cosine), 1, 1e-5) << "texture area over area";
        EXPECT_EQ(got[i].z, got[i].y) << "the next ray starts with the footprint's width";
        EXPECT_EQ(got[i].w, b[i].y);
    }
    for (const vec4& none :
         probe()
             .run("footprint", textured_triangle(), filtering(), a, std::vector<vec4>(a.size(), vec4{}))
             .first)
        EXPECT_EQ(none.x, 0) << "a ray without a cone is not filtered";
}
