// SPDX-License-Identifier: Apache-2.0
// The table by which light sampling chooses a texel of an environment map.
#pragma once

#include "options/integrators.h"
#include "scene/scene.h"

#include <vector>

namespace clrt {

/// Luminance of the bilinear lookup, averaged over the cell of each texel of the rows [first, end), which are
/// in the map: the separable kernel 1/8, 6/8, 1/8, which wraps around in u and repeats the border row in v.
/// It is positive wherever the lookup is, somewhere in the cell.
std::vector<double> cell_luminance(const Environment& sky, int first, int end);

/// Solid angle of a texel in row `row` of a map: (2 pi / width)(cos theta_0 - cos theta_1).
double texel_solid_angle(int row, int width, int height);

/// Light of the map without its factor: cell_luminance times solid angle, over all texels.
double light_of_map(const Environment& sky);

/// Fills in the table of a map that gives light: texels chosen in proportion to their light, but for
/// rounding to a share of 1/SKY_SHARES of their tile's; one with light keeps a share. Beside BSDF sampling
/// it is what cell_luminance exceeds its mean by (MIS compensation, Karlik et al. 2019), or for the brightest
/// alone four times its mean: dimmer texels have probability 0 and are left to the BSDF. A map without bright
/// texels keeps the table of its luminance. A constant environment needs no table.
void tabulate_sky(Environment& sky, SkySampling sampling);

/// The probability with which the table chooses a texel.
double texel_probability(const Environment& sky, int x, int y);

} // namespace clrt
