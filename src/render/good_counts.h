// SPDX-License-Identifier: Apache-2.0
// Numbers of samples at which it pays to end a render. The first 2^k Sobol points of a replicate are even,
// each elementary box of the unit cube holds as many as any other, and the points after them fill the boxes
// one by one: until the next power of two some have one point more. The error falls in steps: with nine
// instead of eight samples in every replicate it is larger (on a Cornell box by 4 %, with ten by 1 %), with
// twelve it is smaller again, since a half of the next power of two is even by itself. So these counts are
// good: replicates times 2^k, and 3/2 of that.
#pragma once

#include <cstdint>

namespace clrt {

/// The smallest replicates times a power of two that is larger than `samples`.
std::uint64_t next_doubling(std::uint64_t samples, int replicates);
/// Whether so many samples are replicates times a power of two.
bool is_doubling(std::uint64_t samples, int replicates);

/// The smallest good count that is larger than `samples`.
std::uint64_t next_good_count(std::uint64_t samples, int replicates);
/// Whether a render of so many samples a pixel is as even as its replicates can be.
bool is_good_count(std::uint64_t samples, int replicates);

} // namespace clrt
