// SPDX-License-Identifier: Apache-2.0
#include "render/unmet_light.h"

#include "film/error_pixels.h"
#include "render/cut_paths.h"
#include "scene/brightness.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// -ln 0.05.
constexpr double RULE_OF_THREE = 3;

/// Of a chain's steps, the new paths of one length that can hit a light: small steps find no new way. Three
/// of ten are new (CHAIN_LARGE_STEP in kernels/integrators/mlt.h), and a third of them takes the strategy
/// that hits (kernels/path/chain_path.h). A chain keeps its length; as if all lengths had as many.
constexpr double CHAIN_HITS_SHARE = 0.1 / (USUAL_CHAIN_DEPTH - 1);

/// What a guide leaves of the largest sample: that of bdpt learns from light paths whence light comes by
/// smooth surfaces, before any path from the eye has met it (kernels/path/guide_learn.h). Guided samples then
/// meet it as much more often as they have less squared error, about. Path's learns from those that have met
/// it.
double left_by_guide(const HitPaths& paths, Integrator integrator, const RenderProgress& render) {
    const GuideProgress& guide = render.guide;
    const bool leads = integrator == Integrator::BDPT && paths.are_smooth && guide.stage == GuideStage::ON &&
                       guide.guided_from && guide.error;
    if (!leads)
        return 1;
    const double all = double(film_samples(render.film)), plain = std::min(double(*guide.guided_from), all);
    return all > 0 ? all / (plain + (all - plain) / std::min(*guide.error, 1.0)) : 1;
}

} // namespace

std::optional<HitLight> hit_light(const Scene& scene, const PathPlan& paths, Integrator integrator,
                                  const RenderProgress& render) {
    if (paths.hit_paths.kinds == 0)
        return std::nullopt;
    const double share = walks_chains(integrator) ? CHAIN_HITS_SHARE : 1;
    return HitLight{paths.hit_paths.paths, largest_radiance(scene, paths.hit_paths.kinds) *
                                               left_by_guide(paths.hit_paths, integrator, render) / share};
}

std::optional<UnmetLight> unmet_light(const RenderProgress& render, const std::optional<HitLight>& hits) {
    const double samples = samples_of_mean(render.film);
    if (!hits || !(samples > 0))
        return std::nullopt;
    const std::vector<float> picture = film_mean(render.film);
    const PixelChoice choice(render.film, ErrorPixels::SCENE);
    double sum = 0, pixels = 0;
    for (size_t i = 0; i < picture.size(); ++i)
        if (choice.has(i / 3)) {
            sum += picture[i];
            pixels += 1. / 3;
        }
    UnmetLight unmet{hits->paths, RULE_OF_THREE * hits->radiance / (pixels * samples), {}};
    if (sum > 0)
        unmet.relative_bound = unmet.light_bound / (sum / (3 * pixels));
    if (!(unmet.light_bound > 0) || (unmet.relative_bound && *unmet.relative_bound < LEAST_UNMET))
        return std::nullopt;
    return unmet;
}

std::string format_unmet(const std::optional<UnmetLight>& unmet) {
    if (!unmet)
        return "";
    std::string bound = fmt::format("a mean radiance of up to {:.3g}", unmet->light_bound);
    if (unmet->relative_bound) {
        const double percent = 100 * *unmet->relative_bound;
        bound = fmt::format("up to {:.{}f} % of the scene's mean", percent, percent < 10 ? 1 : 0);
    }
    return fmt::format(
        "unmet    hardly any but paths that happen to hit a light find {}: by ways that no sample took, "
        "the picture may lack {} (95 % confidence)\n",
        unmet->paths, bound);
}

nlohmann::ordered_json unmet_json(const std::optional<UnmetLight>& unmet) {
    if (!unmet)
        return nullptr;
    nlohmann::ordered_json json = {{"paths", unmet->paths}, {"light_bound", unmet->light_bound}};
    json["rel_light_bound"] = nullptr;
    if (unmet->relative_bound)
        json["rel_light_bound"] = *unmet->relative_bound;
    json["confidence"] = 0.95;
    return json;
}

} // namespace clrt
