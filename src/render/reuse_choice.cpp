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

/// Squared error times rays of a sample.
double cost(const PathPilot& pilot, const Options& options) {
    const SamplingOptions& sampling = options.sampling;
    const ErrorMeasure measure = sampling.has_target() ? sampling.measure() : ErrorMeasure::RELATIVE;
    return pilot.errors[size_t(measure)] * pilot.rays;
}

/// Decides by pilots of the same samples.
Toggle choose_by_pilots(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                        const PilotSize& size, PreparedParts& parts) {
    Toggle& reuse = planned->options.transport.path_reuse;
    const auto cost_when = [&](Toggle value, PreparedParts& with) {
        reuse = value;
        const PreparedScene prepared = prepare_render(device, planned, with);
        with = {prepared.tree, prepared.programs};
        return cost(run_path_pilot(prepared, size), planned->options);
    };
    const double alone = cost_when(Toggle::OFF, parts);
    PreparedParts reusing{parts.tree, nullptr};
    const double gain = stop_signal() ? 0 : alone / cost_when(Toggle::ON, reusing);
    if (!(gain >= WORTHWHILE_REUSE_GAIN) || !std::isfinite(gain) || stop_signal())
        return Toggle::OFF;
    parts = reusing;
    spdlog::info("path reuse: {:.2f} times the efficiency, by pilots of {} x {} pixels, {} spp", gain,
                 size.width, size.height, size.spp);
    return Toggle::ON;
}

} // namespace

void choose_path_reuse(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                       PreparedParts& parts, Progress& progress) {
    Options& options = planned->options;
    Toggle& reuse = options.transport.path_reuse;
    if (!is_allowed(*planned))
        reuse = Toggle::OFF;
    if (reuse != Toggle::AUTO)
        return;
    const std::optional<PilotSize> size = size_of_pilots(PILOTS_WORK, options);
    if (!options.film_file.resume_path.empty()) {
        const FilmIdentity film = read_film_content(options.film_file.resume_path).identity;
        reuse = film_reuses_paths(film) ? Toggle::ON : Toggle::OFF;
        parts.programs = nullptr;
    } else if (!size || planned->effects.paths.is_empty || options.run.given.count("--first-sample") != 0) {
        reuse = Toggle::OFF;
    } else {
        progress.update({"pilot", -1, 0, -1, -1});
        reuse = choose_by_pilots(device, planned, *size, parts);
        progress.finish();
    }
}

} // namespace clrt
