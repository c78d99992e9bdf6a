// SPDX-License-Identifier: Apache-2.0
// Radiance of an environment map in few bytes a texel.
#pragma once

#include "scene/environment.h"
#include "scene/scene.h"

#include <cstddef>

namespace clrt {

constexpr int SKY_TILE = int(SKY_TILE_SIZE);

/// A map of more texels may be rounded to halves; of fewer its numbers are kept as they are.
constexpr size_t MOST_EXACT_SKY_TEXELS = size_t(1) << 23;

/// Tiles across and down that hold a map of this many texels across and down.
int sky_tiles(int texels);

/// Stores the texels of a cleaned map, in the smallest of the forms SKY_TEXEL_* that holds all of them
/// exactly: 4 bytes a texel for what an .hdr file holds, 6 for halves, 12 for floats. A map of more than
/// `most_exact` texels that fits neither of the first two becomes halves: the texels are then those of the
/// image over a power of two, which is returned, each rounded by 2^-12 of itself at most, and those below
/// 2^-28 of the largest by 2^-40 of the largest. Otherwise returns 1.
double store_sky_texels(const EnvironmentImage& image, Environment& sky,
                        size_t most_exact = MOST_EXACT_SKY_TEXELS);

/// A stored texel as kernels see it, without the map's factor.
glm::vec3 sky_texel(const Environment& sky, int x, int y);

/// The largest channel of all texels.
double largest_sky_texel(const Environment& sky);

} // namespace clrt
