// SPDX-License-Identifier: Apache-2.0
// Leaving surfaces: shadow rays to lights, closed rooms, the terminator of smooth meshes.
#include "naive/naive_kernels.h"
#include "probes/leaving_rays.h"
#include "probes/scratch_scene.h"
#include "stability/cases/offsets_cases.h"
#include "stability/cases/ray_builds.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

void count_escapes(const CaseRun& run, const Scene& room, size_t paths, const std::string& name,
                   Figure& escapes) {
    constexpr int BOUNCES = 5;
    for (const Build build : run.builds())
        for_each_tree(build, plain_offsets(run.device),
                      [&](const RayDeviceOptions& options, const std::string& tree) {
                          if (options.quality != BvhQuality::FAST)
                              return;
                          const RayDevice device(run.device, room, options);
                          Random random(4);
                          std::vector<TestRay> rays = rays_in_room(room, paths, random);
                          for (int bounce = 0;; ++bounce) {
                              const std::vector<TestHit> hits = device.closest(rays);
                              Arrivals from;
                              for (size_t i = 0; i < rays.size(); ++i) {
                                  const bool out = hits[i].triangle == NO_INDEX;
                                  escapes[build].count(out, [&] {
                                      return fmt::format("{}, {}: {}", name, tree, ray_text(rays[i]));
                                  });
                                  if (!out) {
                                      from.rays.push_back(rays[i]);
                                      from.hits.push_back(hits[i]);
                                  }
                              }
                              if (bounce == BOUNCES)
                                  break;
                              rays = leave_at_random(room, device, from, random);
                          }
                      });
}

namespace {

/// A tetrahedron with two walls that meet at an angle, away from all axes.
Scene make_wedge(double degrees) {
    const double half = std::tan(0.5 * degrees * PI / 180);
    return make_tetrahedron({-1, 0, 0.1}, {1, 0.1, 0}, {0.1, 1, half + 0.05}, {0, 1, 0.05 - half});
}

} // namespace

void light_tight_rooms(CaseRun& run) {
    Scene turned = make_room({-1, -0.6, -1.1}, {0.7, 0.8, 0.9});
    const glm::dvec3 x = glm::normalize(glm::dvec3(1, 0.3, -0.2)),
                     z = glm::normalize(glm::cross(x, {0.1, 1, 0.4}));
    for (vec4& p : turned.positions)
        p = to_vec4(double(p.x) * x + double(p.y) * glm::cross(z, x) + double(p.z) * z);
    const size_t paths = run.count(1e4, 1e5, 2e6);
    Figure& escapes = run.figure("rays that get out, walls at 30 to 90 degrees", 0);
    count_escapes(run, make_room({-1, -1, -1}, {1, 1, 1}), paths, "upright", escapes);
    count_escapes(run, turned, paths, "turned", escapes);
    count_escapes(run, make_tetrahedron({1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}), paths,
                  "70 degrees", escapes);
    count_escapes(run, make_wedge(30), paths, "30 degrees", escapes);
    Figure counted;
    for (const double degrees : {20.0, 10.0, 5.0})
        count_escapes(run, make_wedge(degrees), paths, fmt::format("{} degrees", degrees), counted);
    Figure& sharp = run.figure("share of them, walls at 5 to 20 degrees", 0.05);
    for (const Build build : run.builds())
        sharp[build].see(counted[build].value / double(counted[build].tried),
                         [&] { return counted[build].input; });
}

void shadow_ray_ends(CaseRun& run) {
    Figure& hidden = run.figure("samples in which the light hides itself", 0);
    Figure& seen = run.figure("samples that see it through the blocker", 0);
    for (const bool blocked : {false, true}) {
        ScratchScene text;
        text.build.material("matte", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 1 1 1");
        const glm::dvec3 a(-0.5, 1, 0.6), b(0.7, 1.3, 0.4), c(0.1, 1.2, -0.7),
            n = glm::normalize(glm::cross(b - a, c - a));
        text.build.use("lamp").polygon({a, c, b}); // its front is below
        const glm::dvec3 middle = (a + b + c) / 3.0,
                         down = n * (glm::dot(n, glm::dvec3(0, 1, 0)) > 0 ? -1.0 : 1.0);
        const double bound = FLOAT_U * (4 * 1.3 + 24 * 1.3);
        text.build.use("matte").floor(3);
        if (blocked) {
            std::vector<glm::dvec3> blocker;
            for (const glm::dvec3& corner : {a, b, c})
                blocker.push_back(middle + (corner - middle) * 1.01 + down * (8 * bound));
            text.build.polygon(blocker);
        }
        const Scene scene = text.load();
        u32 floor = 0;
        while (scene.triangles[floor].emitter != NO_INDEX)
            ++floor;
        Random random(6);
        std::vector<TestRay> rays;
        std::vector<TestHit> hits;
        std::vector<vec4> numbers;
        for (size_t i = 0; i < run.count(5e4, 1e6, 1e7); ++i) {
            rays.push_back(make_ray({0, 1, 0}, {0, -1, 0}));
            const double b1 = random.unit();
            hits.push_back({1, b1, (1 - b1) * random.unit(), floor + random.word() % 2});
            // Corners and edges of the light, too.
            const double u = i % 8 == 1 ? 0.0 : random.unit(), v = i % 8 == 2 ? 0.0 : random.unit();
            numbers.push_back(to_vec4({u, v, 0}));
        }
        for (const Build build : run.builds()) {
            const std::vector<u32> light =
                RayDevice(run.device, scene, ray_options(build, plain_offsets(run.device)))
                    .lights_seen(rays, hits, numbers);
            for (size_t i = 0; i < light.size(); ++i) {
                const auto describe = [&] { return fmt::format("weights {}, {}", hits[i].b1, hits[i].b2); };
                if (!blocked)
                    hidden[build].count(light[i] != LIGHT_SEEN, describe);
                else
                    seen[build].count(light[i] != LIGHT_HIDDEN, describe);
            }
        }
    }
}

namespace {

/// A smooth white ball under a sun, against max(0, cos): pixels that are black where the cosine is above
/// 0.05, and the root of the mean squared difference.
struct BallUnderTheSun {
    int pixels = 0, black = 0;
    double rms = 0;
};

BallUnderTheSun ball_under_the_sun(const CaseRun& run, int subdivisions, Integrator integrator,
                                   const std::string& kernels) {
    const double distance = 8, half_angle = 8.0;
    const glm::dvec3 sun = glm::normalize(glm::dvec3(1, 0.4, -0.2));
    ScratchScene scene;
    scene.build.material("m", "Kd 1 1 1")
        .use("m")
        .icosphere({0, 0, 0}, 1, subdivisions, Facing::OUTWARD, Shading::SMOOTH);
    scene.options.light.suns = {{sun, glm::dvec3(PI), 0}};
    scene.options.film.size = {64, 64};
    scene.options.sampling.spp = 64;
    scene.options.transport.max_depth = 2;
    scene.options.transport.integrator = integrator;
    scene.options.device.kernels_folder = kernels;
    scene.look({0, 0, distance}, {0, 0, 0}, 2 * half_angle);
    const std::vector<float> picture = film_mean(scene.render(run.device).film);
    BallUnderTheSun result;
    double squares = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            // The ray through the pixel's centre, and where it meets the sphere.
            const double pixel = 2 * std::tan(half_angle * PI / 180) / 64;
            const glm::dvec3 eye(0, 0, distance),
                d = glm::normalize(glm::dvec3((x + 0.5 - 32) * pixel, (31.5 - y) * pixel, -1));
            const double b = glm::dot(eye, d), under = b * b - distance * distance + 1;
            if (under < 0.1)
                continue; // outside, or near the outline, which has corners
            const double cosine = glm::dot(eye + d * (-b - std::sqrt(under)), sun);
            const double found = picture[size_t(3 * (64 * y + x))];
            squares += std::pow(found - std::max(cosine, 0.0), 2);
            ++result.pixels;
            result.black += cosine > 0.05 && found == 0;
        }
    result.rms = std::sqrt(squares / result.pixels);
    return result;
}

} // namespace

void shadow_terminator(CaseRun& run) {
    ScratchFolder folder;
    KernelFiles flat = run.device.kernels();
    replace_in_kernel(flat, "geometry/surface.h", "if (nearest >= SURFACE_FLAT_COS)", "if (true)");
    write_kernel_files(flat, folder.file("flat"));
    Figure& black = run.figure("black pixels with cos > 0.05", 0);
    const double limits[] = {0.05, 0.02, 0.01};
    for (int subdivisions = 1; subdivisions <= 3; ++subdivisions) {
        Figure& rms = run.figure(fmt::format("RMS error, {} triangles", 20 << 2 * subdivisions),
                                 limits[subdivisions - 1]);
        for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED})
            for (const Build build : {Build::NAIVE, Build::SINGLE}) {
                if (build == Build::NAIVE && integrator != Integrator::WHITTED)
                    continue; // the same geometry
                const BallUnderTheSun ball = ball_under_the_sun(
                    run, subdivisions, integrator, build == Build::NAIVE ? folder.file("flat") : "");
                const auto describe = [&] { return integrator == Integrator::PATH ? "path" : "whitted"; };
                for (int i = 0; i < ball.pixels; ++i)
                    black[build].count(i < ball.black, describe);
                rms[build].see(ball.rms, describe);
            }
    }
}

} // namespace clrt
