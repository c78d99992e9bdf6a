// SPDX-License-Identifier: Apache-2.0
#include "render/reuse_choice.h"

#include "console/signals.h"
#include "effects/effect_table.h"
#include "error.h"
#include "film/film_file.h"
#include "film/film_identity.h"
#include "options/path_refusals.h"
#include "render/pilot.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// Work of both pilots together, in samples of path.
constexpr double PILOTS_WORK = 2.5;

/// Takes what the scene does not allow: refuses where it is asked for.
bool is_allowed(const PlannedScene& planned) {
    const EffectMask against = planned.effects.needed & ~planned.effects.left_out & EFFECTS_OF_ONE_PIXEL;
    if (against != 0 && planned.options.transport.path_reuse == Toggle::ON)
        throw UsageError(
            fmt::format("option --path-reuse on: expected a scene without {0}, found {0}; a path "
                        "there is of use to its own pixel alone",
                        fmt::join(effect_names(against), ", ")));
    return against == 0 && !reuse_refusal(planned.options);
}

/// What a shadow ray to another pixel's path costs, over the mean of all other rays and of what is computed
/// where they end: .14 to .48 in nine rooms, by seconds of two cores.
constexpr double SHARED_RAY_COST = 0.35;

/// How many times less the squared error times work of a sample is with reuse.
double gain_of(const PathPilot& reusing, const PathPilot& alone, const Options& options) {
    const SamplingOptions& sampling = options.sampling;
    const auto measure = size_t(sampling.has_target() ? sampling.measure() : ErrorMeasure::RELATIVE);
    const double work = 1 + SHARED_RAY_COST * (reusing.rays - alone.rays) / alone.rays;
    return alone.errors[measure] / (reusing.errors[measure] * work);
}

/// Size of the pilots; none where so small ones tell nothing, and for parts of a picture.
std::optional<PilotSize> size_of_reuse_pilots(const PlannedScene& planned) {
    if (planned.effects.paths.is_empty || planned.options.run.given.count("--first-sample") != 0)
        return std::nullopt;
    const std::optional<PilotSize> size = size_of_pilots(PILOTS_WORK, planned.options);
    return size ? std::optional(in_tiles(*size)) : std::nullopt;
}

/// What pilots of the same samples tell of a plan for path; 0 where a signal stops them. `parts` has programs
/// without reuse, or none, and gets those; `reusing` gets those with it.
double pilot_gain(const Device& device, const std::shared_ptr<PlannedScene>& planned, const PilotSize& size,
                  PreparedParts& parts, PreparedParts& reusing) {
    const auto pilot_when = [&](Toggle value, PreparedParts& with) {
        planned->options.transport.path_reuse = value;
        const PreparedScene prepared = prepare_render(device, planned, with);
        with = {prepared.tree, prepared.programs};
        return run_path_pilot(prepared, size);
    };
    const PathPilot alone = pilot_when(Toggle::OFF, parts);
    reusing = {parts.tree, nullptr};
    if (stop_signal())
        return 0;
    const double gain = gain_of(pilot_when(Toggle::ON, reusing), alone, planned->options);
    if (!std::isfinite(gain) || stop_signal())
        return 0;
    spdlog::info("path reuse: {:.2f} times the efficiency, by pilots of {} x {} pixels, {} spp", gain,
                 size.width, size.height, size.spp);
    return gain;
}

} // namespace

double reuse_gain(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts) {
    Options& options = planned->options;
    const Options asked = options;
    options.run.pixel.reset(); // a replay is of the picture's integrator
    double gain = 0;
    if (const std::optional<PilotSize> size = size_of_reuse_pilots(*planned);
        size && options.transport.path_reuse == Toggle::AUTO && is_allowed(*planned)) {
        PreparedParts alone{parts.tree, nullptr};
        gain = pilot_gain(device, planned, *size, alone, parts);
    }
    options = asked;
    return gain;
}

void choose_path_reuse(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                       PreparedParts& parts, Progress& progress) {
    Options& options = planned->options;
    Toggle& reuse = options.transport.path_reuse;
    if (!is_allowed(*planned))
        reuse = Toggle::OFF;
    if (reuse != Toggle::AUTO)
        return;
    if (!options.film_file.resume_path.empty()) {
        const FilmIdentity film = read_film_content(options.film_file.resume_path).identity;
        reuse = film_reuses_paths(film) ? Toggle::ON : Toggle::OFF;
        parts.programs = nullptr;
    } else if (const std::optional<PilotSize> size = size_of_reuse_pilots(*planned)) {
        progress.update({"pilot", -1, 0, -1, -1});
        PreparedParts reusing;
        const double gain = pilot_gain(device, planned, *size, parts, reusing);
        reuse = gain >= WORTHWHILE_REUSE_GAIN ? Toggle::ON : Toggle::OFF;
        if (reuse == Toggle::ON)
            parts = reusing;
        progress.finish();
    } else {
        reuse = Toggle::OFF;
    }
}

} // namespace clrt
