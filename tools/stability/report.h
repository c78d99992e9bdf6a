// SPDX-License-Identifier: Apache-2.0
// What clrt-stability found: lines, JSON and a page.
#pragma once

#include "stability/catalogue.h"
#include "stability/render_costs.h"
#include "stability/stability_options.h"

#include <string>
#include <vector>

namespace clrt {

/// A robust choice with its measured time.
struct ChoiceCost {
    const RobustChoice* choice = nullptr;
    ProbeTime time;
    std::string error; ///< what it threw, and then there is no time; empty: nothing
};

struct StabilityReport {
    DeviceInfo device;
    Tier tier = Tier::QUICK;
    std::vector<std::string> command;
    std::vector<CaseResult> cases;
    std::vector<ChoiceCost> costs;
    std::vector<RenderCost> render_costs;
    double seconds = 0;
};

/// Whether costs are in CPU seconds (device_seconds in probe_set.h).
bool takes_cpu_seconds(const StabilityReport& report);

/// The figure that a choice's case shows, or null where the case did not run.
const Figure* figure_of(const StabilityReport& report, const RobustChoice& choice);

/// Number of cases that do not hold.
size_t count_broken(const StabilityReport& report);

/// Number of timings that failed.
size_t count_failed_costs(const StabilityReport& report);

/// The head line over the lines of format_case.
std::string format_case_head();

/// A line for each figure of a case.
std::string format_case(const CaseResult& result);

/// The tables of costs; empty without costs.
std::string format_costs(const StabilityReport& report);

/// "38 of 38 cases hold, quick tier, 52.1 s", with the number of timings that failed, if any.
std::string format_summary(const StabilityReport& report);

/// The catalogue with set-ups, oracles and what waits.
std::string format_catalogue();

/// All figures, SI units.
std::string report_json(const StabilityReport& report);

/// One HTML page that needs nothing else.
std::string report_page(const StabilityReport& report);

} // namespace clrt
