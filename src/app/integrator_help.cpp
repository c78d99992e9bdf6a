// SPDX-License-Identifier: Apache-2.0
#include "app/integrator_help.h"

#include "app/option_values.h"
#include "options/transport_options.h"

#include <fmt/format.h>
#include <iterator>

namespace clrt {

namespace {

const Integrator DEFAULT_INTEGRATOR = TransportOptions{}.integrator;
const char* const CHOICE_HELP = "path, path+light or bdpt, as small pilot pictures find least noise for the "
                                "work; where none is named, others than path are tried only if its own is "
                                "noisy or there may be caustics, and not with --first-sample";

/// Calls `say` with every row; those that simulate most come first.
template <typename Say>
void for_each_row(const Say& say) {
    for (auto row = std::rbegin(INTEGRATOR_ROWS); row != std::rend(INTEGRATOR_ROWS); ++row)
        say(*row);
}

} // namespace

std::string integrator_choices() {
    std::vector<std::string> choices;
    for_each_row(
        [&](const IntegratorRow& row) { choices.push_back(fmt::format("{} ({})", row.name, row.help)); });
    choices.push_back(fmt::format("{} ({})", CHOSEN_INTEGRATOR, CHOICE_HELP));
    return fmt::format("{} (default {})", alternatives(choices), CHOSEN_INTEGRATOR);
}

std::string depth_defaults() {
    const IntegratorRow& usual = integrator_row(DEFAULT_INTEGRATOR);
    std::string text = fmt::format("default {}", usual.depth.usual);
    for_each_row([&](const IntegratorRow& row) {
        const bool is_fixed = !(row.takes & TAKES_MAX_DEPTH);
        if (is_fixed || row.depth.usual != usual.depth.usual)
            text += fmt::format(", {}{} {}", row.name, is_fixed ? " always" : "", row.depth.usual);
    });
    return text;
}

std::string takers(IntegratorOption option) {
    return fmt::format("{}: ", fmt::join(integrators_with(option), ", "));
}

} // namespace clrt
