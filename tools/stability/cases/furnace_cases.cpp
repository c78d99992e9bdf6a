// SPDX-License-Identifier: Apache-2.0
// Furnaces: surroundings in which a path's radiance is known to the last digit.
#include "stability/cases/shading_expressions.h"
#include "stability/catalogue.h"
#include "stability/mean_figure.h"
#include "stability/path_probe.h"

#include "probes/random_inputs.h"
#include "probes/statistics.h"

#include <fmt/format.h>

namespace clrt {

namespace {

using glm::dvec3;

constexpr int NO_ROULETTE = 65535;

/// Closed walls that glow and reflect.
struct Furnace : ScratchScene {
    Furnace(double reflectance, double glow, int max_depth) {
        build.material("wall", fmt::format("Kd {0} {0} {0}\nKe {1} {1} {1}", reflectance, glow)).use("wall");
        options.transport.max_depth = max_depth;
        options.transport.roulette_depth = NO_ROULETTE;
    }
};

/// Rays from near the middle in all directions.
std::vector<TestRay> rays_from_inside(const PathProbe& probe, size_t count, u32 seed) {
    Random random(seed);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 from = random.in_cube(0.2);
        rays.push_back(probe.ray(from, from + random.direction()));
    }
    return rays;
}

std::vector<double> reds(const std::vector<dvec3>& colours) {
    std::vector<double> values;
    for (const dvec3& colour : colours)
        values.push_back(colour.x);
    return values;
}

/// Paths alone find the light.
void leave_light_to_paths(RenderParams& params) {
    params.choose_emitter = 0;
    LIGHT_TREE_IS_USED(params) = 0;
}

void by_bsdf_sampling(CaseRun& run) {
    Figure& error = run.figure("|radiance - (1 - 2^-N)| of a path", 8 * FLOAT_U);
    Furnace scene(0.5, 0.5, 2);
    scene.build.icosphere({0, 0, 0}, 1, 3, Facing::INWARD);
    PathProbe probe(run.device, scene);
    leave_light_to_paths(probe.params);
    const std::vector<TestRay> rays = rays_from_inside(probe, run.count(500, 1e5, 1e6), 1);
    for (const Build build : path_builds(run))
        for (const u32 depth : {1u, 2u, 3u, 8u, 16u, 25u, 32u}) {
            probe.params.max_depth = depth;
            for (const dvec3& value : probe.radiance(build, Integrator::PATH, rays))
                error[build].see(std::abs(value.x - (1 - std::ldexp(1.0, -int(depth)))),
                                 [&] { return fmt::format("{} segments", depth); });
        }
}

void by_light_sampling(CaseRun& run) {
    // Six standard errors are 1e-3: a weight of light or BSDF sampling that is off by so much is seen.
    MeanFigure mean(run, "the mean", 1e-3 / 6);
    Furnace scene(0.5, 0.5, 32);
    scene.build.icosphere({0, 0, 0}, 1, 3, Facing::INWARD);
    PathProbe probe(run.device, scene);
    const std::vector<TestRay> rays = rays_from_inside(probe, 16, 2);
    for (const Build build : path_builds(run))
        mean.see(build, reds(probe.radiance(build, Integrator::PATH, rays, run.count(1500, 1e5, 1e6))), 1);
}

/// A ball whose radius waves between 0.7 and 1.3; triangles share their corners' bits.
void add_blob(SceneBuilder& build, int subdivisions) {
    for (const TestTriangle& triangle : icosphere_triangles({0, 0, 0}, 1, subdivisions)) {
        std::vector<dvec3> corners;
        for (const dvec3& c : triangle.corners)
            corners.insert(corners.begin(),
                           c * (1 + 0.3 * std::sin(7 * c.x) * std::sin(5 * c.y + 1) * std::cos(6 * c.z)));
        build.polygon(corners);
    }
}

void shapes(CaseRun& run) {
    Figure& leaks = run.figure("paths that lose light", 0);
    const char* const names[] = {"cube", "icosphere", "blob"};
    for (int shape = 0; shape < 3; ++shape) {
        Furnace scene(0.5, 0.5, 32);
        if (shape == 0)
            scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
        else if (shape == 1)
            scene.build.icosphere({0, 0, 0}, 1, 4, Facing::INWARD);
        else
            add_blob(scene.build, int(run.count(5, 6, 6)));
        PathProbe probe(run.device, scene);
        leave_light_to_paths(probe.params);
        const std::vector<TestRay> rays = rays_from_inside(probe, run.count(2000, 1e6, 1e7), 3);
        for (const Build build : path_builds(run)) {
            const std::vector<dvec3> got = probe.radiance(build, Integrator::PATH, rays);
            for (size_t i = 0; i < got.size(); ++i)
                leaks[build].count(std::abs(got[i].x - 1) > 8 * FLOAT_U,
                                   [&] { return fmt::format("{}, ray {}: {}", names[shape], i, got[i].x); });
        }
    }
}

void facing_mirrors(CaseRun& run) {
    constexpr double STEP = 0.01, LENGTH = 1000 * STEP;
    Figure& error = run.figure("relative error of 0.999^1000", 1000 * 2 * FLOAT_U);
    ScratchScene scene;
    scene.build.material("mirror", "Kd 0 0 0\nKs 0.999 0.999 0.999\nillum 3").use("mirror");
    scene.build.polygon({{0, -1, 0}, {LENGTH, -1, 0}, {LENGTH, 1, 0}, {0, 1, 0}});
    scene.build.polygon({{0, 1, 1}, {LENGTH, 1, 1}, {LENGTH, -1, 1}, {0, -1, 1}});
    scene.options.light.environment = dvec3(1);
    scene.options.transport.max_depth = 1100;
    scene.options.transport.roulette_depth = NO_ROULETTE;
    const PathProbe probe(run.device, scene);
    // From the gap's middle: hits half a step in from the mirrors' ends, a thousand of them.
    const std::vector<TestRay> rays = {probe.ray({0, 0, 0.5}, {STEP / 2, 0, 1}),
                                       probe.ray({0, 0.3, 0.5}, {STEP / 2, 0.3, 0})};
    for (const Build build : path_builds(run))
        for (const dvec3& value : probe.radiance(build, Integrator::PATH, rays))
            error[build].see(std::abs(value.x / 0.3676954 - 1),
                             [&] { return fmt::format("radiance {}", value.x); });
}

void roulette(CaseRun& run) {
    // Survival is 0.99 at each of a hundred vertices: a division that is left out at one in twenty of them is
    // seen.
    MeanFigure mean(run, "the mean", 8e-3);
    Figure& largest = run.figure("largest sample over the mean", 25);
    Furnace scene(0.99, 0.01, 20000);
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    scene.options.transport.roulette_depth = 1;
    PathProbe probe(run.device, scene);
    leave_light_to_paths(probe.params);
    const std::vector<TestRay> rays = rays_from_inside(probe, 16, 4);
    for (const Build build : path_builds(run)) {
        const std::vector<double> got =
            reds(probe.radiance(build, Integrator::PATH, rays, run.count(1200, 1e5, 1e6)));
        const Moments moments = moments_of(got);
        mean.see(build, got, 1);
        for (const double value : got)
            largest[build].see(value / moments.mean, [&] { return fmt::format("{}", value); });
    }
}

/// Radiance of a floor below a point light of intensity R^2 at height R, and of a ball of radius R around
/// one.
double lit(const CaseRun& run, Build build, double size, bool is_ball) {
    ScratchScene scene;
    scene.build.material("wall", "Kd 0.5 0.5 0.5").use("wall");
    scene.options.transport.roulette_depth = NO_ROULETTE;
    scene.options.transport.max_depth = is_ball ? 32 : 2;
    if (is_ball)
        scene.build.icosphere({0, 0, 0}, size, 3, Facing::INWARD);
    else
        scene.build.floor(2 * size, -size);
    scene.options.light.points.push_back({{0, 0, 0}, dvec3(size * size)});
    const PathProbe probe(run.device, scene);
    const std::vector<TestRay> rays = {probe.ray({0.1 * size, -0.5 * size, 0.05 * size}, {0, -size, 0})};
    return moments_of(reds(probe.radiance(build, Integrator::PATH, rays, is_ball ? 256 : 1))).mean;
}

void inverse_square(CaseRun& run) {
    Figure& plane = run.figure("relative error under a lamp", 2e-6);
    Figure& alike = run.figure("relative difference of balls from R = 1", 2e-4);
    Figure& ball = run.figure("relative error in a ball of 1280 triangles", 8e-3);
    for (const Build build : path_builds(run)) {
        const double unit = lit(run, build, 1, true);
        ball[build].see(std::abs(unit * PI - 1), [] { return "R = 1"; }); // I kd / (pi R^2 (1 - kd))
        for (const double size : {1e-3, 3e-2, 7.0, 1e3}) {
            const auto describe = [&] { return fmt::format("R = {}", size); };
            plane[build].see(std::abs(lit(run, build, size, false) * 2 * PI - 1), describe);
            alike[build].see(std::abs(lit(run, build, size, true) / unit - 1), describe);
        }
    }
}

} // namespace

const std::vector<StabilityCase>& furnace_cases() {
    static const std::vector<StabilityCase> cases = {
        {"F01", "BsdfSampling",
         "a ball that glows with 1/2 and reflects 1/2, paths of N segments without light sampling",
         "1 - 2^-N for every path", "weights are the reflectance itself: nothing varies, nothing is rounded",
         by_bsdf_sampling},
        {"F02", "LightSampling", "the same with light sampling and multiple importance sampling", "1",
         "noise: corners of flat triangles see each other unevenly", by_light_sampling},
        {"F04", "Shapes", "a cube, a ball, a blob of 2e4 triangles that glow", "1 for every path",
         "a law: a path that loses light has left", shapes},
        {"F05", "EveryBsdf", "every BSDF under a white sky, a lattice of random numbers",
         "colours of lossless lobes, albedo of rough ones by quadrature in double",
         "eight roundings; the lattice's error for rough lobes, where a random number chooses the lobe: a "
         "jump; the error of the tables of albedos",
         bsdf_furnace},
        {"F06", "FacingMirrors", "two mirrors of 0.999, a thousand reflections", "0.999^1000",
         "two roundings a reflection", facing_mirrors},
        {"F07", "Roulette", "walls that reflect 0.99, roulette from the first vertex", "1",
         "noise; lengths have a geometric distribution of mean 100", roulette},
        {"F09", "InverseSquare", "a point light of intensity R^2 at distance R, R from 1e-3 to 1e3",
         "I kd / (pi R^2), in a ball over 1 - kd",
         "a dozen roundings under a lamp; in balls a path whose hit falls to the neighbouring facet changes; "
         "facets are nearer "
         "than their ball",
         inverse_square},
        {"F10", "ColouredLobes", "a matte lobe and a mirror of each mixture of pure red, green, blue",
         "a sample's weight is at most the sum of both sizes",
         "lobes are chosen by the sizes of their colours; a choice by luminance exceeds it up to fivefold",
         coloured_lobes},
    };
    return cases;
}

} // namespace clrt
