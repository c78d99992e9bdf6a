// SPDX-License-Identifier: Apache-2.0
#include "app/look_option.h"

namespace clrt {

namespace {

/// Stops: 2^100 times any float radiance still is a double.
constexpr double LARGEST_EXPOSURE = 100;

bool is_exposure(double ev) {
    return ev >= -LARGEST_EXPOSURE && ev <= LARGEST_EXPOSURE;
}

} // namespace

const char* const EXPOSURE_HELP =
    "brighten 8-bit pictures by 2^EV; auto: as the picture's tones ask for, auto+1 a stop more (default 0)";
const char* const TONEMAP_HELP =
    "curve of 8-bit pictures: none, reinhard, aces, filmic (long shoulder) or agx (bright colours go to "
    "white) (default none)";

void apply_exposure(Options& options, const OptionValue& value) {
    const std::string expected = "stops from -100 to 100, auto, or auto with a sign and stops such as auto+1";
    const std::string word = "auto";
    options.output.auto_exposure = value.text.compare(0, word.size(), word) == 0;
    OptionValue stops = value;
    if (options.output.auto_exposure)
        stops.text = value.text == word ? "+0" : value.text.substr(word.size());
    if (options.output.auto_exposure && stops.text[0] != '+' && stops.text[0] != '-')
        reject_value(value, expected);
    options.output.exposure_ev = parse_number(stops, expected, is_exposure);
}

void apply_tonemap(Options& options, const OptionValue& value) {
    options.output.tonemap = parse_choice<Tonemap>(value);
}

} // namespace clrt
