// SPDX-License-Identifier: Apache-2.0
#include "scene/emitter_parts.h"

#include "scene/lights.h"
#include "scene/vectors.h"

namespace clrt {

PartPlace part_place(u32 level, u32 index) {
    const glm::dvec2 origins[4] = {{0, 0}, {0.5, 0}, {0, 0.5}, {0.5, 0.5}};
    PartPlace place;
    for (u32 cut = level; cut-- > 0;) {
        const u32 digit = index >> 2 * cut & 3;
        place = {place.at(origins[digit]), digit == 3 ? -0.5 * place.step : 0.5 * place.step};
    }
    return place;
}

u32 part_at(u32 level, glm::dvec2 b) {
    u32 index = 0;
    for (u32 cut = 0; cut < level; ++cut) {
        b *= 2.0;
        const u32 digit = b.x > 1 ? 1 : b.y > 1 ? 2 : b.x + b.y > 1 ? 3 : 0;
        index = 4 * index + digit;
        if (digit == 3)
            b = glm::dvec2(1) - b;
        else if (digit > 0)
            b[digit == 1 ? 0 : 1] -= 1;
    }
    return index;
}

EmitterPart emitter_part(u32 level, u32 index, u32 parts) {
    const PartPlace place = part_place(level, index);
    return {float(place.origin.x), float(place.origin.y), float(place.step),
            EMITTER_CODE(index << 2 * (EMITTER_LARGEST_LEVEL - level), parts)};
}

PartPlace emitter_place(const Scene& scene, u32 emitter) {
    if (scene.emitter_parts.empty())
        return {};
    const EmitterPart& part = scene.emitter_parts[emitter];
    return {{part.b1, part.b2}, part.step};
}

std::array<glm::dvec3, 3> emitter_corners(const Scene& scene, u32 emitter) {
    const Triangle& t = scene.triangles[scene.emitters[emitter].triangle];
    const glm::dvec3 p0 = to_dvec3(scene.positions[t.v0]), p1 = to_dvec3(scene.positions[t.v1]),
                     p2 = to_dvec3(scene.positions[t.v2]);
    const PartPlace place = emitter_place(scene, emitter);
    if (place.step == 1)
        return {p0, p1, p2};
    const auto at = [&](const glm::dvec2& b) { return p0 + b.x * (p1 - p0) + b.y * (p2 - p0); };
    return {at(place.origin), at(place.at({1, 0})), at(place.at({0, 1}))};
}

double emitter_area(const Scene& scene, u32 emitter) {
    const Triangle& t = scene.triangles[scene.emitters[emitter].triangle];
    const double step = emitter_place(scene, emitter).step;
    return step * step * triangle_area(scene.positions[t.v0], scene.positions[t.v1], scene.positions[t.v2]);
}

} // namespace clrt
