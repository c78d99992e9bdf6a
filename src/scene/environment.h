// SPDX-License-Identifier: Apache-2.0
// The light from infinitely far away: a lat-long map, or a constant.
#pragma once

#include "options/light_options.h"
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

/// Reads a map (EXR, HDR, PNG, ...): 8- and 16-bit integers are sRGB-encoded, floats linear; grey becomes
/// RGB, alpha is left out. Throws SceneError with the reason for a file that cannot be read.
EnvironmentImage read_environment(const std::string& path);

/// Makes non-finite texels black and negative channels 0; both are counted in a notice with the first place.
void clean_environment(EnvironmentImage& image, const std::string& path, NoticeList& notices);

/// The environment of a cleaned map, without the table for light sampling (scene/sky_table.h), which depends
/// on the integrator. A black map gives a constant environment of radiance 0, with a notice.
Environment map_environment(const EnvironmentImage& image, double factor, double rotation_degrees,
                            NoticeList& notices);

/// The same radiance from everywhere. Throws UsageError if it is negative or not finite.
Environment constant_environment(const glm::dvec3& radiance);

/// What the options ask for; `scene_has_light` says whether anything else shines or was asked to. Without any
/// light the sky is white, radiance 1, with a notice.
Environment load_environment(const LightOptions& options, bool scene_has_light, NoticeList& notices);

} // namespace clrt
