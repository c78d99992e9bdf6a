// SPDX-License-Identifier: Apache-2.0
#include "render/error_report.h"

#include "render/good_counts.h"

#include <fmt/format.h>
#include <new>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

Json optional_number(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// An error with its interval.
Json interval_json(const std::optional<FilmError>& error) {
    return {{"rel_rmse", error ? Json(error->relative_rmse) : Json(nullptr)},
            {"low", error ? optional_number(error->low) : Json(nullptr)},
            {"high", error ? optional_number(error->high) : Json(nullptr)}};
}

Json optional_price(const std::optional<ErrorPrice>& price) {
    return price ? price_json(*price) : Json(nullptr);
}

/// The errors by all measures.
Json measures_json(const ErrorReport& report) {
    Json json;
    for (const auto& row : NAMES<ErrorMeasure>)
        json[row.name] = interval_json(row.value == report.measure ? report.error : report.other_error);
    return json;
}

} // namespace

Json price_json(const ErrorPrice& price) {
    return {{"rel_rmse", price.relative_rmse},
            {"spp", price.samples},
            {"spp_low", price.low_samples},
            {"spp_high", price.high_samples ? Json(*price.high_samples) : Json(nullptr)},
            {"samples_factor", price.factor},
            {"seconds", price.seconds},
            {"seconds_low", price.low_seconds},
            {"seconds_high", optional_number(price.high_seconds)},
            {"confidence", FORECAST_CONFIDENCE},
            {"slope", price.slope},
            {"slope_measured", price.measured}};
}

ErrorReport make_error_report(const RenderProgress& render, const BiasSources& bias, int x, int y,
                              const std::optional<double>& target) {
    ErrorReport report;
    report.cut = cut_paths(render, bias.cut_radiance);
    report.blind_spots = bias.blind_spots;
    report.unmet = unmet_light(render, bias.hits);
    report.replicates = int(ReplicateMeans(render.film).count());
    report.window_x = x;
    report.window_y = y;
    report.measure = render.round.measure;
    const std::optional<SquaredError> squared =
        film_squared_error(render.film, ErrorPixels::SCENE, 1, report.measure);
    if (!squared)
        return report;
    report.error = relative_error(*squared);
    report.other_error = film_error(render.film, ErrorPixels::SCENE, other_measure(report.measure));
    report.has_backdrop = has_backdrop(render.film);
    report.whole_error =
        report.has_backdrop ? film_error(render.film, ErrorPixels::ALL, report.measure) : report.error;
    if (const std::optional<size_t> shown = film_shown_pixels(render.film))
        report.scene_share = double(*shown) / double(render.film.shown.size());
    // Between doublings samples are not even, and the error tells nothing about its slope.
    std::vector<SquaredError> doublings = render.history;
    const bool is_new = doublings.empty() || doublings.back().samples < squared->samples;
    if (is_new && is_doubling(squared->samples, report.replicates))
        doublings.push_back(*squared);
    report.slope = error_slope(doublings);
    try {
        report.spread = film_error_spread(render.film, report.measure);
    } catch (const std::bad_alloc&) { // where the error sits is not worth the picture
    }
    report.price = price_of_half(doublings, *squared, report.replicates, render.seconds);
    if (target && report.error && report.error->relative_rmse > *target)
        report.target_price = price_of_error(*target, doublings, *squared, report.replicates, render.seconds);
    return report;
}

Verdict verdict_on(const ErrorReport& report) {
    if (!report.error)
        return Verdict::NONE;
    if (report.spread && !report.spread->usable())
        return Verdict::UNTRUSTED;
    return is_complete(report) ? Verdict::TRUSTED : Verdict::INCOMPLETE;
}

const char* verdict_name(Verdict verdict) {
    switch (verdict) {
    case Verdict::TRUSTED:
        return "trusted";
    case Verdict::INCOMPLETE:
        return "incomplete";
    case Verdict::UNTRUSTED:
        return "untrusted";
    case Verdict::NONE:
        break;
    }
    return "none";
}

bool is_complete(const ErrorReport& report) {
    return report.cut.paths == 0 && report.blind_spots.empty() && !report.unmet;
}

Json error_report_json(const ErrorReport& report) {
    Json json = interval_json(report.error);
    json["measure"] = name_of(report.measure);
    json["by_measure"] = measures_json(report);
    json["over"] = report.has_backdrop ? "scene" : "picture";
    json["scene_share"] = optional_number(report.scene_share);
    json["whole_picture"] = interval_json(report.whole_error);
    json["complete"] = is_complete(report);
    json["verdict"] = verdict_name(verdict_on(report));
    json["slope"] = nullptr;
    if (report.slope)
        json["slope"] = {{"value", report.slope->slope},
                         {"low", report.slope->slope - report.slope->reach},
                         {"high", report.slope->slope + report.slope->reach},
                         {"first_spp", report.slope->first_samples},
                         {"last_spp", report.slope->last_samples}};
    json["half"] = optional_price(report.price);
    json["target"] = optional_price(report.target_price);
    json["worst_tile"] = nullptr;
    json["tails"] = nullptr;
    if (report.spread) {
        json["worst_tile"] = {{"rel_rmse", report.spread->worst_tile},
                              {"x", report.window_x + report.spread->tile_x},
                              {"y", report.window_y + report.spread->tile_y},
                              {"size", ERROR_TILE_SIZE}};
        json["tails"] = {{"pixels", report.spread->tail_pixels},
                         {"share", report.spread->tail_share},
                         {"once_share", report.spread->once_share},
                         {"once_error", report.spread->once_error},
                         {"usable", report.spread->usable()}};
    }
    return json;
}

void add_error_metadata(const ErrorReport& report, Metadata& metadata) {
    const auto add = [&](const char* name, double value) {
        metadata.emplace_back(name, fmt::format("{:.6g}", value));
    };
    metadata.emplace_back("cut.paths", std::to_string(report.cut.paths));
    if (report.cut.light_bound)
        add("cut.light_bound", *report.cut.light_bound);
    std::vector<std::string> spots;
    for (const BlindSpot& spot : report.blind_spots)
        spots.push_back(spot.paths);
    metadata.emplace_back("blind_spots", fmt::format("{}", fmt::join(spots, ", ")));
    if (report.unmet) {
        metadata.emplace_back("unmet", report.unmet->paths);
        add("unmet.light_bound", report.unmet->light_bound);
    }
    if (!report.error)
        return;
    metadata.emplace_back("error.measure", name_of(report.measure));
    add("error", report.error->relative_rmse);
    if (report.other_error)
        add(report.measure == ErrorMeasure::MSE ? "error.by_relative" : "error.by_mse",
            report.other_error->relative_rmse);
    metadata.emplace_back("error.over", report.has_backdrop ? "scene" : "picture");
    if (report.whole_error)
        add("error.whole_picture", report.whole_error->relative_rmse);
    if (report.error->low && report.error->high) {
        add("error.low", *report.error->low);
        add("error.high", *report.error->high);
    }
    if (report.slope)
        add("error.slope", report.slope->slope);
    if (report.price)
        add("error.half_seconds", report.price->seconds);
    if (report.spread) {
        add("error.worst_tile", report.spread->worst_tile);
        add("error.tail_share", report.spread->tail_share);
        add("error.once_share", report.spread->once_share);
        add("error.once_error", report.spread->once_error);
        metadata.emplace_back("error.usable", report.spread->usable() ? "true" : "false");
    }
}

} // namespace clrt
