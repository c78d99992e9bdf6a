// SPDX-License-Identifier: Apache-2.0
#include "render/error_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

/// "8.0": what percent_text writes before the sign.
std::string percent_number(double fraction) {
    const double value = 100 * fraction;
    const int digits = value >= 1 || !(value > 0) ? 1 : std::min(1 - int(std::floor(std::log10(value))), 9);
    return fmt::format("{:.{}f}", value, digits);
}

std::string error_line(const ErrorReport& report) {
    if (report.replicates == 0)
        return "none: no light is asked for";
    if (!report.error)
        return report.replicates < 2 ? "not known: it takes two samples a pixel or more"
               : report.has_backdrop ? "not known: what shows the scene is black"
                                     : "not known: the picture is black";
    const FilmError& error = *report.error;
    if (!(error.relative_rmse > 0))
        return "none: all replicates give the same picture";
    const char* const picture = report.has_backdrop ? "scene" : "picture";
    std::string text = fmt::format(
        "{} {}", percent_text(error.relative_rmse),
        report.measure == ErrorMeasure::MSE
            ? fmt::format("of the {}'s mean brightness (root of mean square)", picture)
            : fmt::format("relative to each pixel's brightness (root of mean square over the {})", picture));
    if (verdict_on(report) == Verdict::UNTRUSTED)
        return text + ", as far as can be told";
    if (error.low && error.high)
        return text + fmt::format("; with 95 % confidence {} to {}", percent_number(*error.low),
                                  percent_text(*error.high));
    return text + "; no interval: it takes four replicates";
}

/// The error by the measure that nobody has asked for.
std::string other_line(const ErrorReport& report) {
    if (!report.other_error || !(report.other_error->relative_rmse > 0))
        return "";
    return report.measure == ErrorMeasure::MSE
               ? fmt::format("relative {} relative to each pixel's brightness\n",
                             percent_text(report.other_error->relative_rmse))
               : fmt::format("absolute {} of the mean brightness\n",
                             percent_text(report.other_error->relative_rmse));
}

/// What the error is stated over, where the picture shows more than the scene.
std::string scene_line(const ErrorReport& report) {
    if (!report.error || !report.has_backdrop)
        return "";
    return fmt::format(
        "scene    the error is that of the {:.1f} % of the pixels that show it; over all pixels {}\n",
        100 * *report.scene_share,
        report.whole_error ? percent_text(report.whole_error->relative_rmse) : "not known");
}

/// One sentence by one rule: verdict_on.
std::string verdict_line(const ErrorReport& report) {
    switch (verdict_on(report)) {
    case Verdict::NONE:
        return "";
    case Verdict::UNTRUSTED:
        return "verdict  do not trust the error: a few bright samples decide it, and more are still to "
               "come\n";
    case Verdict::TRUSTED:
        return "verdict  trust the error\n";
    case Verdict::INCOMPLETE:
        break;
    }
    std::vector<std::string> missing, spots;
    if (report.cut.paths > 0)
        missing.emplace_back("long paths are cut");
    for (const BlindSpot& spot : report.blind_spots)
        spots.push_back(spot.paths);
    if (!spots.empty())
        missing.push_back(fmt::format("not seen: {}", fmt::join(spots, ", ")));
    if (report.unmet)
        missing.push_back(fmt::format("hardly ever met: {}", report.unmet->paths));
    return fmt::format("verdict  trust the error for what was sampled, which is not all: {}\n",
                       fmt::join(missing, "; "));
}

std::string price_line(const ErrorReport& report) {
    if (verdict_on(report) == Verdict::UNTRUSTED)
        return "half the error: nobody knows while the error cannot be trusted";
    if (!report.price)
        return "half the error: not known, more samples hardly change it";
    return fmt::format("half the error takes {} spp, {:.1f} s more, and comes to {}", report.price->samples,
                       report.price->seconds, percent_text(report.price->relative_rmse));
}

/// What the error that was asked for still takes.
std::string target_line(const ErrorReport& report) {
    if (!report.target_price || verdict_on(report) == Verdict::UNTRUSTED)
        return "";
    const ErrorPrice& price = *report.target_price;
    return fmt::format("target   takes {} spp, {:.1f} s more, with {:.0f} % confidence {:.1f} {}\n",
                       price.samples, price.seconds, 100 * FORECAST_CONFIDENCE, price.low_seconds,
                       price.high_seconds ? fmt::format("to {:.1f} s", *price.high_seconds) : "s or more");
}

} // namespace

std::string percent_text(double fraction) {
    return percent_number(fraction) + " %";
}

std::string gain_text(const AdaptiveRound& round) {
    const double gain = expected_gain(round);
    const char* const measure = round.measure == ErrorMeasure::MSE ? "mean squared" : "relative squared";
    const bool pays = round.gain[0] >= WORTHWHILE_GAIN || round.gain[1] >= WORTHWHILE_GAIN;
    return fmt::format("{:.2f} times less {} error is expected of as many samples: {}", gain, measure,
                       pays ? "more of them go where the picture is noisy"
                            : "not worth it, they go everywhere alike");
}

std::string format_error_report(const ErrorReport& report) {
    std::string text = fmt::format("error    {}\n", error_line(report)) + other_line(report) +
                       scene_line(report) + verdict_line(report) + format_cut(report.cut) +
                       format_blind_spots(report.blind_spots) + format_unmet(report.unmet);
    if (report.error && report.error->relative_rmse > 0)
        text += fmt::format("price    {}\n", price_line(report));
    text += target_line(report);
    return text;
}

std::string format_error_details(const ErrorReport& report) {
    std::string text;
    if (report.slope)
        text += fmt::format(
            "slope    {:.2f} +- {:.2f} from {} to {} spp: twice the samples, {:.2f} times the error\n",
            report.slope->slope, report.slope->reach, report.slope->first_samples, report.slope->last_samples,
            std::exp2(report.slope->slope));
    if (report.price)
        text += fmt::format("forecast slope {:.2f}, {}\n", report.price->slope,
                            report.price->measured ? "measured and usual" : "the usual one");
    if (!report.spread)
        return text;
    const ErrorSpread& spread = *report.spread;
    text += fmt::format("worst    {} of the picture's mean in the {} x {} tile at {},{}\n",
                        percent_text(spread.worst_tile), ERROR_TILE_SIZE, ERROR_TILE_SIZE,
                        report.window_x + spread.tile_x, report.window_y + spread.tile_y);
    return text +
           fmt::format(
               "tails    {:.0f} % of the squared error is in the noisiest {} of the pixels; {:.0f} % rests "
               "on what one replicate alone saw, which leaves it uncertain by {} (trusted up to {:.0f} "
               "%)\n",
               100 * spread.tail_share, spread.tail_pixels == 1 ? "one" : "thousandth",
               100 * spread.once_share, percent_text(spread.once_error),
               100 * ErrorSpread::LARGEST_ONCE_ERROR);
}

} // namespace clrt
