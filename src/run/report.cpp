// SPDX-License-Identifier: Apache-2.0
#include "run/report.h"

#include "paths/path_report.h"
#include "render/denoised_target.h"
#include "render/render_params.h"
#include "run/denoising.h"
#include "run/report_facts.h"
#include "scene/ground.h"
#include "scene/normalise.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

/// The command line as one could type it again.
std::string command_text(const Options& options) {
    std::string text;
    for (const std::string& word : options.run.command) {
        const bool plain = word.find_first_of(" \t'\"\\$&|;<>()*?") == std::string::npos && !word.empty();
        text += (text.empty() ? "" : " ") + (plain ? word : "'" + word + "'");
    }
    return text;
}

/// What ended the render; whether the error that is asked for is reached, null without one.
Json stop_json(const Report& report) {
    Json json{{"rule", stop_rule_name(report.render.stop)},
              {"error_target", nullptr},
              {"error_reached", nullptr},
              {"error_of", nullptr},
              {"overrun_seconds", report.render.overrun_seconds},
              {"dropped_seconds", report.render.dropped_seconds}};
    json["forecasts"] = Json::array();
    for (const RenderForecast& forecast : report.render.forecasts) {
        json["forecasts"].push_back(price_json(forecast.price));
        json["forecasts"].back()["at_spp"] = forecast.samples;
        json["forecasts"].back()["at_seconds"] = forecast.seconds;
    }
    if (const std::optional<ErrorTarget> target = error_target(report)) {
        json["error_target"] = target->value;
        json["error_reached"] = target->reached;
        json["error_of"] = report.options.sampling.error ? "raw" : "denoised";
    }
    return json;
}

/// Whether the picture has the same bits on every device that keeps the rules. Nothing is known of a device
/// that was not asked, nor of --precision double, whose rules are not asked.
std::optional<bool> has_same_bits(const Report& report) {
    if (report.options.device.precision == Precision::FAST)
        return false;
    if (report.options.device.precision == Precision::DOUBLE || !report.facts)
        return std::nullopt;
    return promises_bits(*report.facts);
}

Json device_json(const Report& report) {
    const std::optional<bool> same_bits = has_same_bits(report);
    return {{"platform", report.device.platform},
            {"name", report.device.name},
            {"driver", report.device.driver},
            {"same_bits", same_bits ? Json(*same_bits) : Json(nullptr)},
            {"facts", report.facts ? facts_json(*report.facts) : Json(nullptr)}};
}

/// What each of several devices did; null: there was one.
Json shares_json(const Render& render) {
    if (render.shares.empty())
        return nullptr;
    Json list = Json::array();
    for (const auto& [device, work] : render.shares)
        list.push_back({{"index", fmt::format("{}:{}", device.platform_index, device.device_index)},
                        {"platform", device.platform},
                        {"name", device.name},
                        {"driver", device.driver},
                        {"spp", work.samples},
                        {"seconds", work.seconds},
                        {"failure", work.failure.empty() ? Json(nullptr) : Json(work.failure)}});
    return list;
}

/// The devices of a picture.
std::string device_text(const Report& report) {
    if (report.render.shares.empty())
        return report.device.platform + ": " + report.device.name;
    std::string text;
    for (const DeviceShare& share : report.render.shares)
        text += (text.empty() ? "" : "; ") + share.device.platform + ": " + share.device.name;
    return text;
}

/// The same as metadata.
void add_facts(const Report& report, Metadata& metadata) {
    const std::optional<bool> same_bits = has_same_bits(report);
    metadata.emplace_back("device.same_bits", !same_bits ? "unknown" : *same_bits ? "yes" : "no");
    if (report.facts)
        metadata.emplace_back("device.facts", describe_facts(*report.facts));
}

/// Null where nothing is told of a choice.
Json choice_json(const IntegratorChoice& choice) {
    if (!choice.is_told)
        return nullptr;
    Json json;
    json["integrator"] = name_of(choice.integrator);
    json["reason"] = choice.reason;
    json["pilot"] = nullptr;
    if (choice.pilot.spp == 0)
        return json;
    json["pilot"] = {{"width", choice.pilot.width},
                     {"height", choice.pilot.height},
                     {"spp", choice.pilot.spp},
                     {"seconds", choice.seconds}};
    json["prices"] = Json::array();
    for (const IntegratorPrice& price : choice.prices)
        json["prices"].push_back({{"integrator", name_of(price.integrator)},
                                  {"squared_error_mse", price.errors[size_t(ErrorMeasure::MSE)]},
                                  {"squared_error_relative", price.errors[size_t(ErrorMeasure::RELATIVE)]},
                                  {"rays_of_path", price.work},
                                  {"efficiency", price.efficiency}});
    return json;
}

/// Null where light samples do not look for the sky through portals.
Json portals_json(const Environment& sky) {
    return sky.portals.empty() ? Json(nullptr)
                               : Json{{"count", sky.portals.size()}, {"share_of_samples", sky.portal_share}};
}

/// Null where no sample is guided.
/// Whence pixels take emission that the outline of a light crosses; null: all emission is found by paths.
Json emission_json(const Report& report) {
    const std::uint64_t pixels = report.render.counts.outline_pixels;
    return pixels == 0 ? Json(nullptr)
                       : Json{{"pixels", pixels}, {"rays", report.options.transport.emission_rays}};
}

Json guide_json(const GuideProgress& guide) {
    if (!guide.guided_from)
        return nullptr;
    const auto number = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
    Json json;
    json["from_spp"] = *guide.guided_from;
    json["pilot_squared_error"] = number(guide.pilot_error);
    json["squared_error"] = number(guide.error);
    json["work"] = number(guide.work);
    json["kept"] = guide.stage == GuideStage::ON;
    json["cells"] = guide.guide ? guide.guide->lore().size() : 0;
    return json;
}

/// null: there were no chains.
Json chains_json(const ChainCounts& counts) {
    const std::uint64_t steps = counts.small + counts.large;
    if (steps == 0)
        return nullptr;
    const auto rate = [](std::uint64_t taken, std::uint64_t proposed) {
        return proposed > 0 ? Json(double(taken) / double(proposed)) : Json(nullptr);
    };
    return {{"steps", steps},
            {"large_steps", counts.large},
            {"small_acceptance", rate(counts.taken_small, counts.small)},
            {"large_acceptance", rate(counts.taken_large, counts.large)}};
}

/// Null where all tiles have the same number of samples.
Json adaptive_json(const RenderProgress& render) {
    const Film& film = render.film;
    if (!is_adaptive(film))
        return nullptr;
    const TileSpread spread = tile_spread(film);
    return {{"measure", name_of(render.round.measure)},
            {"expected_gain",
             expected_gain(render.round) > 0 ? Json(expected_gain(render.round)) : Json(nullptr)},
            {"tile_size", ADAPTIVE_TILE_SIZE},
            {"mean_spp", spread.mean},
            {"fewest_spp", spread.fewest},
            {"most_spp", spread.most}};
}

Json effects_json(const Effects& effects) {
    Json list = Json::array();
    for (const Effect& effect : effects.list)
        list.push_back({{"name", effect.name},
                        {"present", effect.present},
                        {"compiled", ((effects.mask | ~EFFECT_ALL) & effect.bit) != 0},
                        {"left_out", (effects.left_out & effect.bit) != 0},
                        {"witness", effect.witness}});
    return list;
}

/// Expressions as metadata, where there are any.
void add_paths(const PathPlan& paths, Metadata& metadata) {
    if (!paths.expression.empty())
        metadata.emplace_back("paths", paths.expression);
    for (const PathLayerOption& layer : paths.layers)
        metadata.emplace_back("paths." + layer.name, layer.expression);
}

} // namespace

std::optional<ErrorTarget> error_target(const Report& report) {
    const SamplingOptions& sampling = report.options.sampling;
    const std::optional<FilmError>& error = report.error.error;
    if (sampling.error)
        return ErrorTarget{"--error", *sampling.error, error && error->relative_rmse <= *sampling.error};
    if (sampling.denoised_error)
        return ErrorTarget{"--denoised-error", *sampling.denoised_error,
                           denoised_error_reached(report.render.film, report.render.denoised,
                                                  sampling.measure(), *sampling.denoised_error)};
    return std::nullopt;
}

std::string missed_text(const ErrorTarget& target) {
    return fmt::format("{} {:g} % is not reached", target.option, 100 * target.value);
}

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

std::string report_json(const Report& report) {
    const Render& render = report.render;
    const RenderCounts& counts = render.counts;
    Json json;
    json["version"] = CLRT_VERSION;
    json["command"] = command_text(report.options);
    json["integrator"] = name_of(report.options.transport.integrator);
    json["choice"] = choice_json(report.choice);
    json["width"] = render.film.width;
    json["height"] = render.film.height;
    json["spp"] = film_samples(render.film);
    json["passes"] = render.passes;
    json["resumed_at_spp"] = report.options.film_file.resume_path.empty()
                                 ? Json(nullptr)
                                 : Json(film_samples(render.film) - render.passes);
    json["first_sample"] = report.options.sampling.first_sample;
    json["adaptive"] = adaptive_json(render);
    json["portals"] = portals_json(report.scene.environment);
    json["slabs"] = crossed_slabs(report.scene, report.options);
    json["path_reuse"] = report.options.transport.path_reuse == Toggle::ON;
    json["light_samples"] = light_samples(report.scene, report.options);
    json["emission_rays"] = emission_json(report);
    json["guide"] = guide_json(render.guide);
    json["chains"] = chains_json(render.chains);
    json["sampler"] = name_of(report.options.sampling.sampler);
    json["texture_filter"] = name_of(report.effects.needed & ~report.effects.left_out & EFFECT_TEXTURE_FILTER
                                         ? TextureFilter::FOOTPRINT
                                         : TextureFilter::NONE);
    json["light_sampler"] = name_of(report.options.sampling.light_sampler);
    json["seed"] = report.options.sampling.seed;
    json["replicates"] = render.film.replicates;
    json["triangles"] = file_triangles(report.scene);
    json["seconds"] = {{"load", report.load_seconds},
                       {"pilots", report.pilots_seconds},
                       {"bvh", report.bvh.seconds},
                       {"compile", report.compile_seconds},
                       {"first_launch", render.first_launch_seconds},
                       {"render", render.run_seconds},
                       {"checks", render.check_seconds},
                       {"longest_launch", render.longest_launch_seconds},
                       {"total", report.total_seconds}};
    json["rays"] = {{"primary", counts.primary}, {"shadow", counts.shadow}, {"secondary", counts.secondary}};
    json["rays_per_second"] = rays_per_second(render);
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["error"] = error_report_json(report.error);
    json["denoised"] = denoised_json(render, verdict_on(report.error) == Verdict::UNTRUSTED);
    json["cut"] = cut_json(report.error.cut);
    json["blind_spots"] = blind_spots_json(report.error.blind_spots);
    json["unmet"] = unmet_json(report.error.unmet);
    json["stop"] = stop_json(report);
    json["nonfinite"] = {{"nan", counts.nan},
                         {"infinite", counts.infinite},
                         {"negative", counts.negative},
                         {"overflow", counts.overflow},
                         {"replayed", replayed_samples(report.causes)},
                         {"by_cause", causes_json(report.causes, report.scene, report.options)}};
    json["bad_samples"] = Json::array();
    for (const auto& [pixel, sample] : counts.bad_samples)
        json["bad_samples"].push_back({{"x", pixel % u32(report.options.film.size.x)},
                                       {"y", pixel / u32(report.options.film.size.x)},
                                       {"sample", sample}});
    json["exposure_ev"] = report.exposure_ev;
    json["device"] = device_json(report);
    json["devices"] = shares_json(render);
    json["bvh"] = {{"layout", name_of(report.bvh.layout)},
                   {"quality", name_of(report.bvh.quality)},
                   {"reason", report.bvh_reason},
                   {"depth", report.bvh.depth},
                   {"references", report.bvh.reference_count},
                   {"sah_cost", report.bvh.sah_cost},
                   {"bytes", 4 * (report.bvh.nodes.size() + report.bvh.leaves.size())}};
    json["load"] = {{"obj_bytes", report.scene.statistics.obj_bytes},
                    {"obj_seconds", report.scene.statistics.obj_seconds},
                    {"texture_seconds", report.scene.statistics.texture_seconds}};
    json["paths"] = paths_json(report.effects.paths);
    json["effects"] = effects_json(report.effects);
    json["lost_files"] = report.lost_files;
    json["empty_picture"] = report.empty_picture ? Json(*report.empty_picture) : Json(nullptr);
    json["notices"] = report.scene.notices;
    return json.dump(2) + "\n";
}

Metadata report_metadata(const Report& report) {
    const Render& render = report.render;
    const auto seconds = [](double value) { return fmt::format("{:.3f}", value); };
    Metadata metadata{{"version", CLRT_VERSION},
                      {"command", command_text(report.options)},
                      {"integrator", name_of(report.options.transport.integrator)},
                      {"device", device_text(report)},
                      {"driver", report.device.driver},
                      {"sampler", name_of(report.options.sampling.sampler)},
                      {"seed", std::to_string(report.options.sampling.seed)},
                      {"replicates", std::to_string(render.film.replicates)},
                      {"first_sample", std::to_string(report.options.sampling.first_sample)},
                      {"spp", std::to_string(film_samples(render.film))},
                      {"stop", render.stop_text},
                      {"seconds.load", seconds(report.load_seconds)},
                      {"seconds.pilots", seconds(report.pilots_seconds)},
                      {"seconds.bvh", seconds(report.bvh.seconds)},
                      {"seconds.compile", seconds(report.compile_seconds)},
                      {"seconds.first_launch", seconds(render.first_launch_seconds)},
                      {"seconds.render", seconds(render.run_seconds)},
                      {"effects", fmt::format("{}", fmt::join(names_of_effects(report.effects, true), ", "))},
                      {"effects_mask", fmt::format("{:#x}", report.effects.mask)},
                      {"nan", std::to_string(render.counts.nan)},
                      {"infinite", std::to_string(render.counts.infinite)},
                      {"negative", std::to_string(render.counts.negative)},
                      {"overflow", std::to_string(render.counts.overflow)}};
    if (const glm::dvec3 origin = position_origin(report.scene.normalisation); origin != glm::dvec3(0))
        metadata.emplace_back("P.origin", fmt::format("{} {} {}", origin.x, origin.y, origin.z));
    metadata.emplace_back("exposure_ev", fmt::format("{:g}", report.exposure_ev));
    add_facts(report, metadata);
    if (const HitSums& hits = render.hits; !hits.empty() && hits.most_samples < film_samples(render.film))
        metadata.emplace_back("hits.spp", std::to_string(hits.most_samples));
    if (is_adaptive(render.film)) {
        const TileSpread spread = tile_spread(render.film);
        metadata.emplace_back("adaptive", fmt::format("{} to {} spp", spread.fewest, spread.most));
    }
    add_paths(report.effects.paths, metadata);
    add_error_metadata(report.error, metadata);
    add_denoised_metadata(render, metadata);
    return metadata;
}

} // namespace clrt
