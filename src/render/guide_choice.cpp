// SPDX-License-Identifier: Apache-2.0
#include "render/guide_choice.h"

#include "console/signals.h"
#include "options/path_refusals.h"
#include "render/guiding.h"
#include "scene/brightness.h"
#include "scene/casters.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// Rays of a render that is guided at once, as a multiple of those that a guide is learnt from before it is
/// judged: an epoch as long again is the trial, and the rest has the gain.
constexpr double RAYS_BEYOND_LEARNING = 4;

/// Samples a pixel of a pilot that teaches a guide and judges it: four replicates take one each without a
/// guide, one with what these have taught, and two with what all have.
constexpr std::uint32_t JUDGING_SPP = 16;
/// Of a render's samples, those of all pixels that such a pilot takes, and how many of them it must be and
/// can be.
constexpr double JUDGING_SHARE = 1.0 / 16, FEWEST_JUDGING = 1 << 20, MOST_JUDGING = 1 << 21;

/// In shorter renders samples that are dropped for a guide cost more than they gain, but where those that it
/// is learnt from would be most of the picture's error: from this squared error on half such a pilot, and a
/// smaller one, teaches, and the picture's samples judge.
constexpr double LARGE_ERROR = 50;
constexpr double TEACHING_SHARE = 1.0 / 16, FEWEST_TEACHING = 1 << 17, MOST_TEACHING = 1 << 18;
/// The same of bdpt, of which no pilot has told that there is anything to find.
constexpr double TEACHING_BDPT_SHARE = 1.0 / 32;

/// The least part of a picture's light for whose sake a guide is tried.
constexpr double LEAST_BY_HITS = 0.01;

/// Whether the options leave it open.
bool is_open(const Options& options) {
    return options.transport.guide == Toggle::AUTO && may_guide(options) &&
           options.film_file.resume_path.empty();
}

/// What decides for path and path+light.
double error_of_paths(const PathPilot& unguided) {
    return guide_error(unguided.errors[0], unguided.errors[1], unguided.trimmed);
}

/// What decides for bdpt, which guides paths where nothing but hits finds light. They are so few that a pilot
/// may have met none: the squared error of a sample if they bring LEAST_BY_HITS of the picture's light, of
/// the brightest light that there is. Where nothing casts caustics there are no such places.
double error_of_hits(const Scene& scene, const PathPilot& unguided) {
    return has_casters(scene) && unguided.mean > 0
               ? LEAST_BY_HITS * largest_radiance(scene, KINDS_ALL) / unguided.mean
               : 0;
}

/// The squared error of a sample that decides.
double error_to_lower(const PlannedScene& planned, Integrator integrator, const PathPilot& unguided) {
    return integrator == Integrator::BDPT ? error_of_hits(planned.scene, unguided) : error_of_paths(unguided);
}

/// Size of the pilot that teaches; none: the picture's own samples do. Light paths teach bdpt so much at once
/// that the pilot can judge it, however small.
std::optional<PilotSize> teaching_pilot(const Options& options, double error) {
    const double judging = JUDGING_SHARE * expected_samples(options);
    if (judging >= FEWEST_JUDGING)
        return scaled_pilot(options, std::min(judging, MOST_JUDGING), JUDGING_SPP);
    const bool is_bdpt = options.transport.integrator == Integrator::BDPT;
    const double teaching = (is_bdpt ? TEACHING_BDPT_SHARE : TEACHING_SHARE) * expected_samples(options);
    if (error >= LARGE_ERROR && teaching >= FEWEST_TEACHING)
        return scaled_pilot(options, std::min(teaching, MOST_TEACHING),
                            is_bdpt ? JUDGING_SPP : JUDGING_SPP / 2);
    return std::nullopt;
}

} // namespace

bool is_guide_promising(const PlannedScene& planned, Integrator integrator, const PathPilot& unguided) {
    const Options& options = planned.options;
    const double rays = expected_samples(options) * unguided.rays;
    const double error = error_to_lower(planned, integrator, unguided);
    return is_open(options) && std::isfinite(error) && error >= worthwhile_guide_error(options) &&
           rays >= RAYS_BEYOND_LEARNING * options.transport.guide_after_rays;
}

GuideProgress first_guide(const PreparedScene& prepared, const PathPilot& unguided) {
    const Options& options = prepared.planned->options;
    const int replicates = options.sampling.replicates;
    const double error = error_to_lower(*prepared.planned, options.transport.integrator, unguided);
    std::optional<PilotSize> teaching = teaching_pilot(options, error);
    if (!teaching)
        return untaught_guide(replicates, error);
    if (options.transport.path_reuse == Toggle::ON)
        teaching = in_tiles(*teaching);
    const GuideProgress pilot = run_guide_pilot(prepared, *teaching, error);
    return taught_guide(pilot, replicates, unguided.rays * double(teaching->samples()));
}

void choose_guide(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts,
                  std::optional<PathPilot> unguided, Progress& progress) {
    const Options& options = planned->options;
    const bool shares = options.transport.path_reuse == Toggle::ON;
    std::optional<PilotSize> size = size_of_pilots(1, options);
    if (size && shares)
        size = in_tiles(*size);
    const bool has_none = options.transport.integrator == Integrator::BDPT && !has_casters(planned->scene);
    if (parts.guide || has_none || !is_open(options) || planned->effects.paths.is_empty ||
        (unguided ? !is_guide_promising(*planned, options.transport.integrator, *unguided) : !size))
        return;
    progress.update({"pilot", -1, 0, -1, -1});
    if (unguided)
        expect_program(device, *planned, true);
    const PreparedScene prepared = prepare_render(device, planned, parts);
    parts = {prepared.tree, prepared.programs, nullptr};
    if (!unguided)
        unguided = run_path_pilot(prepared, *size, shares);
    if (is_guide_promising(*planned, options.transport.integrator, *unguided) && !stop_signal())
        parts.guide = std::make_shared<GuideProgress>(first_guide(prepared, *unguided));
    progress.finish();
}

} // namespace clrt
