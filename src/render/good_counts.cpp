// SPDX-License-Identifier: Apache-2.0
#include "render/good_counts.h"

namespace clrt {

std::uint64_t next_doubling(std::uint64_t samples, int replicates) {
    auto count = std::uint64_t(replicates);
    while (count <= samples)
        count *= 2;
    return count;
}

bool is_doubling(std::uint64_t samples, int replicates) {
    return samples > 0 && next_doubling(samples - 1, replicates) == samples;
}

std::uint64_t next_good_count(std::uint64_t samples, int replicates) {
    const std::uint64_t doubling = next_doubling(samples, replicates);
    const std::uint64_t between = doubling / 4 * 3; // of the doubling before and this one
    const bool is_whole = doubling >= 4 * std::uint64_t(replicates);
    return is_whole && between > samples ? between : doubling;
}

bool is_good_count(std::uint64_t samples, int replicates) {
    return samples > 0 && next_good_count(samples - 1, replicates) == samples;
}

} // namespace clrt
