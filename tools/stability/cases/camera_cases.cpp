// SPDX-License-Identifier: Apache-2.0
// Cameras: the narrowest and the widest angle of view, an up vector along the view; lens and shutter
// (lens_cases.h).
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "render/render_params.h"
#include "scene/camera_fit.h"
#include "stability/cases/lens_cases.h"
#include "stability/cases/ray_builds.h"
#include "stability/catalogue.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <set>

namespace clrt {

namespace {

const char* const CAMERA_RAYS = R"(
kernel void camera_rays(const RenderParams params, const u32 count, global real* restrict out)
{
    const u32 i = (u32)get_global_id(0);
    if (i >= count)
        return;
    const Sampler sampler = sampler_make(0u, i, 0u, 0u);
    const Ray ray = camera_ray(&params, &sampler, i % params.width, i / params.width);
    out[3 * i] = ray.direction.x;
    out[3 * i + 1] = ray.direction.y;
    out[3 * i + 2] = ray.direction.z;
}
)";

template <class Number>
std::vector<glm::dvec3> directions(const CaseRun& run, Precision precision, const RenderParams& params) {
    KernelProbe probe(run.device, {"camera/camera.h"}, {precision, {}});
    probe.add_text(CAMERA_RAYS);
    const size_t count = size_t(params.width) * params.height;
    const cl::Buffer out = create_buffer(run.device, "out", 3 * count * sizeof(Number));
    Kernel kernel = probe.kernel("camera_rays");
    kernel.set("params", params);
    kernel.set("count", u32(count));
    kernel.set("out", out);
    probe.launch(kernel, count);
    const std::vector<Number> numbers = probe.read<Number>(out, 3 * count);
    std::vector<glm::dvec3> result;
    for (size_t i = 0; i < count; ++i)
        result.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    return result;
}

void extreme_angles(CaseRun& run) {
    Figure& angle = run.figure("angle to the pixel's centre, rad", 1.5e-7);
    Figure& equal = run.figure("share of equal rays, pitch of 2.7e-7 rad", 0.01);
    const int side = int(run.count(64, 64, 64));
    for (const double fov : {1e-3, 179.9}) {
        Scene scene;
        scene.camera = {{1, 2, 3}, {1.3, 1.5, 2.2}, {0.1, 1, 0.2}, fov};
        Options options;
        options.film.size = {side, side};
        options.film.filter_radius = 0; // the box filter of this radius is the pixel's centre
        const RenderParams params = make_render_params(scene, options, FilmScale());
        const glm::dvec3 look = glm::normalize(scene.camera.at - scene.camera.eye);
        const glm::dvec3 right = glm::normalize(glm::cross(look, scene.camera.up)),
                         up = glm::cross(right, look);
        const double pixel = 2 * std::tan(fov * PI / 360) / side;
        for (const Build build : robust_builds(run)) {
            const std::vector<glm::dvec3> found =
                build == Build::DOUBLE
                    ? directions<double>(run, Precision::DOUBLE, params)
                    : directions<float>(run, build == Build::FAST ? Precision::FAST : Precision::SINGLE,
                                        params);
            std::set<std::array<double, 3>> distinct;
            for (size_t i = 0; i < found.size(); ++i) {
                const double x = double(i % size_t(side)) + 0.5 - 0.5 * side,
                             y = 0.5 * side - double(i / size_t(side)) - 0.5;
                const glm::dvec3 d = glm::normalize(look + right * (x * pixel) + up * (y * pixel));
                angle[build].see(std::atan2(glm::length(glm::cross(d, found[i])), glm::dot(d, found[i])),
                                 [&] { return fmt::format("{} degrees, pixel {}", fov, i); });
                distinct.insert({found[i].x, found[i].y, found[i].z});
            }
            equal[build].see(1 - double(distinct.size()) / double(found.size()),
                             [&] { return fmt::format("{} degrees", fov); });
        }
    }
}

void look_along_up(CaseRun& run) {
    Figure& orthonormal = run.figure("departure from orthonormal film vectors", 4 * FLOAT_U);
    for (const double sine : {0.0, 1e-7, 1e-6, 1e-5})
        for (const glm::dvec3& up :
             {glm::dvec3(0, 1, 0), {0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {0.3, -0.5, 0.8}}) {
            const glm::dvec3 n = glm::normalize(up),
                             aside = glm::normalize(glm::cross(n, glm::dvec3(0.4, 0.3, 0.9)));
            Options options;
            options.film.size = {64, 64};
            options.camera.eye = glm::dvec3(1, 2, 3);
            options.camera.at = glm::dvec3(1, 2, 3) + n + aside * sine;
            options.camera.up = up;
            options.camera.fov_degrees = 90;
            NoticeList notices;
            Scene scene;
            scene.camera = fit_camera(options.camera, options.film.size, scene,
                                      {glm::dvec3(-1), glm::dvec3(1)}, notices);
            const RenderParams params = make_render_params(scene, options, FilmScale());
            const glm::dvec3 x = to_dvec3(params.camera.film_dx) * 32.0,
                             y = to_dvec3(params.camera.film_dy) * 32.0, z = to_dvec3(params.camera.look);
            for (const double departure :
                 {glm::dot(x, x) - 1, glm::dot(y, y) - 1, glm::dot(z, z) - 1, glm::dot(x, y), glm::dot(y, z),
                  glm::dot(z, x), glm::dot(glm::cross(x, y), z) - 1})
                orthonormal[Build::SINGLE].see(std::abs(departure), [&] {
                    return fmt::format("up {}, {}, {}, sine {}", up.x, up.y, up.z, sine);
                });
        }
}

} // namespace

const std::vector<StabilityCase>& camera_cases() {
    static const std::vector<StabilityCase> cases = {
        {"K01", "ExtremeAngles",
         "angles of view of 1e-3 and 179.9 degrees, a camera away from all axes, pixel centres",
         "the pinhole in double", "a direction in float is good to 1e-7 rad", extreme_angles},
        {"K02", "LookAlongUp", "an up vector along the view, and 1e-7 to 1e-5 beside it",
         "orthonormal film vectors", "computed in double, rounded once: products of two have 4 u",
         look_along_up},
        {"K03", "LensRadiusZero", "a lens of radius 0, five blades, another focus", "the pinhole",
         "the same bits: nothing is added", lens_radius_zero},
        {"K04", "OddFocus",
         "focus at a thousandth, at 1, at 1e7 and at infinity; 0 is refused with a message",
         "the sharp point seen from the ray's origin, in double",
         "a direction in float is good to 1e-7 rad, the lens's point and the film position add theirs",
         odd_focus},
        {"K05", "BlurCircle", "a point at S2, focus at S1, aperture A", "A |S2 - S1| / S2 on the focus plane",
         "roundings of origin and direction, over the depth; the edge is reached by chance", blur_circle},
        {"K06", "ShutterZero", "a closed shutter at times 0 and 1; a closed ball that moves around a lamp",
         "the picture of the moment; black", "the same bits; corners stay shared at every time",
         shutter_zero},
    };
    return cases;
}

} // namespace clrt
