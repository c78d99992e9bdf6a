// SPDX-License-Identifier: Apache-2.0
// Ranges of sample numbers: what a film has, and what it lacks.
#pragma once

#include "film/film.h"

#include <cstdint>
#include <vector>

namespace clrt {

/// Adds a range to ranges that are in order and disjoint, of which it overlaps none; neighbours are joined.
void add_range(std::vector<SampleRange>& ranges, const SampleRange& range);

/// The next `count` samples that ranges (in order and disjoint) lack: those between them, then those behind
/// them; where there are none, those from number `first` on. In order and disjoint.
std::vector<SampleRange> next_ranges(const std::vector<SampleRange>& ranges, std::uint64_t first,
                                     std::uint64_t count);

/// Samples in all of them together.
std::uint64_t count_samples(const std::vector<SampleRange>& ranges);

} // namespace clrt
