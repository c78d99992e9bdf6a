// SPDX-License-Identifier: Apache-2.0
#include "scene/split_emitters.h"

#include "scene/emission.h"
#include "scene/emission_map.h"
#include "scene/emitter_parts.h"
#include "scene/lights.h"
#include "scene/part_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace clrt {
namespace {

/// Parts are cut until the second moment of what they give is this times that of the finest ones.
constexpr double FINE_ENOUGH = 1.4;

/// A material's triangles stay what they are unless the second moment falls by this factor.
constexpr double LEAST_GAIN = 1.25;

/// Parts in which the maps of a material are looked at, over all its triangles.
constexpr size_t MOST_LOOKS = size_t(1) << 20;

/// An emissive triangle of a material with a map, and the parts that it gets.
struct MappedTriangle {
    struct Part {
        u32 level, index;
        double exitance; ///< that it is chosen by
    };

    u32 emitter = 0;
    double area = 0;
    std::array<glm::dvec2, 3> uvs{};
    u32 finest = 0; ///< level of the parts in which the map is looked at
    std::vector<Part> parts{};
};

/// At which its map is looked up.
std::array<glm::dvec2, 3> uvs_of(const Scene& scene, const Triangle& t) {
    if (t.t0 == NO_INDEX)
        return {};
    const u32 map = scene.materials[t.material].map_emission;
    const bool by_second = map != NO_INDEX && (scene.textures[map].channel & TEXTURE_SECOND_UV);
    const std::vector<float>& uvs = by_second ? scene.second_uvs : scene.uvs;
    const auto at = [&](u32 i) { return glm::dvec2(uvs[2 * size_t(i)], uvs[2 * size_t(i) + 1]); };
    return {at(t.t0), at(t.t1), at(t.t2)};
}

/// Looks at parts of half a texel where it can.
u32 finest_level(const EmissionMap& map, const std::array<glm::dvec2, 3>& uvs) {
    const double texels = map.texels_along(uvs[1] - uvs[0], uvs[2] - uvs[0]);
    u32 level = 0;
    while (level < EMITTER_LARGEST_LEVEL && std::ldexp(1.0, int(level)) < 2 * texels)
        ++level;
    return level;
}

/// The triangles of a material, and how finely its map is looked at.
std::vector<MappedTriangle> triangles_of(const Scene& scene, u32 material, const EmissionMap& map) {
    std::vector<MappedTriangle> triangles;
    for (u32 i = 0; i < scene.emitters.size(); ++i) {
        const Triangle& t = scene.triangles[scene.emitters[i].triangle];
        if (t.material != material)
            continue;
        const auto uvs = uvs_of(scene, t);
        triangles.push_back({i, emitter_area(scene, i), uvs, finest_level(map, uvs)});
    }
    const auto looks = [&](u32 finest) {
        size_t sum = 0;
        for (const MappedTriangle& triangle : triangles)
            sum += part_count(std::min(triangle.finest, finest));
        return sum;
    };
    u32 finest = EMITTER_LARGEST_LEVEL;
    while (finest > 0 && looks(finest) > MOST_LOOKS)
        --finest;
    for (MappedTriangle& triangle : triangles)
        triangle.finest = std::min(triangle.finest, finest);
    return triangles;
}

/// Cuts the triangles of one material where the second moment falls most.
class Splitter {
public:
    /// `means` of the triangles, with weights; together they get at most so many parts more than they are.
    Splitter(std::vector<MappedTriangle>& triangles, const std::vector<PartMeans>& means, size_t most)
        : triangles_(triangles), means_(means), counts_(triangles.size(), 1) {
        double least = 0;
        for (u32 i = 0; i < triangles.size(); ++i) {
            least += triangles[i].area * means[i].least_second_moment(0, 0);
            push(i, 0, 0);
        }
        while (excess_ > (FINE_ENOUGH - 1) * least && more_ + 3 <= most && !open_.empty())
            cut_next();
        for (; !open_.empty(); open_.pop())
            keep(open_.top());
        for (MappedTriangle& triangle : triangles)
            std::sort(triangle.parts.begin(), triangle.parts.end(), [](const auto& a, const auto& b) {
                return code(a.level, a.index) < code(b.level, b.index);
            });
    }

    /// Of the parts.
    double second_moment() const { return kept_; }

private:
    struct Part {
        double excess; ///< of the second moment over what it would be in the finest parts
        u32 triangle, level, index;

        bool operator<(const Part& other) const {
            return std::tie(excess, other.triangle, other.level, other.index) <
                   std::tie(other.excess, triangle, level, index);
        }
    };

    static u32 code(u32 level, u32 index) { return index << 2 * (EMITTER_LARGEST_LEVEL - level); }

    void push(u32 triangle, u32 level, u32 index) {
        const PartMeans& means = means_[triangle];
        const double gain = means.second_moment(level, index) - means.least_second_moment(level, index);
        const double excess = std::max(gain, 0.0) * std::ldexp(triangles_[triangle].area, -2 * int(level));
        excess_ += excess;
        open_.push({excess, triangle, level, index});
    }

    void cut_next() {
        const Part part = open_.top();
        open_.pop();
        excess_ -= part.excess;
        if (part.level == means_[part.triangle].finest() || counts_[part.triangle] + 3 > EMITTER_MOST_PARTS)
            return keep(part);
        more_ += 3;
        counts_[part.triangle] += 3;
        for (u32 digit = 0; digit < 4; ++digit)
            push(part.triangle, part.level + 1, 4 * part.index + digit);
    }

    void keep(const Part& part) {
        const PartMeans& means = means_[part.triangle];
        triangles_[part.triangle].parts.push_back(
            {part.level, part.index, means.weight(part.level, part.index)});
        kept_ += means.second_moment(part.level, part.index) *
                 std::ldexp(triangles_[part.triangle].area, -2 * int(part.level));
    }

    std::vector<MappedTriangle>& triangles_;
    const std::vector<PartMeans>& means_;
    std::vector<u32> counts_;
    std::priority_queue<Part> open_;
    size_t more_ = 0;
    double excess_ = 0, kept_ = 0;
};

/// The triangles of a material with at most so many parts more if that pays; none where not.
std::vector<MappedTriangle> mapped_triangles(const Scene& scene, u32 material, size_t most) {
    const EmissionMap map(scene, scene.materials[material]);
    if (!map.varies())
        return {};
    std::vector<MappedTriangle> triangles = triangles_of(scene, material, map);
    std::vector<PartMeans> means;
    means.reserve(triangles.size());
    for (const MappedTriangle& triangle : triangles)
        means.emplace_back(map, triangle.uvs, triangle.finest);
    double area = 0, power = 0, square = 0;
    for (size_t i = 0; i < triangles.size(); ++i) {
        area += triangles[i].area;
        power += triangles[i].area * means[i].mean(0, 0);
        square += triangles[i].area * means[i].square(0, 0);
    }
    if (!(power > 0))
        return {};
    for (PartMeans& mean : means)
        mean.set_weights(power / area);
    const Splitter splitter(triangles, means, most);
    // Weights add up to the power, whatever the parts; evenly they are the mean.
    const bool pays = square * area >= LEAST_GAIN * splitter.second_moment() * power;
    return pays ? triangles : std::vector<MappedTriangle>();
}

/// Chooses the emitters anew, by their exitance.
void tabulate_emitters(Scene& scene) {
    std::vector<double> powers, areas;
    for (u32 i = 0; i < scene.emitters.size(); ++i) {
        areas.push_back(emitter_area(scene, i));
        powers.push_back(emitter_power(scene, i));
    }
    tabulate(powers, areas, scene.emitters);
}

/// Puts parts in the place of emitters; `mapped` are in the order of the emitters.
void replace_emitters(const std::vector<MappedTriangle>& mapped, Scene& scene) {
    const std::vector<Emitter> before = std::move(scene.emitters);
    const bool has_parts = std::any_of(mapped.begin(), mapped.end(), [](const MappedTriangle& triangle) {
        return triangle.parts.size() > 1;
    });
    scene.emitters.clear();
    auto next = mapped.begin();
    for (u32 i = 0; i < before.size(); ++i) {
        Triangle& t = scene.triangles[before[i].triangle];
        t.emitter = u32(scene.emitters.size());
        std::vector<MappedTriangle::Part> parts = {
            {0, 0, emitted_luminance(scene.materials[t.material], scene.emitted[t.material])}};
        if (next != mapped.end() && next->emitter == i)
            parts = (next++)->parts;
        for (const MappedTriangle::Part& part : parts) {
            scene.emitters.push_back(before[i]);
            scene.emitter_exitance.push_back(part.exitance);
            if (has_parts)
                scene.emitter_parts.push_back(emitter_part(part.level, part.index, u32(parts.size())));
        }
    }
    tabulate_emitters(scene);
}

bool has_emission_map(const Scene& scene, u32 material) {
    const u32 map = scene.materials[material].map_emission;
    return map != NO_INDEX && scene.textures[map].format != TEXEL_VERTEX;
}

} // namespace

void split_emitters(Scene& scene) {
    std::vector<bool> shines(scene.materials.size(), false);
    for (const Emitter& emitter : scene.emitters)
        shines[scene.triangles[emitter.triangle].material] = true;
    std::vector<MappedTriangle> mapped;
    size_t left = MOST_EMITTER_PARTS;
    for (u32 material = 0; material < scene.materials.size(); ++material)
        if (shines[material] && has_emission_map(scene, material))
            for (MappedTriangle& triangle : mapped_triangles(scene, material, left)) {
                left -= triangle.parts.size() - 1;
                mapped.push_back(std::move(triangle));
            }
    if (mapped.empty())
        return;
    std::sort(mapped.begin(), mapped.end(),
              [](const MappedTriangle& a, const MappedTriangle& b) { return a.emitter < b.emitter; });
    replace_emitters(mapped, scene);
}

void unite_emitters(Scene& scene) {
    if (scene.emitter_exitance.empty())
        return;
    std::vector<double> exitance;
    for (size_t i = 0; i < scene.materials.size(); ++i)
        exitance.push_back(emitted_luminance(scene.materials[i], scene.emitted[i]));
    scene.emitter_parts.clear();
    scene.emitter_exitance.clear();
    scene.emitters = build_emitters(scene.positions, scene.triangles, exitance).emitters;
}

EmissiveTriangles count_emissive_triangles(const Scene& scene) {
    EmissiveTriangles triangles;
    if (scene.emitter_parts.empty()) {
        triangles.count = scene.emitters.size();
        return triangles;
    }
    for (size_t i = 0; i < scene.emitters.size();) {
        const u32 parts = EMITTER_CODE_PARTS(scene.emitter_parts[i].code);
        ++triangles.count;
        triangles.split += parts > 1;
        triangles.parts += parts > 1 ? parts : 0;
        i += parts;
    }
    return triangles;
}

} // namespace clrt
