// SPDX-License-Identifier: Apache-2.0
// What a material with a map emits from point to point, and on average over parts of its surface.
#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>
#include <vector>

namespace clrt {

/// A scalar of a picture's texels and its means over ever larger squares (Williams 1983), read as kernels
/// read textures.
class MeanLevels {
public:
    /// `value_of(texel)` is stored; the texel is linear, without base and gain.
    template <class Value>
    MeanLevels(const Scene& scene, const Texture& texture, const Value& value_of);

    /// The longest of the sides of a triangle with these edges in texture coordinates, in texels.
    double texels_along(const glm::dvec2& e1, const glm::dvec2& e2) const;
    /// About the mean at uv over an area so many texels wide.
    double mean_at(const glm::dvec2& uv, double texels) const;
    /// True if not all texels are alike.
    bool varies() const;

private:
    struct Level {
        u32 width, height;
        std::vector<float> values;
    };

    Texture texture_;
    std::vector<Level> levels_;
};

/// The luminance that a material emits at texture coordinates, times its coverage, twice that where both
/// sides shine.
class EmissionMap {
public:
    EmissionMap(const Scene& scene, const Material& material);

    bool varies() const;
    double texels_along(const glm::dvec2& e1, const glm::dvec2& e2) const;
    /// About the mean at uv over triangles of these edges.
    double mean_at(const glm::dvec2& uv, const glm::dvec2& e1, const glm::dvec2& e2) const;

private:
    double factor_; ///< of the maps' product
    std::vector<MeanLevels> maps_;
};

} // namespace clrt
