// SPDX-License-Identifier: Apache-2.0
#include "stability/stability_case.h"

#include <algorithm>
#include <chrono>
#include <exception>

namespace clrt {

const char* build_name(Build build) {
    constexpr const char* NAMES[] = {"naive", "single", "fast", "double"};
    return NAMES[static_cast<size_t>(build)];
}

bool Figure::holds() const {
    const Figure& self = *this;
    return self[Build::SINGLE].tried > 0 && self[Build::SINGLE].value <= limit &&
           self[Build::DOUBLE].value <= limit;
}

size_t CaseRun::count(double quick, double night, double at_length) const {
    const double counts[] = {quick, night, at_length};
    return static_cast<size_t>(counts[static_cast<size_t>(tier)]);
}

std::vector<Build> CaseRun::builds() const {
    std::vector<Build> builds(std::begin(ALL_BUILDS), std::end(ALL_BUILDS));
    if (!device.info.fp64)
        builds.pop_back();
    return builds;
}

Figure& CaseRun::figure(std::string quantity, double limit) {
    figures_.push_back({std::move(quantity), limit, {}});
    return figures_.back();
}

bool CaseResult::holds() const {
    return error.empty() && !figures.empty() &&
           std::all_of(figures.begin(), figures.end(), [](const Figure& figure) { return figure.holds(); });
}

CaseResult run_case(const StabilityCase& subject, const ProbeDevice& device, Tier tier) {
    const auto start = std::chrono::steady_clock::now();
    CaseRun run(device, tier);
    CaseResult result;
    result.subject = &subject;
    try {
        subject.run(run);
    } catch (const std::exception& error) {
        result.error = error.what();
    }
    result.figures = run.figures();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

} // namespace clrt
