// SPDX-License-Identifier: Apache-2.0
// Numbers of samples at which it pays to end a render. The first 2^k Sobol points of a replicate are even,
// each elementary box of the unit cube holds as many as any other, and the points after them fill the boxes
// one by one: until the next power of two some have one point more. With 9/8 of 2^k samples in every
// replicate the error is larger than with 2^k, by 5 % on average (cornell_box and colour_bleeding, 64 x 48
// pixels, 2^k from 8 to 64); with 3/2 of 2^k it is 17 to 26 % smaller, and with 2^(k+1) 40 %. Where light has
// more edges than Sobol points can make use of, no number is better than another. So these counts are good:
// replicates times 2^k, and 3/2 of that.
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
