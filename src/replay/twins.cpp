// SPDX-License-Identifier: Apache-2.0
#include "replay/twins.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clrt {

namespace {

bool same_choice(const TraceEvent& a, const TraceEvent& b) {
    return a.quantity == b.quantity && (!is_choice(a.quantity) || a.bits == b.bits);
}

} // namespace

double trace_difference(const SampleTrace& a, size_t at_a, const SampleTrace& b, size_t at_b) {
    const int values = quantity(a.events[at_a].quantity).values;
    double apart = 0, size = 0;
    for (int i = 0; i < values; ++i) {
        const double x = trace_value(a, a.events[at_a], i), y = trace_value(b, b.events[at_b], i);
        if (!std::isfinite(x) || !std::isfinite(y)) {
            if (x == y || (std::isnan(x) && std::isnan(y)))
                continue;
            return std::numeric_limits<double>::infinity();
        }
        apart = std::max(apart, std::abs(x - y));
        size = std::max({size, std::abs(x), std::abs(y)});
    }
    return size > 0 ? apart / size : 0;
}

TwinDifference compare_twins(const SampleTrace& a, const SampleTrace& b) {
    TwinDifference result;
    const size_t common = std::min(a.events.size(), b.events.size());
    for (size_t i = 0; i < common; ++i) {
        if (!same_choice(a.events[i], b.events[i])) {
            result.decision = i;
            return result;
        }
        if (is_choice(a.events[i].quantity))
            continue;
        const double difference = trace_difference(a, i, b, i);
        if (difference > result.largest_relative) {
            result.largest = i;
            result.largest_relative = difference;
        }
    }
    if (a.events.size() != b.events.size())
        result.decision = common;
    return result;
}

std::string decision_name(const SampleTrace& a, const SampleTrace& b, size_t index) {
    const bool in_both = index < a.events.size() && index < b.events.size();
    if (in_both && a.events[index].quantity == b.events[index].quantity)
        return quantity(a.events[index].quantity).name;
    return "end of the path";
}

} // namespace clrt
