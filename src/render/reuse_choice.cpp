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

/// Work of both pilots of reuse together, in samples of path. Those of light samples, where there are any
/// (light_samples_choice.h), are as large and come on top.
constexpr double PILOTS_WORK = 2.5;

/// Effects of the scene that keep a path from being of use to other pixels.
EffectMask effects_against(const PlannedScene& planned) {
    return planned.effects.needed & ~planned.effects.left_out & EFFECTS_OF_ONE_PIXEL;
}

/// Whether scene and options let paths be reused; refuses where it is asked for and the scene does not.
bool is_allowed(const PlannedScene& planned) {
    const EffectMask against = effects_against(planned);
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
    const double work = 1 + SHARED_RAY_COST * (reusing.rays - alone.rays) / alone.rays;
    return deciding_error(alone.errors, options) / (deciding_error(reusing.errors, options) * work);
}

/// Whether pilots are to decide.
bool is_open(const PlannedScene& planned) {
    const Options& options = planned.options;
    return options.transport.path_reuse == Toggle::AUTO && options.film_file.resume_path.empty() &&
           effects_against(planned) == 0 && !reuse_refusal(options) && size_of_path_pilots(planned);
}

} // namespace

std::optional<PilotSize> size_of_path_pilots(const PlannedScene& planned) {
    if (planned.effects.paths.is_empty || planned.options.run.given.count("--first-sample") != 0)
        return std::nullopt;
    const std::optional<PilotSize> size = size_of_pilots(PILOTS_WORK, planned.options);
    return size ? std::optional(in_tiles(*size)) : std::nullopt;
}

void expect_reuse(const Device& device, const std::shared_ptr<PlannedScene>& planned) {
    if (!is_open(*planned))
        return;
    planned->options.transport.path_reuse = Toggle::ON;
    expect_program(device, *planned);
    planned->options.transport.path_reuse = Toggle::AUTO;
}

PreparedScene prepare_path_pilot(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                                 PreparedParts& parts) {
    const bool may_reuse = is_open(*planned);
    std::shared_ptr<const RenderPrograms>& programs = may_reuse ? parts.reusing : parts.programs;
    Toggle& reuse = planned->options.transport.path_reuse;
    const Toggle asked = reuse;
    if (may_reuse)
        reuse = Toggle::ON; // what is compiled
    PreparedScene prepared = prepare_render(device, planned, {parts.tree, programs});
    reuse = asked;
    parts.tree = prepared.tree;
    programs = prepared.programs;
    return prepared;
}

std::optional<ReusePilots>
run_reuse_pilots(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts) {
    if (!is_open(*planned))
        return std::nullopt;
    const PilotSize size = *size_of_path_pilots(*planned);
    const PreparedScene prepared = prepare_path_pilot(device, planned, parts);
    ReusePilots pilots{run_path_pilot(prepared, size), run_path_pilot(prepared, size, true)};
    const double gain = gain_of(pilots.reusing, pilots.alone, planned->options);
    if (!std::isfinite(gain) || stop_signal())
        return pilots;
    spdlog::info("path reuse: {:.2f} times the efficiency, by pilots of {} x {} pixels, {} spp", gain,
                 size.width, size.height, size.spp);
    pilots.gain = gain;
    return pilots;
}

std::optional<ReusePilots> choose_path_reuse(const Device& device,
                                             const std::shared_ptr<PlannedScene>& planned,
                                             PreparedParts& parts, Progress& progress) {
    Options& options = planned->options;
    Toggle& reuse = options.transport.path_reuse;
    if (!is_allowed(*planned))
        reuse = Toggle::OFF;
    if (reuse != Toggle::AUTO)
        return std::nullopt;
    if (!options.film_file.resume_path.empty()) {
        const FilmIdentity film = read_film_content(options.film_file.resume_path).identity;
        reuse = film_reuses_paths(film) ? Toggle::ON : Toggle::OFF;
        parts.programs = nullptr;
    } else if (is_open(*planned)) {
        progress.update({"pilot", -1, 0, -1, -1});
        const ReusePilots pilots = *run_reuse_pilots(device, planned, parts);
        reuse = pilots.gain >= WORTHWHILE_REUSE_GAIN ? Toggle::ON : Toggle::OFF;
        if (reuse == Toggle::ON)
            parts.programs = parts.reusing;
        progress.finish();
        return pilots;
    } else {
        reuse = Toggle::OFF;
    }
    return std::nullopt;
}

} // namespace clrt
