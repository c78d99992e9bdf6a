// SPDX-License-Identifier: Apache-2.0
// What a denoiser is given: one half of the replicates and what it sees first. The other half knows nothing
// of it, and so can judge what becomes of it.
#pragma once

#include "film/film.h"
#include "film/hit_sums.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Values of a picture, pixel by pixel.
using Pixels = std::vector<float>;

/// One half of the replicates.
struct HalfPicture {
    int width = 0, height = 0;
    Pixels mean;                   ///< radiance, r, g, b
    std::array<Pixels, 2> quarter; ///< the same of the first and the last of its replicates
    /// Of the primary hits of the half's samples: albedo (r, g, b) and normal (x, y, z) as means over all
    /// samples, misses as 0; mean position of the hits; share of the samples that hit something.
    Pixels albedo, normal, position, share;
    /// 1 where primary hits emit as much as most of the radiance, else 0: lamps, and pixels that their rims
    /// cross.
    std::vector<char> lit;
};

/// Replicates, at least, of what is denoised: two in each half.
constexpr int FEWEST_DENOISED_REPLICATES = 4;

/// Why a film cannot be denoised, as the end of a sentence; nothing where it can.
std::optional<std::string> denoise_obstacle(const Film& film, const HitSums& hits);

/// A half of a film that can: the first or the last of its replicates.
HalfPicture half_picture(const Film& film, const HitSums& hits, size_t half);

} // namespace clrt
