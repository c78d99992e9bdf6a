// SPDX-License-Identifier: Apache-2.0
// What a render has come to and goes on from: its film, and the counts and errors that belong to it.
#pragma once

#include "film/adaptive.h"
#include "film/film.h"
#include "film/film_error.h"
#include "guide/guide_progress.h"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace clrt {

/// Counts of a run (kernels/shared/render_types.h).
struct RenderCounts {
    std::uint64_t primary = 0, secondary = 0, shadow = 0; ///< rays
    std::uint64_t nan = 0, infinite = 0, negative = 0, overflow = 0;
    /// Paths that --max-depth cut, and the sum of their weights in units of 1 / CUT_WEIGHT_UNITS.
    std::uint64_t cut_paths = 0, cut_weight = 0;
    /// Pixels of this run that take emission from camera rays of its own (EMISSION_BY_RAYS).
    std::uint64_t outline_pixels = 0;
    /// Addresses of the first bad samples: pixel (y width + x of the whole picture) and sample.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> bad_samples;
    /// How many bad samples a pixel has, by pixel; only those that have some.
    std::map<std::uint32_t, std::uint64_t> bad_pixels;
    std::uint64_t bad() const { return nan + infinite + negative + overflow; }
    std::uint64_t rays() const { return primary + secondary + shadow; }
    /// Adds another run's counts.
    void add(const RenderCounts& other);
};

/// What a render has when it starts anew, and what one that goes on from a film file starts with.
struct RenderProgress {
    Film film;
    RenderCounts counts;
    std::vector<Film> path_layers;     ///< of each of summed_layers() in one replicate
    std::vector<SquaredError> history; ///< errors at doublings, for the slope
    AdaptiveRound round;               ///< of an adaptive render: the present one; of all, its measure
    GuideProgress guide;               ///< of a render that may guide paths
    double seconds = 0;                ///< of rendering them
};

} // namespace clrt
