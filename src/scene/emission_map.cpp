// SPDX-License-Identifier: Apache-2.0
#include "scene/emission_map.h"

#include "colour.h"
#include "scene/texture_levels.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// The part of the picture in which a coordinate lies, from 0 to 1; kernels/geometry/texture.h.
double inside(double t, u32 wrap) {
    if (!std::isfinite(t))
        return 0;
    if (wrap == WRAP_REPEAT)
        return t - std::floor(t);
    if (wrap == WRAP_MIRROR) {
        const double pair = t - 2 * std::floor(0.5 * t);
        return pair > 1 ? 2 - pair : pair;
    }
    return std::clamp(t, 0.0, 1.0);
}

bool is_outside(double t, u32 wrap) {
    return wrap == WRAP_BLACK && !(t >= 0 && t <= 1);
}

u32 wrapped(int i, u32 size, u32 wrap) {
    const int n = int(size);
    if (wrap != WRAP_REPEAT)
        return u32(std::clamp(i, 0, n - 1));
    return u32(i < 0 ? i + n : i >= n ? i - n : i);
}

double not_negative(double value) {
    return std::isfinite(value) && value > 0 ? value : 0;
}

} // namespace

template <class Value>
MeanLevels::MeanLevels(const Scene& scene, const Texture& texture, const Value& value_of)
    : texture_(texture) {
    const u32* words = scene.texel_words.data();
    Level level{texture.width, texture.height, std::vector<float>(size_t(texture.width) * texture.height)};
    tbb::parallel_for(size_t(0), size_t(texture.height), [&](size_t y) {
        for (size_t i = y * texture.width; i < (y + 1) * texture.width; ++i)
            level.values[i] =
                float(value_of(decode_texel(texture.format, words + texture.first_word, i, words)));
    });
    levels_.push_back(std::move(level));
    while (levels_.back().values.size() > 1) {
        const Level& last = levels_.back();
        Level half{half_size(last.width), half_size(last.height), {}};
        half.values.resize(size_t(half.width) * half.height);
        halve_values(last.values.data(), last.width, last.height, 1, half.values.data());
        levels_.push_back(std::move(half));
    }
}

bool MeanLevels::varies() const {
    const std::vector<float>& values = levels_.front().values;
    return texture_.wrap_u == WRAP_BLACK || texture_.wrap_v == WRAP_BLACK ||
           std::any_of(values.begin(), values.end(), [&](float value) { return value != values.front(); });
}

double MeanLevels::texels_along(const glm::dvec2& e1, const glm::dvec2& e2) const {
    const auto length = [&](const glm::dvec2& e) {
        const glm::dvec2 turned(e.x * double(texture_.scale_u) + e.y * double(texture_.shear_u),
                                e.y * double(texture_.scale_v) + e.x * double(texture_.shear_v));
        return glm::length(turned * glm::dvec2(texture_.width, texture_.height));
    };
    return std::max({length(e1), length(e2), length(e2 - e1)});
}

double MeanLevels::mean_at(const glm::dvec2& uv, double texels) const {
    const double at_u = uv.x * double(texture_.scale_u) + uv.y * double(texture_.shear_u) +
                        double(texture_.offset_u),
                 at_v = uv.y * double(texture_.scale_v) + uv.x * double(texture_.shear_v) +
                        double(texture_.offset_v);
    if (is_outside(at_u, texture_.wrap_u) || is_outside(at_v, texture_.wrap_v))
        return 0;
    // The first level of squares at least half as wide: neighbours leave nothing out.
    size_t number = 0;
    for (double width = texels; width > 2 && number + 1 < levels_.size(); width /= 2)
        ++number;
    const Level& level = levels_[number];
    const double x = inside(at_u, texture_.wrap_u) * level.width - 0.5,
                 y = (1 - inside(at_v, texture_.wrap_v)) * level.height - 0.5;
    const int left = int(std::floor(x)), top = int(std::floor(y));
    const auto value = [&](int column, int row) {
        return double(level.values[size_t(wrapped(row, level.height, texture_.wrap_v)) * level.width +
                                   wrapped(column, level.width, texture_.wrap_u)]);
    };
    const double fx = x - left, fy = y - top;
    const double upper = value(left, top) * (1 - fx) + value(left + 1, top) * fx,
                 lower = value(left, top + 1) * (1 - fx) + value(left + 1, top + 1) * fx;
    return upper * (1 - fy) + lower * fy;
}

EmissionMap::EmissionMap(const Scene& scene, const Material& material)
    : factor_(double(MATERIAL_COVERAGE(material)) * (material.flags & MATERIAL_EMITS_BOTH_SIDES ? 2 : 1)) {
    const Texture& emission = scene.textures[material.map_emission];
    const glm::dvec3 colour = to_dvec3(material.emission);
    maps_.emplace_back(scene, emission, [&](const vec4& texel) {
        glm::dvec3 value = double(emission.base) + double(emission.gain) * to_dvec3(texel);
        value = {not_negative(value.x), not_negative(value.y), not_negative(value.z)};
        return luminance(colour * value);
    });
    if (!(material.flags & MATERIAL_CUT_OUT) || material.map_coverage == NO_INDEX)
        return;
    const Texture& coverage = scene.textures[material.map_coverage];
    maps_.emplace_back(scene, coverage, [&](const vec4& texel) {
        const double channels[4] = {texel.x, texel.y, texel.z, texel.w};
        const double value = TEXTURE_CHANNEL(coverage) == CHANNEL_LUMINANCE
                                 ? luminance(to_dvec3(texel))
                                 : channels[TEXTURE_CHANNEL(coverage)];
        return std::min(not_negative(double(coverage.base) + double(coverage.gain) * value), 1.0);
    });
}

bool EmissionMap::varies() const {
    return std::any_of(maps_.begin(), maps_.end(), [](const MeanLevels& map) { return map.varies(); });
}

double EmissionMap::texels_along(const glm::dvec2& e1, const glm::dvec2& e2) const {
    double most = 0;
    for (const MeanLevels& map : maps_)
        most = std::max(most, map.texels_along(e1, e2));
    return most;
}

double EmissionMap::mean_at(const glm::dvec2& uv, const glm::dvec2& e1, const glm::dvec2& e2) const {
    double product = factor_;
    for (const MeanLevels& map : maps_)
        product *= map.mean_at(uv, map.texels_along(e1, e2));
    return product;
}

} // namespace clrt
