// SPDX-License-Identifier: Apache-2.0
#include "scene/emission.h"

#include "colour.h"

namespace clrt {

EmittedRadiance constant_emission(const Material& material) {
    const glm::dvec3 radiance(material.emission.x, material.emission.y, material.emission.z);
    return {radiance, radiance};
}

EmittedRadiance emitted_radiance(const Material& material, const TextureStore& textures) {
    EmittedRadiance emitted = constant_emission(material);
    if (material.map_emission != NO_INDEX) {
        emitted.mean *= textures.mean(material.map_emission);
        emitted.largest *= textures.largest(material.map_emission);
    }
    return emitted;
}

double emitted_luminance(const Material& material, const EmittedRadiance& emitted) {
    const double sides = material.flags & MATERIAL_EMITS_BOTH_SIDES ? 2 : 1;
    return luminance(emitted.mean) * double(MATERIAL_COVERAGE(material)) * sides;
}

} // namespace clrt
