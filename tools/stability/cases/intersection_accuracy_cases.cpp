// SPDX-License-Identifier: Apache-2.0
// Intersection: how exact hits are, and trees without end.
#include "naive/naive_kernels.h"
#include "probes/leaving_rays.h"
#include "probes/scene_builder.h"
#include "stability/cases/intersection_cases.h"
#include "stability/cases/ray_builds.h"
#include "stability/probe_set.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace clrt {

namespace {

const char* const TEXT = R"(
static void probe_triangle(real3 origin, real3 direction, real3 p0, real3 p1, real3 p2, real* out)
{
    const Ray ray = ray_make(origin, direction, REAL(0.0));
    const RayShear shear = ray_shear_make(&ray);
    const real3 p[3] = {p0, p1, p2};
    real x[3], y[3], z[3], u, v, w, det, t_det;
    for (int corner = 0; corner < 3; ++corner) {
        const real3 permuted = ray_permuted(p[corner], shear.kz);
        x[corner] = permuted.x;
        y[corner] = permuted.y;
        z[corner] = permuted.z;
    }
    triangle_edges(&shear, x, y, z, &u, &v, &w, &det, &t_det);
    const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    out[0] = inside && det != 0 ? 1 : 0;
    out[1] = t_det / det;
    out[2] = v / det;
    out[3] = w / det;
}
)";

/// Rays, each with a triangle of its own.
struct Pairs {
    Columns columns = Columns(15);

    void add(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& p0,
             const glm::dvec3& p1, const glm::dvec3& p2) {
        size_t column = 0;
        for (const glm::dvec3& v : {origin, direction, p0, p1, p2})
            for (int axis = 0; axis < 3; ++axis)
                columns[column++].push_back(float(v[axis]));
    }
    size_t size() const { return columns[0].size(); }
    /// Origin, direction or a corner as the kernels see it.
    glm::dvec3 vector(size_t i, size_t which) const {
        return {columns[3 * which][i], columns[3 * which + 1][i], columns[3 * which + 2][i]};
    }
    TestRay ray(size_t i) const { return {to_vec4(vector(i, 0), FAR_AWAY), to_vec4(vector(i, 1))}; }
    std::string text(size_t i) const {
        std::string corners;
        for (size_t k = 2; k < 5; ++k)
            corners += fmt::format(" ({:a}, {:a}, {:a})", vector(i, k).x, vector(i, k).y, vector(i, k).z);
        return ray_text(ray(i)) + ", corners" + corners;
    }
};

/// What probe_triangle gives: hit, t, b1, b2.
using Found = std::vector<std::vector<double>>;

/// One program a build serves all cases that have pairs.
Found run_pairs(const CaseRun& run, Build build, const Pairs& pairs) {
    auto& probes = run.device.once<ProbeSet>("triangles", [&] {
        ProbeSet made(run.device, {"geometry/triangle.h"},
                      {{"triangle", 15, 4,
                        "probe_triangle((real3)(a, b, c), (real3)(d, e, f), (real3)(g, h, j), "
                        "(real3)(k, l, m), (real3)(n, o, p), out);",
                        ""}},
                      TEXT);
        made.use_naive_kernels(plain_triangles(run.device).files);
        return made;
    });
    return probes.run(build, "triangle", pairs.columns);
}

/// A triangle as seen along a ray, in double.
struct Seen {
    glm::dvec2 corners[3];
    double depths[3];
    double reach = 0; ///< largest component of a corner from the origin
};

Seen seen_along(const Pairs& pairs, size_t i) {
    const glm::dvec3 d = glm::normalize(pairs.vector(i, 1));
    const glm::dvec3 x =
        glm::normalize(glm::cross(d, std::abs(d.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    Seen seen;
    for (size_t k = 0; k < 3; ++k) {
        const glm::dvec3 p = pairs.vector(i, 2 + k) - pairs.vector(i, 0);
        seen.corners[k] = {glm::dot(p, x), glm::dot(p, glm::cross(d, x))};
        seen.depths[k] = glm::dot(p, d) / glm::length(pairs.vector(i, 1));
        seen.reach = std::max({seen.reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    return seen;
}

/// How far the ray passes the triangle; 0 where it meets it.
double passes_by(const Seen& seen) {
    const auto area = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    double nearest = INFINITY;
    int left = 0, right = 0;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 a = seen.corners[k], edge = seen.corners[(k + 1) % 3] - a;
        (area(a, edge) >= 0 ? left : right) += 1;
        const double along = std::clamp(-glm::dot(a, edge) / glm::dot(edge, edge), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(a + along * edge));
    }
    return left == 3 || right == 3 ? 0 : nearest;
}

Pairs needles(size_t count) {
    Random random(4);
    Pairs pairs;
    while (pairs.size() < count) {
        const glm::dvec3 p0 = random.in_cube(1), along = random.direction();
        const glm::dvec3 across = glm::normalize(glm::cross(along, random.direction()));
        const double width = std::abs(random.signed_log(1e-7, 0.1));
        const glm::dvec3 target = p0 + along * random.unit() + across * (width * random.between(-1, 2));
        const double angle = random.between(0, 2 * PI);
        const glm::dvec3 way = along * std::cos(angle) + across * std::sin(angle) +
                               glm::cross(along, across) * random.between(0, 0.017);
        pairs.add(target - way * random.between(0.1, 3), glm::normalize(way), p0, p0 + along,
                  p0 + along * random.unit() + across * width);
    }
    return pairs;
}

} // namespace

void false_hits(CaseRun& run) {
    const Pairs pairs = needles(run.count(2e5, 1e6, 1e7));
    const bool exact = run.device.info.correctly_rounded_division;
    Figure& beside =
        run.figure("distance by which a hit is missed, of the reach", (exact ? 8.5 : 14.2) * FLOAT_U);
    Figure& depth = run.figure("t outside the corners' depths, of the largest", 8 * FLOAT_U);
    for (const Build build : run.builds()) {
        const Found found = run_pairs(run, build, pairs);
        for (size_t i = 0; i < pairs.size(); ++i) {
            if (found[0][i] == 0)
                continue;
            const Seen seen = seen_along(pairs, i);
            const auto describe = [&] { return pairs.text(i); };
            beside[build].see(passes_by(seen) / seen.reach, describe);
            const auto [low, high] = std::minmax({seen.depths[0], seen.depths[1], seen.depths[2]});
            const double t = found[1][i];
            depth[build].see(std::max({low - t, t - high, 0.0}) / std::max(std::abs(low), std::abs(high)),
                             describe);
        }
    }
}

void distance_and_weights(CaseRun& run) {
    Random random(3);
    Pairs pairs;
    while (pairs.size() < run.count(2e5, 1e6, 1e7)) {
        double u = random.unit(), v = random.unit();
        if (u + v > 1)
            u = 1 - u, v = 1 - v;
        const glm::dvec3 target(u, v, 0),
            origin = target + random.between(0.25, 1) * random.upper_direction();
        pairs.add(origin, glm::normalize(target - origin), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    }
    Figure& distance = run.figure("|dt|", 16 * FLOAT_U);
    Figure& weights = run.figure("|db|", 16 * FLOAT_U);
    for (const Build build : run.builds()) {
        const Found found = run_pairs(run, build, pairs);
        for (size_t i = 0; i < pairs.size(); ++i) {
            if (found[0][i] == 0)
                continue; // the rounded ray passes outside
            const glm::dvec3 o = pairs.vector(i, 0), d = pairs.vector(i, 1);
            const double t = -o.z / d.z;
            // At grazing incidence any error across the ray is a larger one along it and along the plane.
            const double scale = std::max(1.0, 1 / std::abs(d.z) / 8);
            const auto describe = [&] { return ray_text(pairs.ray(i)); };
            distance[build].see(std::abs(found[1][i] - t) / scale, describe);
            weights[build].see(
                std::max(std::abs(found[2][i] - (o.x + t * d.x)), std::abs(found[3][i] - (o.y + t * d.y))) /
                    scale,
                describe);
        }
    }
}

void depth_order(CaseRun& run) {
    Random random(9);
    Pairs front, behind;
    std::vector<double> apart; // in units in the last place of the distance
    for (size_t i = 0; i < run.count(1e5, 1e6, 1e7); ++i) {
        const float z = float(std::pow(10, random.between(0, 4)));
        const int k = int(i % 64) + 1;
        float z_behind = z;
        for (int step = 0; step < k; ++step)
            z_behind = std::nextafter(z_behind, 1e30f);
        const glm::dvec3 way =
            glm::normalize(glm::dvec3{random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1});
        const glm::dvec3 corner = way / way.z * double(z) -
                                  glm::dvec3{random.between(0.2, 0.5) * z, random.between(0.2, 0.4) * z, 0};
        const auto add = [&](Pairs& pairs, double depth) {
            pairs.add({0, 0, 0}, way, {corner.x, corner.y, depth}, {corner.x + 1.2 * z, corner.y, depth},
                      {corner.x, corner.y + 1.2 * z, depth});
        };
        add(front, z);
        add(behind, z_behind);
        const auto distance = float(z / way.z);
        const double unit = double(std::nextafter(distance, 1e30f)) - double(distance);
        apart.push_back((double(z_behind) - double(z)) / way.z / unit);
    }
    Figure& swapped = run.figure("pairs in the wrong order, 4 units or more apart", 0);
    for (const Build build : run.builds()) {
        const Found a = run_pairs(run, build, front), b = run_pairs(run, build, behind);
        for (size_t i = 0; i < apart.size(); ++i)
            if (apart[i] >= 4 && a[0][i] != 0 && b[0][i] != 0)
                swapped[build].count(!(a[1][i] < b[1][i]), [&] {
                    return fmt::format("{:.1f} units: {}", apart[i], front.text(i));
                });
    }
}

void deep_trees(CaseRun& run) {
    Figure& differences = run.figure("rays whose hit differs in any bit", 0);
    Scene chain = make_empty_scene();
    for (int k = 0; k <= 120; ++k) {
        const double s = std::ldexp(1.0, -k);
        add_triangle(chain, {s, 0, 0}, {s, s / 2, 0}, {s, 0, s / 2});
        add_triangle(chain, {s, s, 0}, {s / 2, s, s / 4}, {s, s / 2, s / 4});
    }
    Random random(7);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < run.count(1e4, 1e5, 1e6); ++i) {
        const Triangle& triangle = chain.triangles[random.word() % chain.triangles.size()];
        // From everywhere, and along the chain so that all boxes are met.
        rays.push_back(
            i % 2 ? make_ray_to(random.in_cube(2), corner_position(chain, triangle, int(random.word() % 3)))
                  : make_ray({-0.5, 0, 0}, {1, random.between(-1e-3, 1e-3), random.between(-1e-3, 1e-3)}));
    }
    count_tree_differences(run, chain, rays, "chain", differences);
    // Beside each shrinking level stands a group of much larger triangles: the cheapest wide tree would have
    // more levels than the smallest stack has entries.
    Scene groups = make_empty_scene();
    for (int k = 0; k < 58; ++k)
        for (int i = 0; i < 64; ++i) {
            const double s = std::ldexp(1.0, 58 - 3 * k), step = s / 8, y = i % 8 * step, z = i / 8 * step;
            add_triangle(groups, {0.9 * s, y, z}, {s, y + step / 2, z}, {0.95 * s, y, z + step / 2});
        }
    rays.clear();
    for (size_t i = 0; i < run.count(2e3, 2e4, 2e5); ++i)
        rays.push_back(make_ray_to(
            {0, 0, 0},
            corner_position(groups, groups.triangles[random.word() % groups.triangles.size()], int(i % 3))));
    count_tree_differences(run, groups, rays, "groups", differences);
}

void far_ball(CaseRun& run) {
    const Scene ball = make_ball(24, 24);
    Figure& lost = run.figure("rays lost", 0);
    Figure& error = run.figure("|dt| / t", 20 * FLOAT_U);
    for (const double distance : {10.0, 100.0, 1e3, 1e4, 1e5}) {
        Random random(6);
        std::vector<TestRay> rays;
        std::vector<double> expected;
        while (rays.size() < run.count(5e3, 5e4, 5e5)) {
            const Triangle& triangle = ball.triangles[random.word() % ball.triangles.size()];
            const glm::dvec3 target = corner_position(ball, triangle, int(random.word() % 3));
            const glm::dvec3 origin = to_dvec3(to_vec4(distance * random.direction()));
            // Away from the outline, where the rounding of the direction decides.
            if (glm::dot(target, glm::normalize(origin)) < 0.4)
                continue;
            rays.push_back(make_ray_to(origin, target));
            expected.push_back(glm::length(target - origin));
        }
        for (const Build build : run.builds())
            for_each_tree(
                build, plain_triangles(run.device),
                [&](const RayDeviceOptions& options, const std::string& tree) {
                    const std::vector<TestHit> hits = RayDevice(run.device, ball, options).closest(rays);
                    for (size_t i = 0; i < rays.size(); ++i) {
                        const auto describe = [&] {
                            return fmt::format("from {}, {}: {}", distance, tree, ray_text(rays[i]));
                        };
                        lost[build].count(hits[i].triangle == NO_INDEX, describe);
                        if (hits[i].triangle != NO_INDEX)
                            error[build].see(std::abs(hits[i].t - expected[i]) / expected[i], describe);
                    }
                });
    }
}

void planet(CaseRun& run) {
    Scene scene = make_empty_scene();
    for (const TestTriangle& triangle : icosphere_triangles({0, 0, 0}, 6.4e6, 5))
        add_triangle(scene, triangle.corners[0], triangle.corners[1], triangle.corners[2]);
    scene = normalised(scene);
    const double unit =
        1.0 / 4194304; // the loader's scale: the half-diagonal of the box is between 2^23 and 2^24
    Random random(8);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < run.count(2e4, 2e5, 1e6); ++i) {
        const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
        const glm::dvec3 n = glm::normalize(triangle_normal(scene, triangle));
        const glm::dvec3 above = point_on(scene, triangle, random) + n * (random.between(1, 100) * unit);
        rays.push_back(
            make_ray(above, leaving_direction(n, make_ray({0, 0, 0}, n), random.between(0.1, 1), random)));
    }
    Figure& depth = run.figure("|dt| cos, of the facet's offset bound", 1);
    Figure& again = run.figure("rays that leave the body and meet it", 0);
    for (const Build build : run.builds()) {
        const RayDevice device(run.device, scene, ray_options(build, plain_offsets(run.device)));
        const Arrivals from = arrivals(device, rays);
        const std::vector<TestPoint> points = device.points(from.rays, from.hits);
        for (size_t i = 0; i < from.rays.size(); ++i) {
            const Triangle& triangle = scene.triangles[from.hits[i].triangle];
            const glm::dvec3 n = glm::normalize(triangle_normal(scene, triangle)),
                             d = to_dvec3(from.rays[i].direction);
            const double cosine = std::abs(glm::dot(n, d));
            const double t =
                glm::dot(n, corner_position(scene, triangle, 0) - to_dvec3(from.rays[i].origin)) /
                glm::dot(n, d);
            depth[build].see(std::abs(from.hits[i].t - t) * cosine / points[i].offset,
                             [&] { return ray_text(from.rays[i]); });
        }
        const std::vector<TestRay> away = leave_at_random(scene, device, from, random);
        const std::vector<u32> met = device.any(away);
        for (size_t i = 0; i < away.size(); ++i)
            again[build].count(met[i] != 0, [&] { return ray_text(away[i]); });
    }
}

} // namespace clrt
