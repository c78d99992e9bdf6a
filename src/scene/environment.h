// SPDX-License-Identifier: Apache-2.0
// The light from infinitely far away: a lat-long map with its table for importance sampling, or a constant.
#pragma once

#include "options/options.h"
#include "scene/notices.h"
#include "scene/scene.h"

#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace clrt {

/// Linear radiance, rows from +Y down.
struct EnvironmentImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> texels;
};

/// Which techniques find the sky: the table is all that does, or directions sampled by the BSDF do too, and
/// multiple importance sampling weighs the two.
enum class SkySampling { BY_TABLE, BY_TABLE_AND_BSDF };

/// The techniques of an integrator: only the path tracer counts the sky behind its scattered rays.
SkySampling sky_sampling(Integrator integrator);

/// Reads a map (EXR, HDR, PNG, ...): 8- and 16-bit integers are sRGB-encoded, floats linear; grey becomes
/// RGB, alpha is left out. Throws SceneError with the reason for a file that cannot be read.
EnvironmentImage read_environment(const std::string& path);

/// Makes non-finite texels black and negative channels 0; both are counted in a notice with the first place.
void clean_environment(EnvironmentImage& image, const std::string& path, NoticeList& notices);

/// Luminance of the bilinear lookup, averaged over the cell of each texel: the separable kernel 1/8, 6/8,
/// 1/8, which wraps around in u and repeats the border row in v. It is positive wherever the lookup is,
/// somewhere in the cell.
std::vector<double> cell_luminance(const EnvironmentImage& image);

/// Solid angle of a texel in row `row` of a map: (2 pi / width)(cos theta_0 - cos theta_1).
double texel_solid_angle(int row, int width, int height);

/// The environment of a cleaned map: texels chosen in proportion to cell_luminance times solid angle. Beside
/// BSDF sampling it is what cell_luminance exceeds its mean by (MIS compensation, Karlik et al. 2019): dimmer
/// texels have probability 0 and are left to the BSDF. A map without bright texels keeps the table of its
/// luminance. A black map gives a constant environment of radiance 0, with a notice.
Environment map_environment(const EnvironmentImage& image, double factor, double rotation_degrees,
                            SkySampling sampling, NoticeList& notices);

/// The same radiance from everywhere. Throws UsageError if it is negative or not finite.
Environment constant_environment(const glm::dvec3& radiance);

/// What the options ask for; `scene_has_light` says whether anything else shines or was asked to. Without any
/// light the sky is white, radiance 1, with a notice.
Environment load_environment(const LightOptions& options, bool scene_has_light, SkySampling sampling,
                             NoticeList& notices);

} // namespace clrt
