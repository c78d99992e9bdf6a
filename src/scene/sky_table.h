// SPDX-License-Identifier: Apache-2.0
// The table by which light sampling chooses a texel of an environment map.
#pragma once

#include "options/integrators.h"
#include "scene/scene.h"

#include <vector>

namespace clrt {

/// Luminance of the bilinear lookup, averaged over the cell of each texel: the separable kernel 1/8, 6/8,
/// 1/8, which wraps around in u and repeats the border row in v. It is positive wherever the lookup is,
/// somewhere in the cell.
std::vector<double> cell_luminance(const Environment& sky);

/// Solid angle of a texel in row `row` of a map: (2 pi / width)(cos theta_0 - cos theta_1).
double texel_solid_angle(int row, int width, int height);

/// Light of each texel: cell_luminance times solid angle, without the map's factor.
std::vector<double> texel_weights(const Environment& sky);

/// Fills in the table of a map that gives light: texels chosen in proportion to their weights. Beside BSDF
/// sampling it is what cell_luminance exceeds its mean by (MIS compensation, Karlik et al. 2019): dimmer
/// texels have probability 0 and are left to the BSDF. A map without bright texels keeps the table of its
/// luminance. A constant environment needs no table.
void tabulate_sky(Environment& sky, SkySampling sampling);

} // namespace clrt
