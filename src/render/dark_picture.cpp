// SPDX-License-Identifier: Apache-2.0
#include "render/dark_picture.h"

#include "output/exposure.h"
#include "paths/path_plan.h"
#include "scene/camera_params.h"
#include "scene/enclosed_volume.h"
#include "scene/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>

namespace clrt {
namespace {

/// The darkest grey of 8 bits, on the straight part of the sRGB curve.
constexpr double DARKEST_GREY = 1 / 255. / 12.92;
/// Rays a side of the picture that ask the grid.
constexpr int PROBES = 32;
/// Emissive triangles whose faces are looked at.
constexpr size_t MOST_LAMPS = 256;
/// Share of rays that says "all", beside those which the coarse grid gets wrong.
constexpr double NEARLY_ALL = 0.95;
/// Grey in the middle of a picture that --exposure aims at.
constexpr double MIDDLE_GREY = 0.18;

std::string short_triple(const glm::dvec3& v) {
    return fmt::format("{:.6g},{:.6g},{:.6g}", v.x + 0., v.y + 0., v.z + 0.);
}

/// How light a picture is.
struct Lightness {
    double lit_share = 0; ///< of the pixels: with a channel that is not black in 8 bits
    double brightest = 0; ///< channel of any pixel, radiance
};

Lightness measure_lightness(const std::vector<float>& mean, double darkest_grey) {
    const size_t pixels = mean.size() / 3;
    Lightness lightness;
    for (size_t i = 0; i < pixels; ++i) {
        const double largest = double(std::max({mean[3 * i], mean[3 * i + 1], mean[3 * i + 2]}));
        lightness.lit_share += double(largest >= darkest_grey) / double(pixels);
        lightness.brightest = std::max(lightness.brightest, largest);
    }
    return lightness;
}

/// What rays through the picture find in the grid.
struct InView {
    double hits = 0, backs = 0; ///< shares
};

InView probe_view(const VoxelGrid& grid, const Scene& scene, const Options& options) {
    const CameraParams camera = make_camera_params(scene.camera, scene.normalisation, options.film.size);
    const Crop whole{0, 0, options.film.size.x, options.film.size.y},
        window = options.film.crop.value_or(whole);
    InView view;
    for (int y = 0; y < PROBES; ++y)
        for (int x = 0; x < PROBES; ++x) {
            const double px = window.x0 + (x + 0.5) * (window.x1 - window.x0) / PROBES,
                         py = window.y0 + (y + 0.5) * (window.y1 - window.y0) / PROBES;
            const FilmRay ray = film_ray(camera, glm::dvec2(px, py) - glm::dvec2(options.film.size) / 2.);
            const VoxelGrid::Hit hit = grid.cast(ray.origin, glm::normalize(ray.direction));
            view.hits += double(hit.is_hit) / (PROBES * PROBES);
            view.backs += double(hit.is_hit && hit.is_back) / (PROBES * PROBES);
        }
    return view;
}

/// The camera that looks past everything.
std::string explain_miss(const Scene& scene, const VoxelGrid& grid) {
    const Camera& camera = scene.camera;
    const Normalisation& frame = scene.normalisation;
    const glm::dvec3 centre = grid.box().centre() / frame.scale + frame.centre;
    const glm::dvec3 eye = to_normalised(frame, camera.eye);
    const bool is_inside =
        glm::all(glm::lessThan(grid.box().low, eye)) && glm::all(glm::lessThan(eye, grid.box().high));
    const bool is_behind = glm::dot(centre - camera.eye, camera.at - camera.eye) < 0;
    return fmt::format("the camera at {} looks at nothing: {}; --at {} looks at the scene's middle",
                       short_triple(camera.eye),
                       is_inside   ? "no surface of the scene lies before it"
                       : is_behind ? "the scene lies behind it"
                                   : "the scene lies beside its view",
                       short_triple(centre));
}

bool is_black(const Material& m) {
    const auto none = [](const vec4& v) { return v.x <= 0 && v.y <= 0 && v.z <= 0; };
    return none(m.matte) && none(m.specular) &&
           (m.lobes & (LOBES_GLASS | LOBE_COAT | LOBE_SHEEN | LOBE_MEASURED)) == 0 &&
           m.fresnel != FRESNEL_CONDUCTOR;
}

/// Whether every surface that does not emit reflects nothing.
bool reflects_nothing(const Scene& scene) {
    std::set<u32> used;
    for (const Triangle& t : scene.triangles)
        if (t.emitter == NO_INDEX)
            used.insert(t.material);
    return !used.empty() &&
           std::all_of(used.begin(), used.end(), [&](u32 m) { return is_black(scene.materials[m]); });
}

/// Whether what lies before the emissive faces is nothing, and what lies behind them is the scene.
bool lamps_look_away(const Scene& scene, const VoxelGrid& grid) {
    size_t asked = 0, away = 0;
    for (const Triangle& t : scene.triangles) {
        if (t.emitter == NO_INDEX || (scene.materials[t.material].flags & MATERIAL_EMITS_BOTH_SIDES) != 0)
            continue;
        if (asked == MOST_LAMPS)
            break;
        const auto position = [&](u32 v) {
            return glm::dvec3(scene.positions[v].x, scene.positions[v].y, scene.positions[v].z);
        };
        const glm::dvec3 a = position(t.v0), b = position(t.v1), c = position(t.v2);
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a)), centre = (a + b + c) / 3.;
        ++asked;
        away += !grid.cast(centre, normal).is_hit && grid.cast(centre, -normal).is_hit;
    }
    return asked > 0 && double(away) >= NEARLY_ALL * double(asked);
}

/// Whether the emissive faces are closed surfaces whose fronts are inside.
bool lamps_are_inside_out(const Scene& scene) {
    EnclosedVolume lamps;
    for (const Triangle& t : scene.triangles)
        if (t.emitter != NO_INDEX && (scene.materials[t.material].flags & MATERIAL_EMITS_BOTH_SIDES) == 0)
            lamps.add(corners_of(scene.positions, t));
    return lamps.is_inside_out();
}

bool has_light(const Scene& scene) {
    return !scene.emitters.empty() || !scene.lights.empty() || scene.environment.mean_radiance > 0;
}

/// Why no light comes from surfaces that are in view.
std::string explain_darkness(const Scene& scene, const Options& options, const std::optional<VoxelGrid>& grid,
                             const InView& view, double brightest) {
    if (!has_light(scene))
        return "the scene has no light: --env 1,1,1 or --sun gives it some";
    if (effective_max_depth(options.transport) < 2)
        return "--max-depth 1 shows emitters alone, and none is in view: 2 adds direct light";
    if (reflects_nothing(scene))
        return "there is light, but every surface is black (Kd and Ks are 0)";
    if (grid && lamps_look_away(scene, *grid))
        return "all emissive faces shine away from the scene: --two-sided-lights lets their backs shine as "
               "well";
    if (lamps_are_inside_out(scene))
        return "all emissive faces shine into closed lamps, their corners run the wrong way round: "
               "--two-sided-lights lets their backs shine as well";
    if (view.backs >= NEARLY_ALL)
        return fmt::format(
            "the camera at {} sees nothing but backs of surfaces: it is inside a closed one, or "
            "behind an open one",
            short_triple(scene.camera.eye));
    if (const std::string& paths = options.transport.paths; !paths.empty()) {
        const std::string hits = plan_paths(scene, options).hit_paths.paths;
        return hits.empty()
                   ? fmt::format("paths {} carry no light to the camera here", paths)
                   : fmt::format("of paths {}, {} are found where one happens to hit a light, which hardly "
                                 "any does: more samples (--spp) may show some",
                                 paths, hits);
    }
    if (brightest > 0 && brightest < MIDDLE_GREY)
        return fmt::format(
            "the light is weak, the brightest pixel has radiance {:.2g}: --exposure {:.0f} shows it",
            brightest, std::ceil(std::log2(MIDDLE_GREY / brightest)));
    return "there is light, but hardly any of it reaches what the camera sees: surfaces lie between, or it "
           "takes more samples (--spp) to find a way";
}

} // namespace

std::optional<std::string> explain_empty_picture(const Scene& scene, const Options& options,
                                                 const Render& render) {
    if (film_samples(render.film) == 0)
        return std::nullopt;
    const std::vector<float> mean = film_mean(render.film);
    const Lightness lightness =
        measure_lightness(mean, DARKEST_GREY * std::exp2(-chosen_exposure_ev(options.output, mean)));
    const bool is_dark = lightness.lit_share < LIT_SHARE;
    const bool met_nothing = render.counts.secondary + render.counts.shadow == 0;
    if (!is_dark && !met_nothing)
        return std::nullopt;
    // A grid knows nothing of instances.
    const std::optional<VoxelGrid> grid = scene.prototypes.empty() ? VoxelGrid::make(scene) : std::nullopt;
    const InView view = grid ? probe_view(*grid, scene, options) : InView{};
    if (grid && view.hits == 0)
        return (is_dark ? "the picture is black: " : "the picture shows no surface: ") +
               explain_miss(scene, *grid);
    if (!is_dark)
        return std::nullopt;
    return "the picture is nearly black: " +
           explain_darkness(scene, options, grid, view, lightness.brightest);
}

} // namespace clrt
