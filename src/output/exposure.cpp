// SPDX-License-Identifier: Apache-2.0
#include "output/exposure.h"

#include "colour.h"
#include "output/tonemap.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

/// The share of pixels at either end that Reinhard leaves out when he looks for the darkest and the
/// brightest: fireflies, a lamp's bulb, the gap below a door.
constexpr double SHARE_LEFT_OUT = 0.01;
/// Steps of a stop that results are rounded to, so that they can be read and typed; a hundredth changes no
/// 8-bit value by more than 1.
constexpr double STEPS_PER_STOP = 100;

double rounded(double stops) {
    return std::round(STEPS_PER_STOP * stops) / STEPS_PER_STOP;
}

/// log2 of the luminance of every pixel that shows light.
std::vector<float> log_luminances(const std::vector<float>& rgb) {
    std::vector<float> logs;
    for (size_t i = 0; i + 2 < rgb.size(); i += 3) {
        const double y = luminance(glm::dvec3(rgb[i], rgb[i + 1], rgb[i + 2]));
        if (y > 0 && std::isfinite(y))
            logs.push_back(float(std::log2(y)));
    }
    return logs;
}

/// The value that so many are below.
double ranked(std::vector<float>& values, size_t rank) {
    const auto place = values.begin() + std::ptrdiff_t(rank);
    std::nth_element(values.begin(), place, values.end());
    return double(*place);
}

} // namespace

double auto_exposure_ev(const std::vector<float>& rgb) {
    std::vector<float> logs = log_luminances(rgb);
    if (logs.empty())
        return 0;
    const size_t left_out = size_t(SHARE_LEFT_OUT * double(logs.size()));
    const double darkest = ranked(logs, left_out), brightest = ranked(logs, logs.size() - 1 - left_out);
    double mean = 0;
    for (const float log : logs)
        mean += std::clamp(double(log), darkest, brightest) / double(logs.size());

    // How far above the middle of both the mean lies, from 0 to 1; a picture of one tone is in the middle.
    const double range = brightest - darkest;
    const double place = range > 0 ? std::clamp((2 * mean - darkest - brightest) / range, 0.0, 1.0) : 0;
    const double key = MIDDLE_GREY * std::pow(4, place);
    return rounded(std::log2(key) - mean);
}

double chosen_exposure_ev(const OutputOptions& options, const std::vector<float>& rgb) {
    return options.auto_exposure ? rounded(auto_exposure_ev(rgb) + options.exposure_ev) : options.exposure_ev;
}

std::string exposure_hint(const OutputOptions& options, const std::vector<float>& rgb) {
    const double stops = auto_exposure_ev(rgb);
    const bool is_mapped = stops < 0 && options.tonemap != Tonemap::NONE;
    if (!(std::abs(stops) >= STRIKING_STOPS) || is_mapped || 2 * log_luminances(rgb).size() < rgb.size() / 3)
        return "";
    return fmt::format("8-bit pictures come out {}: --exposure auto would show this one with {:+g} stops",
                       stops > 0 ? "dark" : "bright", stops);
}

std::string exposure_notice(double exposure_ev) {
    return fmt::format("exposure by the picture's tones: --exposure {:g}", exposure_ev);
}

} // namespace clrt
