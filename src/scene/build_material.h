// SPDX-License-Identifier: Apache-2.0
// A described material -> the lobes, roughness and maps that the kernels read.
#pragma once

#include "scene/material_description.h"

#include <functional>

namespace clrt {

/// Indices of conductors are kept within these: squares of their squares fit floats, and an index of 0, of
/// which the reflectance head-on has no value, is one of total reflection.
constexpr double CONDUCTOR_LARGEST_INDEX = 1e4, CONDUCTOR_SMALLEST_ETA = 1e-3;

/// GGX lobes narrower than this become delta lobes: microfacet arithmetic is tested down to alpha = 1e-4 and
/// the pictures do not differ from there on.
constexpr double SMOOTH_ALPHA = 1e-4;

/// A Phong exponent of 0 says "no highlight" to the kernels; the widest highlight gets this one instead.
constexpr double SMALLEST_PHONG_EXPONENT = 1e-3;

/// GGX alpha of a Phong exponent, sqrt(2 / (n + 2)), and back, 2 / alpha^2 - 2 (Walter et al. 2007,
/// section 5.2, and Blinn-Phong's usual match).
double alpha_of_phong(double exponent);
double phong_of_alpha(double alpha);

/// Reads a map and returns its index, or NO_INDEX.
using LoadMap = std::function<u32(const TextureUse&, TextureRole)>;

struct MaterialContext {
    double unit = 1;        ///< one scene unit in the normalised frame, for bump heights
    bool two_sided = false; ///< --two-sided-lights
    bool nested = false;    ///< some material of the scene has a priority
};

/// Makes the material. Only the maps that can have an effect are loaded.
Material build_material(const MaterialDescription& description, const MaterialContext& context,
                        const LoadMap& load_map);

} // namespace clrt
