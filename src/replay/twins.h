// SPDX-License-Identifier: Apache-2.0
// Two records of one sample, in single and in double precision: how far they go the same way.
#pragma once

#include "replay/replay.h"

#include <optional>
#include <string>

namespace clrt {

/// Where two records of a sample differ. Indices are the same in both up to the decision.
struct TwinDifference {
    static constexpr size_t NONE = ~size_t(0);
    size_t decision = NONE;      ///< first event where a choice differs: from there on they are two paths
    size_t largest = NONE;       ///< before it: the event whose numbers differ most
    double largest_relative = 0; ///< by how much, as trace_difference says
    bool has_decision() const { return decision != NONE; }
    bool has_largest() const { return largest != NONE; }
};

/// Largest difference of the numbers of an event over the largest magnitude in either; 0 where both are the
/// same or not finite alike, infinite where only one is not finite.
double trace_difference(const SampleTrace& a, size_t at_a, const SampleTrace& b, size_t at_b);

/// Compares two records event by event.
TwinDifference compare_twins(const SampleTrace& a, const SampleTrace& b);

/// What was decided differently, in words for a table: "triangle", "light visible", ...; a path that ends in
/// one record only is named after the choice that ended it.
std::string decision_name(const SampleTrace& a, const SampleTrace& b, size_t index);

} // namespace clrt
