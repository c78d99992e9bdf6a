// SPDX-License-Identifier: Apache-2.0
#include "scene/part_means.h"

#include "scene/emitter_parts.h"

#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// The part of a material's power by which its triangles are chosen evenly, whatever the map: nothing that
/// shines is unreachable, and what a mean has blurred is not chosen too rarely.
constexpr double SHARE_WHATEVER_THE_MAP = 1.0 / 16;

} // namespace

PartMeans::PartMeans(const EmissionMap& map, const std::array<glm::dvec2, 3>& uvs, u32 finest)
    : levels_(finest + 1) {
    for (u32 level = 0; level <= finest; ++level)
        levels_[level].resize(part_count(level));
    const glm::dvec2 e1 = uvs[1] - uvs[0], e2 = uvs[2] - uvs[0];
    tbb::parallel_for(u32(0), u32(part_count(finest)), [&](u32 i) {
        const PartPlace place = part_place(finest, i);
        const auto mean_at = [&](const glm::dvec2& b) {
            const glm::dvec2 at = place.at(b);
            return map.mean_at(uvs[0] + at.x * e1 + at.y * e2, place.step * e1, place.step * e2);
        };
        // With its corners, so that the rim of what is bright beside it is not missed.
        const double mean =
            0.25 * (mean_at(glm::dvec2(1.0 / 3)) + mean_at({0, 0}) + mean_at({1, 0}) + mean_at({0, 1}));
        levels_[finest][i].mean = float(mean);
        levels_[finest][i].square = float(mean * mean);
    });
    gather(&Part::mean);
    gather(&Part::square);
}

void PartMeans::gather(float Part::*member) {
    for (u32 level = finest(); level-- > 0;)
        for (size_t i = 0; i < levels_[level].size(); ++i) {
            const Part* parts = &levels_[level + 1][4 * i];
            levels_[level][i].*member =
                0.25f * ((parts[0].*member + parts[1].*member) + (parts[2].*member + parts[3].*member));
        }
}

void PartMeans::set_weights(double material_mean) {
    material_mean_ = material_mean;
    for (u32 i = 0; i < part_count(finest()); ++i)
        levels_[finest()][i].least = float(second_moment(finest(), i));
    gather(&Part::least);
}

double PartMeans::weight(u32 level, u32 index) const {
    const double own = mean(level, index);
    return own + SHARE_WHATEVER_THE_MAP * (material_mean_ - own);
}

double PartMeans::second_moment(u32 level, u32 index) const {
    return square(level, index) / weight(level, index);
}

} // namespace clrt
