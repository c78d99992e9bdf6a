// SPDX-License-Identifier: Apache-2.0
#include "render/cut_paths.h"

#include "kernels/shared/render_types.h"
#include "render/unmet_light.h"
#include "scene/brightness.h"
#include "scene/vectors.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace clrt {

namespace {

/// Whether light that no ray meets makes highlights.
bool has_highlights(const Scene& scene) {
    return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const Triangle& triangle) {
        return (scene.materials[triangle.material].lobes & LOBE_GLOSSY) != 0;
    });
}

} // namespace

double samples_of_mean(const Film& film) {
    if (!is_adaptive(film))
        return double(film_samples(film));
    std::uint32_t fewest = UINT32_MAX;
    for (const std::vector<std::uint32_t>& half : film.tile_samples)
        fewest = std::min(fewest, *std::min_element(half.begin(), half.end()));
    return 2.0 * fewest; // the picture is the mean of both halves' means
}

std::optional<double> cut_radiance(const Scene& scene, unsigned kinds) {
    const double albedo = largest_albedo(scene);
    if (!(albedo < 1))
        return std::nullopt;
    const std::optional<double> irradiance = largest_delta_irradiance(scene, kinds);
    if (!irradiance || (*irradiance > 0 && has_highlights(scene)))
        return std::nullopt;
    return (largest_radiance(scene, kinds) + *irradiance / PI) / (1 - albedo);
}

BiasSources bias_sources(const Scene& scene, const PathPlan& paths, const RenderProgress& render,
                         Integrator integrator) {
    BiasSources sources;
    if (render.counts.cut_paths > 0 && integrator_row(integrator).film == FilmAccess::GATHER)
        sources.cut_radiance = cut_radiance(scene, accepted_kinds(paths));
    sources.blind_spots = paths.blind_spots;
    sources.hits = hit_light(scene, paths, integrator, render);
    return sources;
}

CutPaths cut_paths(const RenderProgress& render, const std::optional<double>& radiance) {
    CutPaths cut;
    cut.paths = render.counts.cut_paths;
    cut.all = film_all_samples(render.film);
    cut.light_bound = cut.relative_bound = 0;
    if (cut.paths == 0)
        return cut;
    cut.light_bound = cut.relative_bound = std::nullopt;
    if (!radiance)
        return cut;
    const std::vector<float> picture = film_mean(render.film);
    const double values = double(picture.size());
    const double weight = double(render.counts.cut_weight) / CUT_WEIGHT_UNITS;
    cut.light_bound = *radiance * weight / (values / 3 * samples_of_mean(render.film));
    const double mean = std::accumulate(picture.begin(), picture.end(), 0.0) / values;
    if (mean > 0)
        cut.relative_bound = *cut.light_bound / mean;
    return cut;
}

std::string format_cut(const CutPaths& cut) {
    if (cut.paths == 0)
        return "";
    std::string text = fmt::format(
        "cut      {} of {} paths ended by --max-depth: beside the error, the picture ", cut.paths, cut.all);
    if (cut.relative_bound)
        return text + fmt::format("lacks up to {:.3g} % of its mean\n", 100 * *cut.relative_bound);
    if (cut.light_bound)
        return text + fmt::format("lacks a mean radiance of up to {:.3g}\n", *cut.light_bound);
    return text + "lacks light without a known bound\n";
}

nlohmann::ordered_json cut_json(const CutPaths& cut) {
    using Json = nlohmann::ordered_json;
    const auto number = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    return {{"paths", cut.paths},
            {"of", cut.all},
            {"light_bound", number(cut.light_bound)},
            {"rel_light_bound", number(cut.relative_bound)}};
}

} // namespace clrt
