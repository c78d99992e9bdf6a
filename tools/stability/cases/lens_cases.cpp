// SPDX-License-Identifier: Apache-2.0
#include "stability/cases/lens_cases.h"

#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/scratch_scene.h"
#include "render/render_params.h"
#include "scene/camera_params.h"
#include "scene/vectors.h"
#include "stability/cases/ray_builds.h"
#include "stability/probe_set.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <limits>

namespace clrt {

namespace {

const char* const LENS_RAYS = R"(
kernel void lens_rays(const RenderParams params, const u32 count, global const float4* restrict samples,
                      global real* restrict out)
{
    const u32 i = (u32)get_global_id(0);
    if (i >= count)
        return;
    const float4 s = samples[i];
    const Ray ray = camera_generate(&params.camera, (real2)(s.x, s.y), (real2)(s.z, s.w), REAL(0.0));
    vstore3(ray.origin, 2 * i, out);
    vstore3(ray.direction, 2 * i + 1, out);
}
)";

constexpr glm::ivec2 SIZE(64, 64);
constexpr double APERTURE = 0.5;

struct LensRay {
    glm::dvec3 origin, direction;
};

/// A camera near the origin, away from all axes; `focus` in units of the frame.
Camera lens_camera(double aperture, double focus) {
    Camera camera;
    camera.eye = {0.25, -0.125, 0.5};
    camera.at = camera.eye + glm::dvec3(0.3, -0.5, -0.8);
    camera.up = {0.1, 1, 0.2};
    camera.aperture = aperture;
    camera.focus = focus;
    return camera;
}

RenderParams lens_params(const Camera& camera) {
    Options options;
    options.film.size = SIZE;
    Scene scene;
    scene.camera = camera;
    return make_render_params(scene, options, FilmScale());
}

/// Film positions and pairs of numbers for the lens.
std::vector<vec4> lens_samples(CaseRun& run) {
    Random random(1);
    std::vector<vec4> samples;
    for (size_t i = 0; i < run.count(4000, 40000, 400000); ++i) {
        const double x = random.between(-32, 32), y = random.between(-32, 32), u = random.unit();
        samples.push_back({float(x), float(y), float(u), float(random.unit())});
    }
    return samples;
}

template <class Number>
std::vector<LensRay> trace(const CaseRun& run, Precision precision, const RenderParams& params,
                           const std::vector<vec4>& samples) {
    KernelProbe probe(run.device, {"camera/camera.h"}, {precision, {}});
    probe.add_text(LENS_RAYS);
    const cl::Buffer in = upload_buffer(run.device, "samples", samples);
    const cl::Buffer out = create_buffer(run.device, "out", 6 * samples.size() * sizeof(Number));
    Kernel kernel = probe.kernel("lens_rays");
    kernel.set("params", params);
    kernel.set("count", u32(samples.size()));
    kernel.set("samples", in);
    kernel.set("out", out);
    probe.launch(kernel, samples.size());
    const std::vector<Number> n = probe.read<Number>(out, 6 * samples.size());
    std::vector<LensRay> rays;
    for (size_t i = 0; i < n.size(); i += 6)
        rays.push_back({{n[i], n[i + 1], n[i + 2]}, {n[i + 3], n[i + 4], n[i + 5]}});
    return rays;
}

std::vector<LensRay> trace(const CaseRun& run, Build build, const RenderParams& params,
                           const std::vector<vec4>& samples) {
    return build == Build::DOUBLE ? trace<double>(run, Precision::DOUBLE, params, samples)
                                  : trace<float>(run, precision_of(build), params, samples);
}

/// Where a ray is at a depth.
glm::dvec3 point_at(const LensRay& ray, const CameraParams& camera, double depth) {
    return ray.origin + ray.direction * (depth / glm::dot(ray.direction, to_dvec3(camera.look)));
}

LensRay middle_ray(const CameraParams& camera, const vec4& sample) {
    const FilmRay ray = film_ray(camera, {sample.x, sample.y});
    return {ray.origin, glm::normalize(ray.direction)};
}

void compare_sums(Worst& figure, const Film& a, const Film& b, const std::string& what) {
    size_t differing = 0;
    for (size_t i = 0; i < a.sums.size(); ++i)
        differing += a.sums[i] != b.sums[i];
    figure.see(double(differing), [&] { return what; });
}

/// A lamp within a closed ball that moves and grows.
void add_ball(SceneBuilder& build, double time) {
    build.material("grey", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 9 9 9");
    build.use("grey").icosphere({0.6 * time - 0.3, 0.2 * time, 0.1}, 1 + 0.37 * time, 3);
    build.use("lamp").box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
}

} // namespace

void lens_radius_zero(CaseRun& run) {
    Figure& differing = run.figure("rays that differ from the pinhole's", 0);
    const std::vector<vec4> samples = lens_samples(run);
    Camera lens = lens_camera(0, 3);
    lens.blades = 5;
    const RenderParams with = lens_params(lens), without = lens_params(lens_camera(0, 1));
    for (const Build build : robust_builds(run)) {
        const std::vector<LensRay> a = trace(run, build, with, samples),
                                   b = trace(run, build, without, samples);
        for (size_t i = 0; i < samples.size(); ++i)
            differing[build].count(a[i].origin != b[i].origin || a[i].direction != b[i].direction,
                                   [&] { return fmt::format("sample {}", i); });
    }
}

void odd_focus(CaseRun& run) {
    Figure& miss = run.figure("distance from the sharp point, over 1 and the way there", 3e-7);
    const std::vector<vec4> samples = lens_samples(run);
    for (const double focus : {1e-3, 1., 1e7, std::numeric_limits<double>::infinity()}) {
        const RenderParams params = lens_params(lens_camera(APERTURE, focus));
        for (const Build build : robust_builds(run)) {
            const std::vector<LensRay> rays = trace(run, build, params, samples);
            for (size_t i = 0; i < samples.size(); ++i) {
                const LensRay middle = middle_ray(params.camera, samples[i]);
                const glm::dvec3 way = std::isinf(focus)
                                           ? middle.direction
                                           : point_at(middle, params.camera, focus) - rays[i].origin;
                const glm::dvec3 d = rays[i].direction;
                miss[build].see(glm::length(glm::cross(way, d)) / (1 + glm::length(way)),
                                [&] { return fmt::format("focus {}, sample {}", focus, i); });
            }
        }
    }
}

void blur_circle(CaseRun& run) {
    // On the plane at depth S1 in focus, a point at S2 is a disc of diameter A |S2 - S1| / S2; on its own
    // plane that is A |S2 - S1| / S1, and rays reach all of it.
    Figure& radius = run.figure("distance beyond the disc's radius, over the depth", 2e-6);
    Figure& filled = run.figure("share of the radius that no ray reaches", 0.01);
    const std::vector<vec4> samples = lens_samples(run);
    constexpr double S1 = 2;
    for (const double s2 : {0.5, 1.9, 3., 40.}) {
        const RenderParams params = lens_params(lens_camera(APERTURE, S1));
        const double disc = APERTURE / 2 * std::abs(s2 - S1) / S1;
        for (const Build build : robust_builds(run)) {
            const std::vector<LensRay> rays = trace(run, build, params, samples);
            double most = 0;
            for (size_t i = 0; i < samples.size(); ++i) {
                const double off =
                    glm::distance(point_at(rays[i], params.camera, s2),
                                  point_at(middle_ray(params.camera, samples[i]), params.camera, s2));
                most = std::max(most, off);
                radius[build].see((off - disc) / s2, [&] { return fmt::format("S2 {}, sample {}", s2, i); });
            }
            filled[build].see(1 - most / disc, [&] { return fmt::format("S2 {}", s2); });
        }
    }
}

void shutter_zero(CaseRun& run) {
    Figure& differing = run.figure("sums that differ from the picture of the moment", 0);
    Figure& leaks = run.figure("sums with light from within a closed ball that moves", 0);
    for (const Build build : robust_builds(run)) {
        ScratchScene moving;
        add_ball(moving.build, 0);
        SceneBuilder end;
        add_ball(end, 1);
        moving.options.scene.end_path = moving.folder.write("end.obj", end.obj("scene.mtl"));
        moving.look({0, 0.4, 4}, {0, 0, 0}, 45);
        moving.options.film.size = {32, 32};
        moving.options.sampling.spp = u32(run.count(64, 256, 1024));
        moving.options.device.precision = precision_of(build);
        for (const double time : {0., 1.}) {
            moving.options.camera.shutter = glm::dvec2(time);
            ScratchScene still;
            add_ball(still.build, time);
            still.options = moving.options;
            still.options.scene.end_path.clear();
            still.options.camera.shutter.reset();
            still.options.light.environment = moving.options.light.environment = glm::dvec3(1);
            compare_sums(differing[build], moving.render(run.device).film, still.render(run.device).film,
                         fmt::format("time {}", time));
        }
        moving.options.light.environment = glm::dvec3(0);
        for (const glm::dvec2& times : {glm::dvec2(0, 1), glm::dvec2(0), glm::dvec2(1)}) {
            moving.options.camera.shutter = times;
            const Film film = moving.render(run.device).film;
            leaks[build].see(
                double(std::count_if(film.sums.begin(), film.sums.end(), [](auto sum) { return sum != 0; })),
                [&] { return fmt::format("shutter {},{}", times.x, times.y); });
        }
    }
}

} // namespace clrt
