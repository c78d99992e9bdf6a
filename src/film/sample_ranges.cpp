// SPDX-License-Identifier: Apache-2.0
#include "film/sample_ranges.h"

#include <algorithm>

namespace clrt {

void add_range(std::vector<SampleRange>& ranges, const SampleRange& range) {
    const auto behind = std::find_if(ranges.begin(), ranges.end(),
                                     [&](const SampleRange& each) { return each.first >= range.end; });
    const auto place = ranges.insert(behind, range);
    if (const auto next = place + 1; next != ranges.end() && next->first == range.end) {
        place->end = next->end;
        ranges.erase(next);
    }
    if (place != ranges.begin() && (place - 1)->end == place->first) {
        (place - 1)->end = place->end;
        ranges.erase(place);
    }
}

std::vector<SampleRange> next_ranges(const std::vector<SampleRange>& ranges, std::uint64_t first,
                                     std::uint64_t count) {
    std::vector<SampleRange> lacking;
    first = ranges.empty() ? first : ranges.front().end;
    const auto take = [&](std::uint64_t end) {
        if (first >= end || count == 0)
            return;
        end = std::min(end, first + count);
        lacking.push_back({first, end});
        count -= end - first;
    };
    for (const SampleRange& range : ranges) {
        take(range.first);
        first = std::max(first, range.end);
    }
    take(first + count);
    return lacking;
}

std::uint64_t count_samples(const std::vector<SampleRange>& ranges) {
    std::uint64_t count = 0;
    for (const SampleRange& range : ranges)
        count += range.end - range.first;
    return count;
}

} // namespace clrt
