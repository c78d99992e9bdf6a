// SPDX-License-Identifier: Apache-2.0
#include "render/error_report.h"

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

/// "0.00123 %": three digits, never in exponent form.
std::string percent(double fraction) {
    const double value = 100 * fraction;
    return fmt::format("{:.{}f} %", value, value >= 0.1 ? 2 : 5);
}

std::string error_line(const ErrorReport& report) {
    if (!report.error)
        return report.replicates < 2 ? "not known: fewer than two replicates have samples"
               : report.has_backdrop ? "not known: what shows the scene is black"
                                     : "not known: the picture is black";
    const FilmError& error = *report.error;
    std::string text = percent(error.relative_rmse) + " relative RMSE";
    if (error.low && error.high)
        text += fmt::format(" (95 %: {} to {})", percent(*error.low), percent(*error.high));
    else if (error.relative_rmse > 0)
        text += " (no interval: it takes four replicates)";
    if (report.slope)
        text += fmt::format(", slope {:.2f} +- {:.2f} from {} to {} spp", report.slope->slope,
                            report.slope->reach, report.slope->first_samples, report.slope->last_samples);
    return text;
}

/// What the error is stated over, where the picture shows more than the scene.
std::string scene_line(const ErrorReport& report) {
    if (!report.error || !report.has_backdrop)
        return "";
    return fmt::format(
        "scene    the error is that of the {:.1f} % of the pixels that show it; over all pixels {}\n",
        100 * *report.scene_share,
        report.whole_error ? percent(report.whole_error->relative_rmse) : "not known");
}

std::string price_line(const ErrorReport& report) {
    if (!report.price)
        return "half the error: not known, more samples hardly change it";
    const ErrorPrice& price = *report.price;
    return fmt::format(
        "{} takes {:.1f} times the samples, {:.1f} s more (extrapolated by {} slope of {:.2f})",
        percent(price.relative_rmse), price.factor, price.seconds,
        price.measured ? "the measured" : "the usual", price.slope);
}

/// What the error is worth.
std::string verdict(const ErrorReport& report, const ErrorSpread& spread) {
    if (!spread.usable())
        return "do not believe the error, rare bright samples are still to come";
    if (is_complete(report))
        return "the error can be believed";
    std::string text = "the error covers what was sampled";
    if (report.cut.paths > 0)
        text += ", not what was cut";
    for (const BlindSpot& spot : report.blind_spots)
        text += (&spot == &report.blind_spots.front() ? "; not seen: " : ", ") + spot.paths;
    return text;
}

} // namespace

ErrorReport make_error_report(const RenderProgress& render, const BiasSources& bias, int x, int y) {
    ErrorReport report;
    report.cut = cut_paths(render, bias.cut_radiance);
    report.blind_spots = bias.blind_spots;
    report.replicates = int(ReplicateMeans(render.film).count());
    report.window_x = x;
    report.window_y = y;
    const std::optional<SquaredError> squared = film_squared_error(render.film);
    if (!squared)
        return report;
    report.error = relative_error(*squared);
    report.has_backdrop = has_backdrop(render.film);
    report.whole_error = report.has_backdrop ? film_error(render.film, ErrorPixels::ALL) : report.error;
    if (const std::optional<size_t> shown = film_shown_pixels(render.film))
        report.scene_share = double(*shown) / double(render.film.shown.size());
    std::vector<SquaredError> history = render.history;
    if (history.empty() || history.back().samples < squared->samples)
        history.push_back(*squared);
    report.slope = error_slope(history);
    try {
        report.spread = film_error_spread(render.film);
    } catch (const std::bad_alloc&) { // where the error sits is not worth the picture
    }
    if (report.error)
        report.price = price_of_half(*report.error, report.slope, render.seconds);
    return report;
}

bool is_complete(const ErrorReport& report) {
    return report.cut.paths == 0 && report.blind_spots.empty();
}

std::string format_error_report(const ErrorReport& report) {
    std::string text = fmt::format("error    {}\n", error_line(report)) + scene_line(report) +
                       format_cut(report.cut) + format_blind_spots(report.blind_spots);
    if (!report.error || !report.spread)
        return text;
    const ErrorSpread& spread = *report.spread;
    text += fmt::format("price    {}\n", price_line(report));
    text += fmt::format("worst    {} of the picture's mean in the {} x {} tile at {},{}\n",
                        percent(spread.worst_tile), ERROR_TILE_SIZE, ERROR_TILE_SIZE,
                        report.window_x + spread.tile_x, report.window_y + spread.tile_y);
    text += fmt::format(
        "tails    the noisiest {} of the pixels hold {:.0f} % of the squared error; {:.0f} % was seen by one "
        "replicate alone, which makes it uncertain by {:.1f} %: {}\n",
        spread.tail_pixels == 1 ? "one" : "thousandth", 100 * spread.tail_share, 100 * spread.once_share,
        100 * spread.once_error, verdict(report, spread));
    return text;
}

Json error_report_json(const ErrorReport& report) {
    Json json = interval_json(report.error);
    json["over"] = report.has_backdrop ? "scene" : "picture";
    json["scene_share"] = optional_number(report.scene_share);
    json["whole_picture"] = interval_json(report.whole_error);
    json["complete"] = is_complete(report);
    json["slope"] = nullptr;
    if (report.slope)
        json["slope"] = {{"value", report.slope->slope},
                         {"low", report.slope->slope - report.slope->reach},
                         {"high", report.slope->slope + report.slope->reach},
                         {"first_spp", report.slope->first_samples},
                         {"last_spp", report.slope->last_samples}};
    json["half"] = nullptr;
    if (report.price)
        json["half"] = {{"rel_rmse", report.price->relative_rmse},
                        {"samples_factor", report.price->factor},
                        {"seconds", report.price->seconds},
                        {"slope", report.price->slope},
                        {"slope_measured", report.price->measured}};
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
    if (!report.error)
        return;
    add("error", report.error->relative_rmse);
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
