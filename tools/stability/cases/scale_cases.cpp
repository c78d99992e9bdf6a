// SPDX-License-Identifier: Apache-2.0
// Scale and position: powers of two, units, far places, sizes that differ by 1e7.
#include "probes/film_estimate.h"
#include "probes/leaving_rays.h"
#include "probes/scratch_scene.h"
#include "scene/cut_vast.h"
#include "stability/cases/offsets_cases.h"
#include "stability/cases/ray_builds.h"
#include "stability/catalogue.h"
#include "stability/choices.h"
#include "stability/mean_figure.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

/// Area light, sky, sun, gloss, glass and smooth normals, `scale` times as large.
Render render_scaled(const ProbeDevice& device, double scale, Precision precision, std::uint32_t spp) {
    ScratchScene scene;
    scene.build.material("white", "Kd 0.7 0.6 0.5").material("lamp", "Kd 0 0 0\nKe 8 7 5");
    scene.build.material("gloss", "Kd 0.2 0.2 0.2\nKs 0.6 0.6 0.6\nNs 30\nillum 2")
        .material("glass", "Ni 1.5\nillum 7");
    scene.build.use("white").floor(2).box({-0.7, 0.01, -0.9}, {-0.2, 0.8, -0.4});
    scene.build.use("lamp").polygon({{-0.4, 1.9, -0.4}, {0.4, 1.9, -0.4}, {0.4, 1.9, 0.4}, {-0.4, 1.9, 0.4}});
    scene.build.use("gloss").icosphere({0.5, 0.4, 0.1}, 0.3, 2, Facing::OUTWARD, Shading::SMOOTH);
    scene.build.use("glass").icosphere({-0.2, 0.35, 0.5}, 0.25, 2, Facing::OUTWARD, Shading::SMOOTH);
    scene.options.light.environment = glm::dvec3(0.3, 0.4, 0.5);
    scene.options.light.suns.push_back({{1, 2, 1}, {0.5, 0.5, 0.4}, 3});
    scene.look(glm::dvec3(0.2, 1, 3) * scale, glm::dvec3(0, 0.5, 0) * scale, 45);
    scene.options.film.size = {32, 24};
    scene.options.sampling.spp = spp;
    scene.options.sampling.replicates = 8;
    scene.options.device.precision = precision;
    scene.scale = scale;
    return scene.render(device);
}

/// Single, and double where the device has it.
std::vector<Build> picture_builds(const CaseRun& run) {
    std::vector<Build> builds = {Build::SINGLE};
    if (run.device.info.fp64)
        builds.push_back(Build::DOUBLE);
    return builds;
}

void compare_scales(CaseRun& run, const std::vector<int>& exponents) {
    Figure& differing = run.figure("sums of the film that differ in any bit", 0);
    for (const Build build : picture_builds(run)) {
        const Film one = render_scaled(run.device, 1, precision_of(build), 8).film;
        for (const int k : exponents) {
            const Film other = render_scaled(run.device, std::ldexp(1.0, k), precision_of(build), 8).film;
            for (size_t i = 0; i < one.sums.size(); ++i)
                differing[build].count(one.sums[i] != other.sums[i],
                                       [&] { return fmt::format("times 2^{}, sum {}", k, i); });
        }
    }
}

void powers_of_two(CaseRun& run) {
    std::vector<int> exponents;
    for (int k = -20; k <= 23; k += run.tier == Tier::QUICK ? (k < 0 ? 4 : 5) : 1)
        if (k != 0)
            exponents.push_back(k);
    exponents.push_back(23);
    compare_scales(run, exponents);
}

void absurd_units(CaseRun& run) {
    compare_scales(run, {-60, 60});
}

void units(CaseRun& run) {
    Figure& z = run.figure("|z| of the picture's mean", MeanFigure::LARGEST_Z);
    // Units that change the light by a twentieth are seen.
    Figure& noise = run.figure("relative standard error of the difference", 0.01);
    Figure& median = run.figure("median relative difference of a pixel", 1e-4);
    const std::uint32_t spp = std::uint32_t(run.count(32, 256, 4096));
    for (const Build build : picture_builds(run)) {
        const Film one = render_scaled(run.device, 1, precision_of(build), spp).film;
        const std::vector<float> expected = film_mean(one);
        for (int k = -6; k <= 7; k += run.tier == Tier::QUICK && k < 6 ? 3 : 1) {
            const Film other = render_scaled(run.device, std::pow(10.0, k), precision_of(build), spp).film;
            const Estimate a = film_estimate(one), b = film_estimate(other);
            const auto describe = [&] { return fmt::format("times 1e{}", k); };
            const double error = std::hypot(a.error, b.error);
            z[build].see(std::abs(a.mean - b.mean) / error, describe);
            noise[build].see(error / a.mean, describe);
            const std::vector<float> found = film_mean(other);
            std::vector<double> differences;
            for (size_t i = 0; i < found.size(); ++i)
                differences.push_back(std::abs(found[i] - expected[i]) / std::max(expected[i], 1e-3f));
            std::nth_element(differences.begin(),
                             differences.begin() + std::ptrdiff_t(differences.size() / 2), differences.end());
            median[build].see(differences[differences.size() / 2], describe);
        }
    }
}

void moved(CaseRun& run) {
    Figure& escapes = run.figure("rays that get out of a room", 0);
    Figure& shift = run.figure("corners' shift, units in the last place of the position", 2);
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.6, 0.3, -0.7));
    for (const double distance : {1e3, 1e4, 1e5}) {
        const Scene room = placed(make_room({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), 1, towards * distance);
        count_escapes(run, room, run.count(2e3, 5e4, 1e6), fmt::format("{} away", distance), escapes);
        count_escapes(run, normalised(room), run.count(2e3, 5e4, 1e6),
                      fmt::format("{} away, loaded", distance), escapes);
        ScratchScene text;
        text.build.material("m", "Kd 1 1 1").use("m").icosphere(towards * distance, 0.5, 2);
        const Scene scene = text.load();
        const std::vector<TestTriangle> exact = icosphere_triangles(towards * distance, 0.5, 2);
        const double ulp = std::ldexp(1.0, std::ilogb(distance * 0.7) - 23);
        for (size_t i = 0; i < exact.size(); ++i)
            for (int corner = 0; corner < 3; ++corner) {
                const glm::dvec3 p =
                    corner_position(scene, scene.triangles[i], corner) / scene.normalisation.scale +
                    scene.normalisation.centre;
                const glm::dvec3 away = glm::abs(p - exact[i].corners[corner]);
                shift[Build::SINGLE].see(std::max({away.x, away.y, away.z}) / ulp,
                                         [&] { return fmt::format("{} away, triangle {}", distance, i); });
            }
    }
}

constexpr double UNIT = 0x1p-23; ///< of the scene below, in the loader's frame

/// Two triangles of 1e7 units a side, tilted, and a ball of radius 1 that touches them in the origin.
Scene make_ball_on_vast_ground(const glm::dvec3& normal) {
    const glm::dvec3 x = glm::normalize(glm::cross(normal, {0.2, 0.1, 1})) * (1e7 * UNIT),
                     y = glm::cross(normal, x);
    Scene scene = make_empty_scene();
    const u32 first = add_position(scene, -x - y);
    for (const glm::dvec3& p : {x - y, x + y, y - x})
        add_position(scene, p);
    add_triangle(scene, first, first + 1, first + 2);
    add_triangle(scene, first, first + 2, first + 3);
    for (const TestTriangle& t : icosphere_triangles(normal * UNIT, UNIT, 3))
        add_triangle(scene, t.corners[0], t.corners[1], t.corners[2]);
    return scene;
}

void mixed_scale(CaseRun& run) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 1, 0.2)),
                     eye = up * UNIT + glm::dvec3(1, 1.5, 2.4) * UNIT;
    const Scene whole = make_ball_on_vast_ground(up);
    Scene loaded = whole;
    cut_vast_triangles(loaded);
    Random random(12);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < run.count(2e4, 2e5, 2e6); ++i) {
        const glm::dvec3 aside = random.in_cube(4 * UNIT);
        rays.push_back(make_ray_to(eye, aside - up * glm::dot(aside, up)));
    }
    Figure& off_plane = run.figure("hit off the ground's plane, units", 1e-3);
    Figure& slip = run.figure("hit beside the true one, units", 1e-3);
    Figure& depth = run.figure("|dt| / t on the ground", 1e-5);
    Figure& gap = run.figure("height at which rays leave the ground, units", 1e-3);
    for (const Build build : run.builds()) {
        const Scene& scene = build == Build::NAIVE ? whole : loaded;
        const RayDevice device(run.device, scene, ray_options(build, plain_offsets(run.device)));
        const Arrivals from = arrivals(device, rays);
        const std::vector<TestPoint> points = device.points(from.rays, from.hits);
        for (size_t i = 0; i < from.rays.size(); ++i) {
            if (from.hits[i].triangle > 1 && from.hits[i].triangle < whole.triangles.size())
                continue; // the ball
            // Pieces of the ground are judged by its plane.
            const glm::dvec3 p0 = corner_position(whole, whole.triangles[0], 0);
            const glm::dvec3 n = glm::normalize(triangle_normal(whole, whole.triangles[0]));
            const glm::dvec3 o = to_dvec3(from.rays[i].origin), d = to_dvec3(from.rays[i].direction);
            const double t = glm::dot(n, p0 - o) / glm::dot(n, d);
            // The textbook goes along the ray.
            const float float_t = float(from.hits[i].t);
            glm::dvec3 found = points[i].position;
            if (build == Build::NAIVE)
                for (int axis = 0; axis < 3; ++axis)
                    found[axis] = std::fma(float_t, float(d[axis]), float(o[axis]));
            const auto describe = [&] { return ray_text(from.rays[i]); };
            off_plane[build].see(std::abs(glm::dot(n, found - p0)) / UNIT, describe);
            slip[build].see(glm::length(found - (o + t * d)) / UNIT, describe);
            depth[build].see(std::abs(from.hits[i].t - t) / t, describe);
            gap[build].see(points[i].offset / UNIT, describe);
        }
    }
}

/// Inputs: three corners, or origin and direction in the first six; then two weights, or the distance.
const ProbedExpression HIT_POINT = {
    "hit_point", 11, 3,
    "const real3 p0 = (real3)(a, b, c);"
    "const real3 q = p0 + fma((real3)(k), (real3)(d, e, f) - p0, l * ((real3)(g, h, j) - p0));"
    "out[0] = q.x; out[1] = q.y; out[2] = q.z;",
    "const real3 q = fma((real3)(k), (real3)(d, e, f), (real3)(a, b, c));"
    "out[0] = q.x; out[1] = q.y; out[2] = q.z;"};

} // namespace

ProbeTime time_hit_point(const ProbeDevice& device, int rounds) {
    Random random(1);
    Columns inputs(11);
    for (std::vector<float>& column : inputs)
        for (int i = 0; i < 1 << 18; ++i)
            column.push_back(float(random.unit()));
    return ProbeSet(device, {"numerics/vector.h"}, {HIT_POINT}).time("hit_point", inputs, rounds);
}

const std::vector<StabilityCase>& scale_cases() {
    static const std::vector<StabilityCase> cases = {
        {"C01", "PowersOfTwo",
         "a scene of all kinds of light and surface times 2^k, k = -20 .. 23, by the loader",
         "the film of k = 0",
         "the loader divides by a power of two, exactly; the kernels are made for its frame alone",
         powers_of_two},
        {"C02", "Units", "the same scene times 10^k, k = -6 .. 7", "the picture of k = 0",
         "the same random numbers; only corners round anew", units},
        {"C03", "Moved", "a room and a ball 1e3, 1e4, 1e5 sizes away",
         "no ray gets out; the corners as written",
         "half a unit in the last place from the file, the frame adds less", moved},
        {"C04", "MixedScale",
         "a ball of radius 1 on two triangles of 1e7 a side, seen from 3 away; naive: along the ray, "
         "triangles as they are",
         "the plane in double", "contact within a thousandth of the ball", mixed_scale},
        {"C06", "AbsurdUnits", "the scene of C01 times 2^-60 and 2^60", "the film of 2^0", "as C01",
         absurd_units},
    };
    return cases;
}

} // namespace clrt
