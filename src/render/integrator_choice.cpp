// SPDX-License-Identifier: Apache-2.0
#include "render/integrator_choice.h"

#include "film/film_file.h"
#include "render/render_params.h"
#include "seconds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// Samples a pixel of a pilot: two a replicate, so that pixels are as small as they can be. What varies
/// within a pixel counts as noise of both integrators and hides how they differ.
constexpr std::uint32_t PILOT_SPP = 8;
/// Fewer samples of all pixels together tell nothing reliable of caustics, more tell nothing new.
constexpr double FEWEST_SAMPLES = 8192, MOST_PILOT_SAMPLES = 131072;
/// What a sample of a pilot costs, in samples of path (2.6 to 3.3 in all, processor seconds of three scenes):
/// its path from the eye, weighted twice, and its light path.
constexpr double PILOT_EYE_WORK = 1.7, PILOT_LIGHT_WORK = 1.5;
/// Samples of path in a second that a slow machine takes, for renders that end by time.
constexpr double SLOW_PACE = 2e5;
/// What path+light costs, in rays of path: its rays from the eye, where every vertex is weighted against
/// splats and paths are followed one by one, those from the lights, and a sample besides, whose light path is
/// begun. Within 10 % of the processor seconds of seven scenes with 3 to 11 rays a sample.
constexpr double SPLATTED_EYE_RAY_WORK = 1.35, LIGHT_RAY_WORK = 1, LIGHT_PATH_WORK = 1.3;

/// What is expected to gain less than this is not taken: pilots were up to a third off.
constexpr double WORTHWHILE_GAIN = 1.1;

/// Why the options leave nothing but path; none: they do not.
std::optional<std::string> reason_for_path(const Options& options) {
    if (!options.transport.paths.empty())
        return "--paths tells paths apart";
    if (!options.output.path_layers.empty())
        return "--aov NAME=EXPR tells paths apart";
    if (options.sampling.adaptive)
        return "--adaptive gives samples to tiles, and light paths reach all of them at once";
    if (options.transport.guide == Toggle::ON)
        return "--guide on guides paths from the eye";
    return std::nullopt;
}

/// Light paths of a pass for each pixel of the window.
double light_paths_a_sample(const Options& options) {
    const Crop window = render_window(options.film);
    return double(options.film.size.x) * double(options.film.size.y) /
           (double(window.x1 - window.x0) * double(window.y1 - window.y0));
}

/// Samples of all pixels that a render takes at least, as far as its options tell.
double expected_samples(const Options& options) {
    const Crop window = render_window(options.film);
    const double pixels = double(window.x1 - window.x0) * double(window.y1 - window.y0);
    const SamplingOptions& sampling = options.sampling;
    const bool is_by_time = sampling.time_seconds && !sampling.spp;
    const double samples = is_by_time ? HUGE_VAL : pixels * double(sampling.spp.value_or(DEFAULT_SPP));
    return sampling.time_seconds ? std::min(samples, SLOW_PACE * *sampling.time_seconds) : samples;
}

/// Squared error times work: by the relative measure, or by that which --error judges by.
double price(const IntegratorPrice& of, const Options& options) {
    const ErrorMeasure measure = options.sampling.error ? options.sampling.measure() : ErrorMeasure::RELATIVE;
    return of.errors[size_t(measure)] * of.work;
}

/// The integrators between which a pilot decides, with what it says of them. The first is taken where no
/// other one is worth it. Another one is a row more.
std::vector<IntegratorPrice> prices_of(const PilotResult& pilot, const Options& options) {
    std::vector<IntegratorPrice> prices = {
        {Integrator::PATH, pilot.path, pilot.eye_rays},
        {Integrator::PATH_LIGHT, pilot.path_light,
         SPLATTED_EYE_RAY_WORK * pilot.eye_rays + LIGHT_RAY_WORK * pilot.light_rays +
             LIGHT_PATH_WORK * pilot.aimed * light_paths_a_sample(options)}};
    for (size_t i = 1; i < prices.size(); ++i)
        prices[i].efficiency = price(prices[0], options) / price(prices[i], options);
    return prices;
}

/// Decides by a pilot.
void decide(const PilotResult& pilot, const Options& options, IntegratorChoice& choice) {
    if (pilot.is_black) {
        choice.reason = "a pilot finds no light";
        return;
    }
    choice.prices = prices_of(pilot, options);
    double best = WORTHWHILE_GAIN;
    std::vector<std::string> efficiencies;
    for (const IntegratorPrice& row : choice.prices) {
        efficiencies.push_back(fmt::format("{} {:.2g}", name_of(row.integrator), row.efficiency));
        if (row.efficiency > best) {
            best = row.efficiency;
            choice.integrator = row.integrator;
        }
    }
    choice.reason =
        fmt::format("efficiency {} by a pilot of {} x {} pixels, {} spp", fmt::join(efficiencies, ", "),
                    choice.pilot.width, choice.pilot.height, choice.pilot.spp);
}

/// The integrator of the film that is gone on with.
Integrator integrator_of_film(const std::string& path) {
    const FilmIdentity identity = read_film_content(path).identity;
    const auto name = identity.find("integrator");
    const auto found = name != identity.end() && name->is_string()
                           ? find_named<Integrator>(name->get<std::string>())
                           : std::nullopt;
    return found.value_or(Integrator::PATH);
}

/// Decides by what the options and the scene say; false where a pilot must, whose size is set.
bool decide_by_facts(PlannedScene& planned, IntegratorChoice& choice) {
    if (!planned.options.film_file.resume_path.empty()) {
        choice.integrator = integrator_of_film(planned.options.film_file.resume_path);
        choice.reason = "as the film that is gone on with";
    } else if (const auto reason = reason_for_path(planned.options)) {
        choice.reason = *reason;
    } else if (planned.effects.paths.is_empty || !has_caustics(planned)) {
        choice.reason = "no mirror or smooth glass casts light on a surface (LS+DE)";
    } else if (!planned.effects.paths.blind_spots.empty()) {
        choice.integrator = Integrator::PATH_LIGHT;
        choice.reason = fmt::format("path does not see {} ({})", planned.effects.paths.blind_spots[0].paths,
                                    planned.effects.paths.blind_spots[0].cause);
    } else if (const auto size = pilot_size(planned.options)) {
        choice.pilot = *size;
        return false;
    } else
        choice.reason = "too few samples for a pilot";
    return true;
}

} // namespace

std::optional<PilotSize> pilot_size(const Options& options) {
    const Crop window = render_window(options.film);
    const double width = window.x1 - window.x0, height = window.y1 - window.y0;
    const double work = PILOT_EYE_WORK + PILOT_LIGHT_WORK * light_paths_a_sample(options);
    const double samples = std::min(PILOT_SHARE / work * expected_samples(options), MOST_PILOT_SAMPLES);
    if (samples < FEWEST_SAMPLES)
        return std::nullopt;
    const double scale = std::min(std::sqrt(samples / PILOT_SPP / (width * height)), 1.0);
    return PilotSize{std::max(int(width * scale), 1), std::max(int(height * scale), 1), PILOT_SPP};
}

IntegratorChoice choose_integrator(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                                   std::shared_ptr<const SceneTree>& tree, Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    IntegratorChoice choice;
    choice.integrator = planned->options.transport.integrator;
    choice.is_asked = planned->options.transport.choose;
    if (!choice.is_asked)
        return choice;
    if (!decide_by_facts(*planned, choice)) {
        progress.update({"pilot", -1, 0, -1, -1});
        take_integrator(Integrator::PATH_LIGHT, *planned);
        const PreparedScene prepared = prepare_scene(device, planned, {tree, nullptr});
        tree = prepared.tree;
        decide(run_pilot(prepared, choice.pilot), planned->options, choice);
    }
    take_integrator(choice.integrator, *planned);
    choice.seconds = seconds_since(start);
    progress.finish();
    spdlog::info("integrator: {}", choice_text(choice));
    return choice;
}

std::string choice_text(const IntegratorChoice& choice) {
    return choice.is_asked ? fmt::format("{}: {}", name_of(choice.integrator), choice.reason) : "";
}

} // namespace clrt
