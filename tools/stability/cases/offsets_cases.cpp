// SPDX-License-Identifier: Apache-2.0
// Leaving surfaces: neither met again nor jumped over.
#include "stability/cases/offsets_cases.h"

#include "naive/naive_kernels.h"
#include "probes/leaving_rays.h"
#include "probes/scene_builder.h"
#include "stability/cases/ray_builds.h"
#include "stability/catalogue.h"
#include "stability/choices.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

/// Calls `trace` with every layout in single, else with the eight-wide tree.
void for_each_layout(const CaseRun& run, Build build,
                     const std::function<void(const RayDeviceOptions&, const std::string&)>& trace) {
    for_each_tree(build, plain_offsets(run.device),
                  [&](const RayDeviceOptions& options, const std::string& tree) {
                      if (options.quality == BvhQuality::FAST)
                          trace(options, tree);
                  });
}

/// Lets rays leave where they arrive and counts those that are stopped.
void count_stopped(const Scene& scene, const RayDevice& device, const Arrivals& from, size_t directions_each,
                   u32 seed, const std::string& name, Worst& stopped) {
    Random random(seed);
    for (size_t round = 0; round < directions_each; ++round) {
        const std::vector<TestRay> rays = leave_at_random(scene, device, from, random);
        const std::vector<u32> any = device.any(rays);
        for (size_t i = 0; i < rays.size(); ++i)
            stopped.count(any[i] != 0,
                          [&] { return fmt::format("{}, after {}", name, ray_text(from.rays[i])); });
    }
}

void own_triangle(CaseRun& run) {
    Figure& stopped = run.figure("rays that meet the triangle they leave", 0);
    Random random(1);
    const size_t scenes = run.count(150, 1000, 10000);
    for (size_t k = 0; k < scenes; ++k) {
        Scene scene = make_empty_scene();
        const auto corner = [&] {
            const double x = random.signed_log(1e-8, 1e8), y = random.signed_log(1e-8, 1e8);
            return glm::dvec3(x, y, random.signed_log(1e-8, 1e8));
        };
        const glm::dvec3 p0 = corner(), p1 = corner();
        add_triangle(scene, p0, p1, corner());
        scene = normalised(scene);
        const double extent = extent_of(scene);
        std::vector<TestRay> rays;
        for (int i = 0; i < 64; ++i)
            rays.push_back(
                make_ray_to(random.in_cube(2 * extent), point_on(scene, scene.triangles[0], random)));
        for (const Build build : run.builds())
            for_each_layout(run, build, [&](const RayDeviceOptions& options, const std::string& tree) {
                const RayDevice device(run.device, scene, options);
                count_stopped(scene, device, arrivals(device, rays), 16, u32(k), tree, stopped[build]);
            });
    }
}

void tessellated_plane(CaseRun& run) {
    Figure& stopped = run.figure("rays that meet the plane they leave", 0);
    for (const double size : {1.0, 0x1p-20}) {
        const Scene scene = placed(make_tilted_plane(256), size, {0, 0, 0});
        Random random(2);
        std::vector<TestRay> rays;
        for (size_t i = 0; i < run.count(2e4, 2e5, 1e6); ++i) {
            const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
            // Into triangles, at edges and at corners.
            glm::dvec3 target = point_on(scene, triangle, random);
            if (i % 4 == 1)
                target = corner_position(scene, triangle, 0);
            if (i % 4 == 2)
                target = 0.5 * (corner_position(scene, triangle, 1) + corner_position(scene, triangle, 2));
            rays.push_back(make_ray_to(random.in_cube(2 * size), target));
        }
        for (const Build build : run.builds())
            for_each_layout(run, build, [&](const RayDeviceOptions& options, const std::string& tree) {
                const RayDevice device(run.device, scene, options);
                count_stopped(scene, device, arrivals(device, rays), 2, 2,
                              fmt::format("size {}, {}", size, tree), stopped[build]);
            });
    }
}

void convex_body(CaseRun& run) {
    Figure& stopped = run.figure("rays that meet the convex body they leave", 0);
    Scene scene = make_empty_scene();
    for (const TestTriangle& triangle : icosphere_triangles({0, 0, 0}, 1, 5))
        add_triangle(scene, triangle.corners[0], triangle.corners[1], triangle.corners[2]);
    Random random(3);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < run.count(4e4, 4e5, 4e6); ++i) {
        const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
        const glm::dvec3 target =
            i % 2 ? point_on(scene, triangle, random) : corner_position(scene, triangle, 0);
        rays.push_back(
            make_ray_to(target + 2.0 * random.unit() * triangle_normal(scene, triangle) * 4096.0, target));
    }
    for (const Build build : run.builds())
        for_each_layout(run, build, [&](const RayDeviceOptions& options, const std::string& tree) {
            const RayDevice device(run.device, scene, options);
            count_stopped(scene, device, arrivals(device, rays), 2, 3, tree, stopped[build]);
        });
}

void offset_size(CaseRun& run) {
    Figure& of_size = run.figure("offset at the origin, of the size", 2e-6);
    Figure& of_place = run.figure("offset far away, units in the last place of the distance", 4);
    for (const auto& [size, distance] :
         {std::pair(1.0, 0.0), {1e-6, 0.0}, {1e7, 0.0}, {1.0, 1e4}, {2.0, 2.6e5}}) {
        const Scene scene = placed(make_ball(24, 24), size, glm::dvec3(0.6, 0.1, -0.8) * distance);
        std::vector<TestRay> rays;
        std::vector<TestHit> hits;
        std::vector<glm::dvec3> outward;
        for (u32 i = 0; i < scene.triangles.size(); ++i) {
            outward.push_back(glm::normalize(triangle_normal(scene, scene.triangles[i])));
            rays.push_back(make_ray({0, 0, 0}, -outward.back()));
            hits.push_back({1, 0.25, 0.25, i});
        }
        for (const Build build : run.builds()) {
            const RayDevice device(run.device, scene, ray_options(build, plain_offsets(run.device)));
            const std::vector<TestPoint> points = device.points(rays, hits);
            const std::vector<TestRay> away = device.leaving(rays, hits, outward);
            for (size_t i = 0; i < rays.size(); ++i) {
                const double moved = glm::length(to_dvec3(away[i].origin) - points[i].position);
                const double ulp = distance > 0 ? std::ldexp(1.0, std::ilogb(distance) - 23) : 0;
                const auto describe = [&, size = size, distance = distance] {
                    return fmt::format("{}@{}, triangle {}", size, distance, i);
                };
                if (distance > 0)
                    of_place[build].see(moved / ulp, describe);
                else
                    of_size[build].see(moved / size, describe);
            }
        }
    }
}

void thin_gap(CaseRun& run) {
    Figure& lost = run.figure("rays that jump over the other plane", 0);
    Random random(5);
    for (const double place : {0.0, 1e3}) {
        Scene scene = make_empty_scene();
        const glm::dvec3 corner(-0.5 + place, -0.4 + place, 0.1 + place), x(1, 0.1, 0.3), y(-0.2, 1, 0.1);
        const glm::dvec3 n = glm::normalize(glm::cross(x, y));
        const double bound = FLOAT_U * (4 * (place + 1) + 24 * 1.2);
        for (const double height : {0.0, 8 * bound}) {
            const glm::dvec3 p = corner + n * height;
            add_triangle(scene, p, p + x, p + x + y);
            add_triangle(scene, p, p + x + y, p + y);
        }
        std::vector<TestRay> rays;
        std::vector<TestHit> hits;
        std::vector<glm::dvec3> up;
        for (size_t i = 0; i < run.count(2e4, 2e5, 1e6); ++i) {
            hits.push_back({1, random.between(0.2, 0.4), random.between(0.2, 0.4), random.word() % 2});
            rays.push_back(make_ray({0, 0, 0}, -n));
            up.push_back(leaving_direction(n, rays.back(), random.between(0.02, 1), random));
        }
        for (const Build build : run.builds())
            for_each_layout(run, build, [&](const RayDeviceOptions& options, const std::string& tree) {
                const RayDevice device(run.device, scene, options);
                const std::vector<TestHit> found = device.closest(device.leaving(rays, hits, up));
                for (size_t i = 0; i < found.size(); ++i)
                    lost[build].count(found[i].triangle != 2 && found[i].triangle != 3, [&] {
                        return fmt::format("at {}, {}, weights {}, {}", place, tree, hits[i].b1, hits[i].b2);
                    });
            });
    }
}

} // namespace

ProbeTime time_offset(const ProbeDevice& device, int rounds) {
    const Scene ball = make_ball(256, 256);
    std::vector<TestRay> rays = aimed_rays(ball, BALL_INNER, Aim::EDGE, 1 << 18, 1);
    const RayDevice naive(device, ball, ray_options(Build::NAIVE, plain_offsets(device)));
    const RayDevice single(device, ball, ray_options(Build::SINGLE, plain_offsets(device)));
    const Arrivals from = arrivals(single, rays);
    return time_in_turns(device, naive.leaver(from.rays, from.hits), single.leaver(from.rays, from.hits),
                         from.rays.size(), rounds);
}

const std::vector<StabilityCase>& offsets_cases() {
    static const std::vector<StabilityCase> cases = {
        {"S01", "OwnTriangle",
         "single triangles with coordinates of 1e-8 to 1e8 in the loader's frame, 64 hits each, 16 "
         "directions, one in four "
         "grazing",
         "a plane is not met again", "the offset is a bound of all errors of that hit", own_triangle},
        {"S02", "TessellatedPlane",
         "a tilted plane of 131,072 coplanar triangles: into triangles, at edges, at corners",
         "a plane is not met again", "as S01; knowing the own triangle would not do", tessellated_plane},
        {"S03", "ConvexBody", "an icosphere of 20,480 triangles, rays outward",
         "a convex body is not met again", "as S01", convex_body},
        {"S04", "OffsetSize", "a ball of 24 x 24 in five sizes and places",
         "the way from the hit to the next ray's origin",
         "a few roundings: 2e-6 of the size, 4 units in the last place of the distance where that is larger",
         offset_size},
        {"S05", "ThinGap",
         "two planes 8 offset bounds apart, rays that leave one towards the other, at 1 and at 1e3",
         "the other plane is met", "two bounds and the rounding of the origin are less than 8", thin_gap},
        {"S06", "ShadowRayEnds", "a triangle light, with and without a blocker 8 offset bounds before it",
         "alone the light is seen, behind the blocker it is not",
         "the shadow ray ends within two bounds of the light", shadow_ray_ends},
        {"S07", "LightTightRooms",
         "closed rooms with walls at 90 to 5 degrees, paths of six rays, into edges and corners too",
         "no ray gets out",
         "hits keep two offset bounds away from edges, which is enough from 27 degrees on; between sharper "
         "walls rays start behind "
         "the other one within a few bounds of the edge, where half of these rays are aimed",
         light_tight_rooms},
        {"S08", "ShadowTerminator", "smooth icospheres of 80 to 1280 triangles under a sun",
         "the cosine of the true sphere", "no terminator may show; coarser facets lie farther below the ball",
         shadow_terminator},
    };
    return cases;
}

} // namespace clrt
