// SPDX-License-Identifier: Apache-2.0
#include "render/integrator_price.h"

#include "render/render_params.h"
#include "scene/slabs.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace clrt {

namespace {

/// Rays within 10 % of the processor seconds of seven scenes with 3 to 11 rays a sample; pilots of path+light
/// 2.6 to 3.3 in all, of three.
constexpr Candidate CANDIDATES[] = {{Integrator::PATH_LIGHT, 1.35, 1, 0, 1.3, 1.7, 1.5},
                                    {Integrator::BDPT, 1.25, 1.2, 1, 1.3, 1.7, 1.5}};

/// What is expected of bdpt where a guide of path is promising. With it path is 1.2 to 4 times as efficient
/// there, which no pilot so small can tell: of a door ajar one says 1.8 and of a corridor that is lit round a
/// corner 2.4.
constexpr double WORTHWHILE_GAIN_OVER_GUIDE = 2.4;

/// By ErrorMeasure: it was 1.2 to 3.4 by mse and 1.2 to 1.7 by relative in a Cornell box, over spheres on a
/// plane and beside a caustic. Where it was most, path+light gained 1.3 and 2.3 over it.
constexpr double GAIN_OF_ADAPTIVE[] = {2.7, 1.2};

/// What a light tree gained at most, in rooms of many lamps.
constexpr double LARGEST_GAIN_OF_LIGHT_TREE = 4;

/// Light paths of a pass for each pixel of the window.
double light_paths_a_sample(const Options& options) {
    const Crop window = render_window(options.film);
    return double(options.film.size.x) * double(options.film.size.y) /
           (double(window.x1 - window.x0) * double(window.y1 - window.y0));
}

/// Of an integrator over path, of which one sample takes `path_rays`.
double efficiency_over_path(const IntegratorPrice& price, double path_rays, const Options& options) {
    return deciding_error(price.path, options) * path_rays /
           (deciding_error(price.errors, options) * price.work);
}

} // namespace

bool has_hard_caustics(const PlannedScene& planned) {
    return has_caustics(planned) && !path_connects_to_caustics(planned);
}

bool is_candidate(Integrator integrator) {
    return std::any_of(std::begin(CANDIDATES), std::end(CANDIDATES),
                       [&](const Candidate& candidate) { return candidate.integrator == integrator; });
}

std::vector<Candidate> candidates_of(const PlannedScene& planned) {
    std::vector<Candidate> candidates;
    for (const Candidate& candidate : CANDIDATES)
        if (candidate.integrator != Integrator::PATH_LIGHT || has_hard_caustics(planned))
            candidates.push_back(candidate);
    return candidates;
}

double pilot_work(const std::vector<Candidate>& candidates, const PlannedScene& planned) {
    const Options& options = planned.options;
    const bool has_own = options.transport.choose == Toggle::AUTO || has_slabs_before_lamps(planned.scene);
    double work = has_own ? 1 : 0;
    for (const Candidate& candidate : candidates)
        work += candidate.pilot_eye + candidate.pilot_light * light_paths_a_sample(options);
    return work;
}

IntegratorPrice price_of(const Candidate& candidate, const PilotResult& pilot, const Options& options) {
    IntegratorPrice price{candidate.integrator, pilot.own, pilot.path};
    price.work = candidate.eye_ray * pilot.eye_rays + candidate.light_ray * pilot.light_rays +
                 candidate.inner_ray * pilot.inner_rays + candidate.light_path * pilot.light_paths;
    price.efficiency = efficiency_over_path(price, pilot.eye_rays, options);
    return price;
}

bool has_light_tree(const PlannedScene& planned) {
    return !planned.scene.light_tree.nodes.empty();
}

bool is_measured_alone(const PlannedScene& planned) {
    return has_light_tree(planned) || has_slabs_before_lamps(planned.scene);
}

SquaredErrors caustic_errors(const PilotResult& pilot) {
    SquaredErrors errors{};
    for (size_t i = 0; i < errors.size(); ++i)
        errors[i] = std::max(0., pilot.path[i] - pilot.own[i]);
    return errors;
}

IntegratorPrice measured_price(IntegratorPrice price, const PathPilot& path, const SquaredErrors& caustics,
                               const Options& options) {
    for (size_t i = 0; i < caustics.size(); ++i)
        price.path[i] = std::max(path.errors[i], caustics[i]);
    const double efficiency = efficiency_over_path(price, path.rays, options);
    if (price.guided > 0)
        price.guided *= efficiency / price.efficiency;
    price.efficiency = efficiency;
    return price;
}

double gain_of_adaptive(const Options& options) {
    return options.sampling.adaptive ? GAIN_OF_ADAPTIVE[size_t(*options.sampling.adaptive)] : 1;
}

double gain_beside_caustics(const std::optional<ReusePilots>& pilots, const SquaredErrors& caustics,
                            const Options& options) {
    if (!pilots || pilots->gain == 0)
        return 0;
    const double alone = deciding_error(pilots->alone.errors, options);
    const double reusing = deciding_error(pilots->reusing.errors, options);
    const double caustic = deciding_error(caustics, options);
    const double work = alone / (reusing * pilots->gain);
    return std::max(alone, caustic) / (std::max(reusing, caustic) * work);
}

double smallest_gain(const IntegratorPrice& price, bool is_guided, const Options& options) {
    const bool rivals_guide = is_guided && price.integrator == Integrator::BDPT;
    return rivals_guide ? WORTHWHILE_GAIN_OVER_GUIDE
                        : WORTHWHILE_GAIN_OF_INTEGRATOR * gain_of_adaptive(options);
}

double most_of_path(const PlannedScene& planned) {
    if (has_slabs_before_lamps(planned.scene))
        return std::numeric_limits<double>::infinity();
    return REUSE_PIXELS * (has_light_tree(planned) ? LARGEST_GAIN_OF_LIGHT_TREE : 1);
}

} // namespace clrt
