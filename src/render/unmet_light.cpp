// SPDX-License-Identifier: Apache-2.0
#include "render/unmet_light.h"

#include "scene/brightness.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace clrt {

namespace {

/// -ln 0.05.
constexpr double RULE_OF_THREE = 3;

/// Of a chain's steps, the new paths that can hit a light: small steps find no new way. Three of ten are new
/// (CHAIN_LARGE_STEP in kernels/integrators/mlt.h), and a third of them takes the strategy that hits
/// (kernels/path/chain_path.h).
constexpr double CHAIN_HITS_SHARE = 0.1;

/// Whether a guide leads paths to such light: it learns from light paths whence it comes, before any path
/// from the eye has met it (kernels/path/guide_learn.h). Path's guide learns from those that have.
bool is_looked_for(Integrator integrator, const GuideProgress& guide) {
    return integrator == Integrator::BDPT && guide.guided_from && guide.guided_to == 0;
}

} // namespace

std::optional<HitLight> hit_light(const Scene& scene, const PathPlan& paths, Integrator integrator,
                                  const GuideProgress& guide) {
    if (paths.hit_paths.kinds == 0 || is_looked_for(integrator, guide))
        return std::nullopt;
    const double share = walks_chains(integrator) ? CHAIN_HITS_SHARE : 1;
    return HitLight{paths.hit_paths.paths, largest_radiance(scene, paths.hit_paths.kinds) / share};
}

std::optional<UnmetLight> unmet_light(const RenderProgress& render, const std::optional<HitLight>& hits) {
    const double samples = film_all_samples(render.film);
    if (!hits || !(samples > 0))
        return std::nullopt;
    const std::vector<float> picture = film_mean(render.film);
    const double mean = std::accumulate(picture.begin(), picture.end(), 0.0) / double(picture.size());
    const double bound = RULE_OF_THREE * hits->radiance / (samples * mean);
    if (!(mean > 0) || bound < LEAST_UNMET)
        return std::nullopt;
    return UnmetLight{hits->paths, bound};
}

std::string format_unmet(const std::optional<UnmetLight>& unmet) {
    if (!unmet)
        return "";
    const double percent = 100 * unmet->relative_bound;
    return fmt::format(
        "unmet    only paths that happen to hit a light find {}: by ways that no sample took, the "
        "picture may lack up to {:.{}f} % of its mean (95 % confidence)\n",
        unmet->paths, percent, percent < 10 ? 1 : 0);
}

nlohmann::ordered_json unmet_json(const std::optional<UnmetLight>& unmet) {
    if (!unmet)
        return nullptr;
    return {{"paths", unmet->paths}, {"rel_light_bound", unmet->relative_bound}, {"confidence", 0.95}};
}

} // namespace clrt
