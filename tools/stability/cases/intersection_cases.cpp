// SPDX-License-Identifier: Apache-2.0
// Intersection: closed meshes hold every ray, and trees find what all triangles give.
#include "stability/cases/intersection_cases.h"

#include "probes/aimed_rays.h"
#include "stability/cases/ray_builds.h"
#include "stability/catalogue.h"
#include "stability/choices.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace clrt {

namespace {

constexpr float INFINITE = std::numeric_limits<float>::infinity();
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

/// Counts rays that get out of a closed mesh, in all placements, as it is and in the loader's frame.
void hold_rays(CaseRun& run, const Scene& mesh, double inner, Aim aim) {
    Figure& lost = run.figure(aim == Aim::VERTEX ? "rays at vertices lost" : "rays at edges lost", 0);
    const size_t count = run.count(1e4, 1e5, 1e6);
    for (const Placement& placement : PLACEMENTS)
        for (const bool in_frame : {false, true}) {
            const Scene in_world = place(mesh, placement);
            const Scene scene = in_frame ? normalised(in_world) : in_world;
            const std::vector<TestRay> rays = aimed_rays(scene, inner, aim, count, 7);
            for (const Build build : run.builds())
                for_each_tree(build, plain_triangles(run.device),
                              [&](const RayDeviceOptions& options, const std::string& tree) {
                                  const std::vector<TestHit> hits =
                                      RayDevice(run.device, scene, options).closest(rays);
                                  for (size_t i = 0; i < rays.size(); ++i)
                                      lost[build].count(hits[i].triangle == NO_INDEX, [&] {
                                          return fmt::format("{}{}, {}: {}", placement.name,
                                                             in_frame ? " in the loader's frame" : "", tree,
                                                             ray_text(rays[i]));
                                      });
                              });
        }
}

void ball_vertices(CaseRun& run) {
    hold_rays(run, make_ball(24, 24), BALL_INNER, Aim::VERTEX);
}
void ball_edges(CaseRun& run) {
    hold_rays(run, make_ball(24, 24), BALL_INNER, Aim::EDGE);
}

void star(CaseRun& run) {
    const Scene mesh = make_star(24, 24, 5);
    hold_rays(run, mesh, STAR_INNER, Aim::VERTEX);
    hold_rays(run, mesh, STAR_INNER, Aim::EDGE);
}

void all_triangles(CaseRun& run) {
    const Scene soup = make_soup(int(run.count(5e3, 2e4, 1e5)), 0.2, 4), ball = make_ball(24, 24);
    Figure& differences = run.figure("rays whose hit differs in any bit", 0);
    count_tree_differences(run, soup, rays_at(soup, run.count(1e4, 1e5, 1e6), 1), "soup", differences);
    count_tree_differences(run, ball, aimed_rays(ball, BALL_INNER, Aim::EDGE, run.count(1e4, 1e5, 1e6), 2),
                           "ball", differences);
    // Far away, planes of boxes are the harder part.
    const Scene far_away = place(make_star(24, 24, 5), {"", 2, 2.6e5});
    count_tree_differences(run, far_away,
                           aimed_rays(far_away, STAR_INNER, Aim::VERTEX, run.count(1e4, 1e5, 1e6), 3),
                           "star 2@2.6e5", differences);
}

void face_planes(CaseRun& run) {
    Figure& differences = run.figure("rays whose hit differs in any bit", 0);
    count_tree_differences(run, make_cubes(), rays_in_lattice_planes(run.count(2e4, 1e5, 1e6), 3), "cubes",
                           differences);
    // Along the axes, from within a box, at its walls' diagonals too.
    Random random(4);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < run.count(2e4, 1e5, 1e6); ++i) {
        glm::dvec3 direction(0), origin = random.in_cube(0.999);
        direction[int(i % 3)] = i & 1 ? 1 : -1;
        if (i % 5 == 0)
            origin[int(i + 1) % 3] = origin[int(i + 2) % 3];
        if (i % 7 == 0)
            origin = {0, 0, 0};
        rays.push_back(make_ray(origin, direction));
    }
    const Scene room = make_room({-1, -1, -1}, {1, 1, 1});
    Figure& lost = run.figure("axis-parallel rays lost in a box", 0);
    for (const Build build : run.builds())
        for_each_tree(
            build, plain_boxes(run.device), [&](const RayDeviceOptions& options, const std::string& tree) {
                const std::vector<TestHit> hits = RayDevice(run.device, room, options).closest(rays);
                for (size_t i = 0; i < rays.size(); ++i)
                    lost[build].count(hits[i].triangle == NO_INDEX,
                                      [&] { return tree + ": " + ray_text(rays[i]); });
            });
}

void flat_boxes(CaseRun& run) {
    constexpr int CELLS = 256;
    Scene grid = make_tilted_plane(CELLS);
    for (vec4& p : grid.positions)
        p = {p.x, 0.0f, p.y, 0.0f};
    const std::vector<TestRay> rays = rays_at_flat_grid(grid, CELLS, run.count(2e4, 2.5e5, 1e6), 5);
    Figure& lost = run.figure("rays lost", 0);
    Figure& distance =
        run.figure("|dt| / t", (run.device.info.correctly_rounded_division ? 13 : 21) * FLOAT_U);
    for (const Build build : run.builds())
        for_each_tree(
            build, plain_boxes(run.device), [&](const RayDeviceOptions& options, const std::string& tree) {
                const std::vector<TestHit> hits = RayDevice(run.device, grid, options).closest(rays);
                for (size_t i = 0; i < rays.size(); ++i) {
                    const auto describe = [&] { return tree + ": " + ray_text(rays[i]); };
                    const bool missed = hits[i].triangle == NO_INDEX;
                    lost[build].count(missed, describe);
                    const double t = -double(rays[i].origin.y) / rays[i].direction.y;
                    if (!missed)
                        distance[build].see(std::abs(hits[i].t - t) / t, describe);
                }
            });
}

/// Rays towards the origin with one component replaced by each of the values.
void spoil(std::vector<TestRay>& rays, const std::vector<float>& values, size_t count, float vec4::*member,
           vec4 TestRay::*part) {
    Random random(1);
    for (size_t i = 0; i < count; ++i) {
        TestRay ray = make_ray_to(random.in_cube(3), random.in_cube(0.5));
        ray.*part.*member = values[i % values.size()];
        rays.push_back(ray);
    }
}

void bad_rays(CaseRun& run) {
    const size_t count = run.count(2e3, 1e5, 1e5);
    const std::vector<float> bad = {NOT_A_NUMBER, -NOT_A_NUMBER, INFINITE, -INFINITE};
    std::vector<TestRay> rays, good;
    for (const auto member : {&vec4::x, &vec4::y, &vec4::z}) {
        spoil(rays, bad, count, member, &TestRay::origin);
        spoil(rays, bad, count, member, &TestRay::direction);
    }
    spoil(rays, {NOT_A_NUMBER, -NOT_A_NUMBER, 0.0f, -0.0f, -1.0f, -INFINITE}, count, &vec4::w,
          &TestRay::origin);
    for (size_t i = 0; i < count; ++i) {
        TestRay ray = make_ray(glm::dvec3(double(i) / double(count)), {0, 0, 1});
        ray.direction = {i & 1 ? 0.0f : -0.0f, i & 2 ? 0.0f : -0.0f, i & 4 ? 0.0f : -0.0f, 0};
        rays.push_back(ray);
    }
    spoil(good, {FAR_AWAY}, rays.size(), &vec4::w, &TestRay::origin);
    const Scene ball = make_ball(24, 24);
    Figure& hits = run.figure("bad rays that hit", 0);
    Figure& slowness = run.figure("time over that of good rays", 2.5);
    for (const Build build : robust_builds(run))
        for_each_tree(build, plain_boxes(run.device),
                      [&](const RayDeviceOptions& options, const std::string& tree) {
                          const RayDevice device(run.device, ball, options);
                          const std::vector<TestHit> found = device.closest(rays);
                          const std::vector<u32> any = device.any(rays);
                          for (size_t i = 0; i < rays.size(); ++i)
                              hits[build].count(found[i].triangle != NO_INDEX || any[i],
                                                [&] { return tree + ": " + ray_text(rays[i]); });
                          if (options.quality == BvhQuality::FAST)
                              slowness[build].see(time_in_turns(run.device, device.tracer(good),
                                                                device.tracer(rays), rays.size(), 5)
                                                      .ratio,
                                                  [&] { return tree; });
                      });
}

} // namespace

void count_tree_differences(CaseRun& run, const Scene& scene, const std::vector<TestRay>& rays,
                            const std::string& name, Figure& differences) {
    for (const Build build : run.builds()) {
        std::vector<TestHit> all;
        for_each_tree(build, plain_boxes(run.device),
                      [&](const RayDeviceOptions& options, const std::string& tree) {
                          const RayDevice device(run.device, scene, options);
                          if (all.empty())
                              all = device.closest_of_all(rays);
                          const std::vector<TestHit> found = device.closest(rays);
                          for (size_t i = 0; i < rays.size(); ++i)
                              differences[build].count(found[i] != all[i], [&] {
                                  return fmt::format("{}, {}: {}", name, tree, ray_text(rays[i]));
                              });
                      });
    }
}

namespace {

/// Times the kernels of a variant against clrt's on rays through a soup.
ProbeTime time_variant(const ProbeDevice& device, const KernelVariant& variant, int rounds) {
    const Scene soup = make_soup(100000, 0.05, 4);
    const std::vector<TestRay> rays = rays_at(soup, 1 << 17, 1);
    const RayDevice naive(device, soup, ray_options(Build::NAIVE, variant)),
        single(device, soup, ray_options(Build::SINGLE, variant));
    return time_in_turns(device, naive.tracer(rays), single.tracer(rays), rays.size(), rounds);
}

} // namespace

ProbeTime time_edge_test(const ProbeDevice& device, int rounds) {
    return time_variant(device, plain_triangles(device), rounds);
}
ProbeTime time_slab(const ProbeDevice& device, int rounds) {
    return time_variant(device, plain_boxes(device), rounds);
}

const std::vector<StabilityCase>& intersection_cases() {
    static const std::vector<StabilityCase> cases = {
        {"I01", "VertexAimedBall",
         "a closed ball of 24 x 24 in five sizes and places, as it is and in the loader's frame; rays from "
         "inside at its "
         "vertices, in every layout and quality of tree",
         "a closed mesh holds every ray", "edge functions have exact signs and ties count as inside",
         ball_vertices},
        {"I02", "EdgeAimedBall", "the same, at random points of edges", "a closed mesh holds every ray",
         "as I01", ball_edges},
        {"I03", "SpikyStar",
         "the ball with every corner's distance times a random number in [1, 6): at vertices, then at edges",
         "a closed mesh holds every ray", "as I01", star},
        {"I04", "TreeIsAllTriangles",
         "a soup, a ball aimed at, a star far away, in every layout and quality of tree",
         "a loop over all triangles", "boxes are conservative for the very arithmetic of the triangle test",
         all_triangles},
        {"I05", "RaysInFacePlanes",
         "cubes on a lattice: origin, direction or both in the planes of their boxes, zeros of either sign; "
         "axis-parallel rays "
         "within a box",
         "a loop over all triangles; a closed box holds every ray", "as I04", face_planes},
        {"I06", "BoxesWithoutThickness", "a grid of 256 x 256 quads in y = 0, aimed at corners and edges",
         "t = -o.y / d.y",
         "weighted depths 6 u, sum of weights 4 u, two quotients and a product: 13 u where divisions are "
         "exact, 21 u where "
         "within 2.5 units in the last place; 4 u would leave out that weights round too",
         flat_boxes},
        {"I07", "FalseHits", "needles of aspect above 10 seen within a degree of their plane",
         "distance from ray to triangle in double; depths of the corners",
         "corners are sheared with at most 8.5 u of the reach where divisions are exact, 14.2 u where within "
         "2.5 units in the "
         "last place; a weighted mean of depths stays between them",
         false_hits},
        {"I08", "DistanceAndWeights", "random rays at the unit triangle", "the plane z = 0 in double",
         "8 units in the last place of 1, half of what Embree's own test allows; at grazing incidence over "
         "the cosine",
         distance_and_weights},
        {"I09", "DepthOrder",
         "two parallel triangles k units in the last place apart, k from 1 to 64, at 1 to 1e4",
         "the exact order",
         "an error of at most 2 units in the last place of the distance each keeps the order of pairs 4 or "
         "more "
         "apart",
         depth_order},
        {"I10", "DeepTree",
         "triangles at 2^-k, k = 0..120; 58 shrinking groups that make the longest path of a tree",
         "a loop over all triangles", "the builders bound the depth that the stacks are made for",
         deep_trees},
        {"I11", "BadRays", "NaN, infinity, no direction, no length in every place; a second set of good rays",
         "a miss by definition",
         "they are turned away before traversal; 2.5 times the time of good rays is what Embree's tests "
         "allow",
         bad_rays},
        {"I12", "FarSmallBall", "a ball of triangles seen from 10 to 1e5 radii",
         "distance to the vertex aimed at",
         "the rounded direction passes the target by up to 2 u of the distance on a slope of up to 1 / 0.35",
         far_ball},
        {"I13", "Planet",
         "a ball of triangles, R = 6.4e6, rays from 1 to 100 above its facets, and rays that leave it",
         "the facet's plane in double; a convex body is not met again",
         "a depth rounds with the facet's size and place: the offset bound over the cosine", planet},
    };
    return cases;
}

} // namespace clrt
