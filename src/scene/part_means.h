// SPDX-License-Identifier: Apache-2.0
// What the parts of an emissive triangle send by its material's map.
#pragma once

#include "scene/emission_map.h"

#include <array>
#include <glm/vec2.hpp>
#include <vector>

namespace clrt {

/// Means over the parts of a triangle of all levels up to the finest that the map is looked at in.
class PartMeans {
public:
    /// The triangle has these texture coordinates at its corners.
    PartMeans(const EmissionMap& map, const std::array<glm::dvec2, 3>& uvs, u32 finest);

    u32 finest() const { return u32(levels_.size()) - 1; }
    double mean(u32 level, u32 index) const { return double(levels_[level][index].mean); }
    /// Mean of the squares.
    double square(u32 level, u32 index) const { return double(levels_[level][index].square); }

    /// Sets what parts are chosen by: their mean, but for a share of it, which is that of the material.
    void set_weights(double material_mean);
    /// What a part is chosen by, over its area.
    double weight(u32 level, u32 index) const;
    /// Mean of the squares over the weights, where all of the part is chosen alike,
    double second_moment(u32 level, u32 index) const;
    /// and where the finest parts of it are chosen by themselves.
    double least_second_moment(u32 level, u32 index) const { return double(levels_[level][index].least); }

private:
    struct Part {
        float mean = 0, square = 0, least = 0;
    };

    /// Gives each part the mean of a member over the four that it is cut into.
    void gather(float Part::*member);

    double material_mean_ = 0;
    std::vector<std::vector<Part>> levels_;
};

} // namespace clrt
