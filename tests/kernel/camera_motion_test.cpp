// SPDX-License-Identifier: Apache-2.0
// camera/camera_motion.h: the camera at a time is the one that the host makes there.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "scene/camera_params.h"
#include "scene/vectors.h"
#include "support/test_device.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"geometry/scene.h", "camera/camera.h"});
        // a: film position, time
        made.add("ray", "const CameraParams now = camera_at(&params->camera, (real)a.z);"
                        "const Ray ray = camera_generate(&now, (real2)(a.x, a.y), (real2)(0.5f), (real)a.z);"
                        "first = probe_vec4(ray.origin, ray_time(&ray));"
                        "second = probe_vec4(ray.direction, REAL(0.0));");
        return made;
    }();
    return instance;
}

const CameraPose START = {{0.4, -0.6, 0.5}, {0.1, 0, -1}, {0.2, 1, 0.1}},
                 END = {{-0.3, 0.2, 0.9}, {0.5, 0.3, -1.4}, {-0.4, 0.8, 0.2}};

Camera camera_of(const CameraPose& pose, Projection projection) {
    Camera camera;
    camera.eye = pose.eye;
    camera.at = pose.at;
    camera.up = pose.up;
    camera.projection = projection;
    camera.ortho_height = 1.5;
    camera.fov_degrees = 70;
    camera.shift = {0.25, 0.1};
    return camera;
}

} // namespace

TEST(CameraMotion, TheCameraAtATimeIsTheHostsThere) {
    constexpr glm::ivec2 SIZE(96, 64);
    const Normalisation frame{{0.5, 0.25, -1}, 0.5};
    Random random(3);
    for (int i = 0; i < PROJECTION_COUNT; ++i)
        for (const double time : {0.0, 0.3, 1.0}) {
            Camera moving = camera_of(START, Projection(i));
            moving.end = END;
            RenderParams params{};
            params.camera = make_camera_params(moving, frame, SIZE);
            const CameraParams there = make_camera_params(
                camera_of({glm::mix(START.eye, END.eye, time), glm::mix(START.at, END.at, time),
                           glm::mix(START.up, END.up, time)},
                          Projection(i)),
                frame, SIZE);
            std::vector<vec4> places;
            for (int k = 0; k < 200; ++k) {
                const double x = random.between(-48, 48);
                places.push_back(to_vec4({x, random.between(-32, 32), time}));
            }
            const SceneProbe::Outputs got = probe().run("ray", Scene{}, params, places);
            for (size_t k = 0; k < places.size(); ++k) {
                const FilmRay ray = film_ray(there, {places[k].x, places[k].y});
                ASSERT_LE(glm::distance(to_dvec3(got.first[k]), ray.origin), 3e-7) << i << " " << time;
                ASSERT_LE(glm::distance(to_dvec3(got.second[k]), glm::normalize(ray.direction)), 1e-6)
                    << i << " " << time;
                ASSERT_EQ(got.first[k].w, float(time));
            }
        }
}

TEST(CameraMotion, ACameraThatStandsStillIsLeftAsItIs) {
    RenderParams params{};
    params.camera = make_camera_params(camera_of(START, PROJECTION_PERSPECTIVE), Normalisation(), {96, 64});
    const std::vector<vec4> early = {{3, 4, 0, 0}}, late = {{3, 4, 0.9f, 0}};
    const SceneProbe::Outputs a = probe().run("ray", Scene{}, params, early),
                              b = probe().run("ray", Scene{}, params, late);
    EXPECT_EQ(to_dvec3(a.first[0]), to_dvec3(b.first[0]));
    EXPECT_EQ(to_dvec3(a.second[0]), to_dvec3(b.second[0]));
}
