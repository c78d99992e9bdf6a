// SPDX-License-Identifier: Apache-2.0
// Dielectric bodies in scenes: slabs, balls, light that cannot get out.
#include "stability/cases/shading_expressions.h"
#include "stability/mean_figure.h"
#include "stability/path_probe.h"

#include "probes/meshes.h"
#include "probes/random_inputs.h"
#include "probes/reference.h"

#include <fmt/format.h>

namespace clrt {

namespace {

using glm::dvec3;

constexpr int NO_ROULETTE = 65535;
const Integrator TREE_AND_PATH[] = {Integrator::WHITTED, Integrator::PATH};

/// A white sky, deep paths.
struct SkyScene : ScratchScene {
    explicit SkyScene(int max_depth) {
        options.light.environment = dvec3(1);
        options.transport.max_depth = max_depth;
        options.transport.roulette_depth = NO_ROULETTE;
        options.transport.min_contribution = 0;
    }
};

/// A sky that grows from below to above and turns with the azimuth; nothing in it is dark.
struct GradientScene : SkyScene {
    explicit GradientScene(bool with_ball) : SkyScene(8) {
        options.light.environment.reset();
        std::vector<float> texels;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 32; ++x)
                texels.insert(texels.end(),
                              {1 + 0.05f * float(y), 1 + 0.02f * float(x < 16 ? x : 31 - x), 1});
        texture("gradient.exr", 32, 16, 3, texels);
        options.light.environment_file = folder.file("gradient.exr");
        // Both scenes have one frame: the corners of their boxes are these.
        build.material("air", "Ni 1\nillum 7").material("black", "Kd 0 0 0").use("black");
        options.scene.mtl = MtlReading::PLAIN; // air is glass that bends nothing
        build.box({6, 6, 6}, {6.1, 6.1, 6.1}).box({-6.1, -6.1, -6.1}, {-6, -6, -6});
        if (with_ball)
            build.use("air").icosphere({0, 0, 0}, 1, 2);
    }
};

/// Rays from around the origin's neighbourhood towards it.
std::vector<TestRay> rays_to_origin(const PathProbe& probe, size_t count, double spread) {
    Random random(3);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 from = 4.0 * random.direction(), at = random.in_cube(spread);
        rays.push_back(probe.ray(from, at));
    }
    return rays;
}

/// Rays from above straight through a slab of size 1.
void meet_both_faces(CaseRun& run, double place, double thickness, Figure& lost) {
    ScratchScene scene;
    scene.build.material("glass", "Ni 1.5\nillum 7").use("glass");
    scene.build.box({place - 0.5, place - 0.5, place}, {place + 0.5, place + 0.5, place + thickness});
    const Scene loaded = scene.load();
    const RayDevice slab(run.device, loaded, BvhLayout::BVH8);
    Random random(4);
    std::vector<TestRay> rays;
    const size_t count = run.count(1e5, 1e6, 4e6);
    const double half = 0.5 * loaded.normalisation.scale;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 target(random.between(-0.99, 0.99) * half, random.between(-0.99, 0.99) * half, 0);
        rays.push_back(
            make_ray_to(target + 0.01 * half * random.upper_direction() + dvec3(0, 0, 2e-3 * half), target));
    }
    const auto through = [](const std::vector<TestRay>& from) {
        std::vector<dvec3> directions;
        for (const TestRay& ray : from)
            directions.push_back(to_dvec3(ray.direction));
        return directions;
    };
    const std::vector<TestHit> first = slab.closest(rays);
    const std::vector<TestRay> inside = slab.leaving(rays, first, through(rays));
    const std::vector<TestHit> other = slab.closest(inside);
    std::vector<TestRay> met;
    std::vector<TestHit> met_hits;
    for (size_t i = 0; i < count; ++i) {
        const bool ok = other[i].triangle != NO_INDEX && other[i].triangle / 2 != first[i].triangle / 2;
        lost[Build::SINGLE].count(!ok, [&] { return fmt::format("ray {}: no second face", i); });
        if (ok) {
            met.push_back(inside[i]);
            met_hits.push_back(other[i]);
        }
    }
    const std::vector<TestHit> again = slab.closest(slab.leaving(met, met_hits, through(met)));
    for (size_t i = 0; i < again.size(); ++i)
        lost[Build::SINGLE].count(again[i].triangle != NO_INDEX,
                                  [&] { return fmt::format("ray {}: a third hit", i); });
}

} // namespace

void index_one_ball(CaseRun& run) {
    Figure& picture = run.figure("relative difference of radiance", 4 * 2 * FLOAT_U);
    Figure& reflectance = run.figure("angles with F above 0", 0);
    const PathProbe without(run.device, GradientScene(false)), with(run.device, GradientScene(true));
    const size_t count = run.count(2000, 1e5, 1e6);
    for (const Build build : path_builds(run))
        for (const Integrator integrator : TREE_AND_PATH) {
            const std::vector<dvec3> a = without.radiance(build, integrator,
                                                          rays_to_origin(without, count, 0.5)),
                                     b = with.radiance(build, integrator, rays_to_origin(with, count, 0.5));
            for (size_t i = 0; i < count; ++i)
                picture[build].see(glm::length(a[i] - b[i]) / glm::length(a[i]),
                                   [&] { return fmt::format("ray {}", i); });
        }
    std::vector<float> cosines;
    for (int i = 0; i <= 4096; ++i)
        cosines.push_back(float(i) / 4096);
    ProbeSet probes(run.device, {"scattering/fresnel.h"}, {fresnel_expression()});
    for (const Build build : run.builds()) {
        const std::vector<double> f =
            probes.run(build, "fresnel", {cosines, std::vector<float>(cosines.size(), 1)})[0];
        for (size_t i = 0; i < f.size(); ++i)
            reflectance[build].count(f[i] != 0,
                                     [&] { return fmt::format("cos {:a}: F {}", cosines[i], f[i]); });
    }
}

void glass_slab(CaseRun& run) {
    Figure& tree = run.figure("|radiance - (1 - R) / (1 + R)|, tree of rays", 2e-6);
    // A slab reflects 0.04 twice: six standard errors are a third of what one surface reflects.
    MeanFigure paths(run, "paths", 2e-3);
    ScratchScene scene;
    scene.build.material("glass", "Ni 1.5\nillum 7").material("lamp", "Kd 0 0 0\nKe 1 1 1");
    scene.build.use("glass").box({-60, -60, -0.5}, {60, 60, 0.5});
    scene.build.use("lamp").polygon({{-50, -50, -2}, {50, -50, -2}, {50, 50, -2}, {-50, 50, -2}});
    scene.options.transport.max_depth = 30;
    scene.options.transport.roulette_depth = NO_ROULETTE;
    scene.options.transport.min_contribution = 0;
    const PathProbe probe(run.device, scene);
    const double expected = (1 - 0.04) / (1 + 0.04);
    const std::vector<TestRay> rays = {probe.ray({0.3, 0.2, 5}, {0.3, 0.2, 0})};
    for (const Build build : path_builds(run)) {
        tree[build].see(std::abs(probe.radiance(build, Integrator::WHITTED, rays)[0].x - expected),
                        [] { return "head-on"; });
        std::vector<double> values;
        for (const dvec3& value : probe.radiance(build, Integrator::PATH, rays, run.count(3e4, 1e6, 1e7)))
            values.push_back(value.x);
        paths.see(build, values, expected);
    }
}

void slab_shift(CaseRun& run) {
    constexpr double THICKNESS = 0.2, SIZE = 2;
    const double offset = FLOAT_U * (4 * SIZE / 2 + 24 * SIZE); // surface_offset_bound
    Figure& shift = run.figure("|shift - closed form|", 8 * FLOAT_U * SIZE + 2 * offset);
    const RayDevice slab(
        run.device, make_room({-SIZE / 2, -SIZE / 2, -THICKNESS / 2}, {SIZE / 2, SIZE / 2, THICKNESS / 2}),
        BvhLayout::BVH8);
    std::vector<TestRay> rays, at;
    std::vector<dvec3> inside, outside;
    for (double degrees = 10; degrees <= 80; degrees += 0.5) {
        const double a = degrees * PI / 180, b = std::asin(std::sin(a) / 1.5);
        rays.push_back(
            make_ray({-std::sin(a), 0.01, THICKNESS / 2 + std::cos(a)}, {std::sin(a), 0, -std::cos(a)}));
        inside.push_back({std::sin(b), 0, -std::cos(b)});
        outside.push_back(to_dvec3(rays.back().direction));
    }
    const std::vector<TestRay> second = slab.leaving(rays, slab.closest(rays), inside);
    const std::vector<TestRay> third = slab.leaving(second, slab.closest(second), outside);
    for (size_t i = 0; i < rays.size(); ++i) {
        const dvec3 d = glm::normalize(to_dvec3(rays[i].direction)),
                    way = to_dvec3(third[i].origin) - to_dvec3(rays[i].origin);
        const double a = std::acos(-d.z), b = std::asin(std::sin(a) / 1.5);
        const double expected = THICKNESS * std::sin(a - b) / std::cos(b);
        shift[Build::SINGLE].see(std::abs(glm::length(way - glm::dot(way, d) * d) - expected),
                                 [&] { return fmt::format("{} degrees", a * 180 / PI); });
    }
}

void thin_slab(CaseRun& run) {
    Figure& lost = run.figure("rays that do not meet both faces once", 0);
    meet_both_faces(run, 0, 1e-5, lost);
    // Coordinates of an OBJ are floats: 1000 away they are 6.1e-5 apart.
    meet_both_faces(run, 1000, 4 * std::ldexp(1.0, -14), lost);
}

void start_inside(CaseRun& run) {
    Figure& refracted = run.figure("|radiance of the sky - (1 - F) eta^2|", 4e-6);
    Figure& reflected = run.figure("|radiance of the ground - F|", 2e-6);
    SkyScene scene(8);
    scene.options.light.environment = dvec3(1, 0, 0);
    scene.build.material("glass", "Ni 1.5\nillum 7").material("lamp", "Kd 0 0 0\nKe 0 1 0");
    scene.build.use("glass").floor(20).use("lamp").floor(20, -3);
    const PathProbe probe(run.device, scene);
    std::vector<TestRay> rays;
    for (double degrees = 1; degrees < 79; degrees += 0.5)
        if (std::abs(degrees - 41.81) > 0.4) {
            const double a = degrees * PI / 180;
            rays.push_back(probe.ray({0.1, -1, 0.2}, {0.1 + std::tan(a), 0, 0.2}));
        }
    for (const Build build : path_builds(run)) {
        const std::vector<dvec3> got = probe.radiance(build, Integrator::WHITTED, rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            const double f =
                reference::fresnel_dielectric(glm::normalize(to_dvec3(rays[i].direction)).y, 1.5);
            const auto describe = [&] { return fmt::format("cos {:a}", rays[i].direction.y); };
            refracted[build].see(std::abs(got[i].x - (1 - f) * 2.25), describe);
            reflected[build].see(std::abs(got[i].y - f), describe);
        }
    }
}

void trapped_light(CaseRun& run) {
    constexpr int SEGMENTS = 1000;
    Figure& loss = run.figure("|radiance / 1000 glows - 1|", SEGMENTS * 2 * FLOAT_U);
    SkyScene scene(SEGMENTS);
    // Seen from inside, glass of this index around air is air around glass.
    scene.build.material("glass", "Ni 0.66666667\nillum 7\nKe 0.001 0.001 0.001")
        .use("glass")
        .box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    PathProbe probe(run.device, scene);
    Random random(5);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < run.count(64, 4096, 65536); ++i) {
        const dvec3 from = random.in_cube(0.9);
        rays.push_back(probe.ray(from, from + dvec3(1, 1, 1) + random.in_cube(0.1)));
    }
    for (const Build build : path_builds(run)) {
        const std::vector<dvec3> got = probe.radiance(build, Integrator::PATH, rays);
        for (size_t i = 0; i < rays.size(); ++i)
            loss[build].see(std::abs(got[i].x / (SEGMENTS * double(0.001f)) - 1),
                            [&] { return fmt::format("ray {}", i); });
    }
}

void glass_ball(CaseRun& run) {
    constexpr int SEGMENTS = 200;
    Figure& error = run.figure("|radiance - 1| of paths that get out", 8 * 2 * FLOAT_U);
    Figure& lost = run.figure("share of paths that do not", 1e-3);
    SkyScene scene(SEGMENTS);
    scene.build.material("diamond", "Ni 2.417\nillum 7").use("diamond").icosphere({0, 0, 0}, 1, 3);
    const PathProbe probe(run.device, scene);
    const std::vector<TestRay> rays = rays_to_origin(probe, run.count(5e3, 1e5, 1e6), 0.5);
    for (const Build build : path_builds(run)) {
        double inside = 0;
        const std::vector<dvec3> got = probe.radiance(build, Integrator::PATH, rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            inside += got[i].x == 0;
            if (got[i].x != 0)
                error[build].see(std::abs(got[i].x - 1), [&] { return fmt::format("ray {}", i); });
        }
        lost[build].see(inside / double(rays.size()),
                        [&] { return fmt::format("{} of {}", inside, rays.size()); });
    }
}

} // namespace clrt
