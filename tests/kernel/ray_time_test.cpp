// SPDX-License-Identifier: Apache-2.0
// The time within the shutter's opening: the camera draws it, and whatever a ray
// hits, the rays that leave from there have it too.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

namespace clrt {
namespace {

constexpr u32 WIDTH = 512, SAMPLES = 200000;

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"camera/camera.h", "path/visibility.h", "lights/light_sample.h"});
        made.add("camera", "const uint x = i % params->width, y = i / params->width;"
                           "const Sampler s = sampler_make(params->seed, i, 0u, 0u);"
                           "const Ray ray = camera_ray(params, &s, x, y);"
                           "first = (vec4)(ray_time(&ray), sampler_pair(&s, 0u, SAMPLE_TIME).x,"
                           "               sampler_number(&s, 0u, SAMPLE_LENS), 0.0f);");
        // a: where the ray starts, and its time; b: a light.
        made.add("surface", R"(
            Ray ray = ray_make(vector_from(a), vector_make(REAL(0.0), REAL(0.0), REAL(-1.0)), (real)a.w);
            Hit hit = hit_none(REAL(1.0));
            hit.b1 = hit.b2 = REAL(0.25);
            hit_set_triangle(0u, 0u, &hit);
            const Surface surface = visible_surface(scene, params, &ray, &hit);
            LightSample light = light_sample_none();
            light.target = vector_from(b);
            const Ray to_sky = light_shadow_ray(&surface, &light);
            light.is_distant = false;
            const Ray to_lamp = light_shadow_ray(&surface, &light);
            const Ray onward = surface_ray(&surface, false, ray.direction);
            first = (vec4)(surface_time(&surface), ray_time(&to_sky), ray_time(&to_lamp), ray_time(&onward));)");
        return made;
    }();
    return instance;
}

Scene one_triangle() {
    Scene scene;
    scene.positions = {{-1, -1, 0, 0}, {1, -1, 0, 0}, {0, 1, 0, 0}};
    scene.triangles = {{0, 1, 2, NO_INDEX, NO_INDEX, NO_INDEX, NO_INDEX, NO_INDEX, NO_INDEX, 0, NO_INDEX, 0}};
    return scene;
}

} // namespace

TEST(RayTime, CameraRaysFillTheShuttersOpening) {
    RenderParams params{};
    params.width = params.height = WIDTH;
    constexpr size_t BINS = 64;
    std::vector<double> counts(BINS);
    for (const vec4& ray : probe().run("camera", Scene{}, params, std::vector<vec4>(SAMPLES)).first) {
        ASSERT_GT(ray.x, 0);
        ASSERT_LT(ray.x, 1);
        ASSERT_EQ(ray.x, ray.y);
        ++counts[size_t(ray.x * BINS)];
    }
    EXPECT_GT(chi_squared_test(counts, std::vector<double>(BINS, double(SAMPLES) / BINS)).p_value,
              SMALLEST_P);
}

TEST(RayTime, RaysThatLeaveASurfaceHaveTheTimeOfTheOneThatHasHitIt) {
    Random random(1);
    std::vector<vec4> starts, lights;
    for (int i = 0; i < 1000; ++i) {
        starts.push_back(to_vec4({0, -0.5, 1}, random.unit()));
        lights.push_back(to_vec4(random.in_cube(3)));
    }
    const std::vector<vec4> got =
        probe().run("surface", one_triangle(), RenderParams{}, starts, lights).first;
    for (size_t i = 0; i < got.size(); ++i)
        for (const float time : {got[i].x, got[i].y, got[i].z, got[i].w})
            ASSERT_EQ(time, starts[i].w);
}

} // namespace clrt
