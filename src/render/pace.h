// SPDX-License-Identifier: Apache-2.0
// By what steps a render goes, and how long it waits for one to end.
#pragma once

namespace clrt {

/// A signal does not wait longer for samples to end, seconds: they are dropped.
inline constexpr double LONGEST_WAIT = 3;
/// Launches take multiples of this many samples where they can: kernels simulate up to four at once.
inline constexpr double SAMPLE_GROUP = 4;
/// Samples may take this many times as long as those before them: other programs come to work, and adaptive
/// rounds go where paths are long.
inline constexpr double LARGEST_SLOWDOWN = 4;
/// Samples are begun when the time that is left is this part of what those before them took: they differ by
/// about as much, and those that are not done in time can be dropped.
inline constexpr double WORTH_BEGINNING = 0.8;
/// One of several devices hangs that tells nothing for so many seconds, and for so many times as long as its
/// samples should take. It tells something after every launch, of half a second where it can choose; what
/// lets the processor wait for longer is said in seconds, what makes launches long in times.
inline constexpr double SHORTEST_HANG = 30, LARGEST_LATENESS = 20;

} // namespace clrt
