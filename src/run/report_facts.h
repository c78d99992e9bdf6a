// SPDX-License-Identifier: Apache-2.0
// Facts that the report tells in words, as JSON and as metadata.
#pragma once

#include "effects/effects.h"
#include "render/render.h"

#include <string>
#include <vector>

namespace clrt {

/// Of the whole picture, those of earlier runs included.
double rays_per_second(const Render& render);

/// Effects that the scene calls for, or that are proved absent; without those that are left out.
std::vector<std::string> names_of_effects(const Effects& effects, bool present);

/// Names of the materials whose slabs connections have crossed, to light from outside or to lamps; empty
/// where neither is connected to.
std::vector<std::string> crossed_slabs(const Scene& scene, const Options& options);

/// Samples a pixel of the tiles of an adaptive film.
struct TileSpread {
    double mean = 0;
    std::uint32_t fewest = UINT32_MAX, most = 0;
};

/// Of an adaptive film.
TileSpread tile_spread(const Film& film);

} // namespace clrt
