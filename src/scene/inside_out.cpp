// SPDX-License-Identifier: Apache-2.0
#include "scene/inside_out.h"

#include "scene/enclosed_volume.h"
#include "scene/normalise.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <map>
#include <utility>

namespace clrt {
namespace {

/// The glass of one object and material.
struct GlassBody {
    EnclosedVolume volume;
    Bounds box{glm::dvec3(std::numeric_limits<double>::max()),
               glm::dvec3(std::numeric_limits<double>::lowest())};
};

using GlassBodies = std::map<std::pair<u32, u32>, GlassBody>;

GlassBodies find_glass(const Scene& scene) {
    GlassBodies bodies;
    for (const Triangle& t : scene.triangles) {
        if ((scene.materials[t.material].lobes & LOBE_DIELECTRIC) == 0)
            continue;
        GlassBody& body = bodies[{t.material, t.object}];
        const TriangleCorners c = corners_of(scene.positions, t);
        body.volume.add(c);
        for (const glm::dvec3& p : c.p)
            body.box = {glm::min(body.box.low, p), glm::max(body.box.high, p)};
    }
    return bodies;
}

bool is_within(const Bounds& inner, const Bounds& outer) {
    return glm::all(glm::greaterThanEqual(inner.low, outer.low)) &&
           glm::all(glm::lessThanEqual(inner.high, outer.high));
}

} // namespace

void note_inside_out_glass(const Scene& scene, NoticeList& notices) {
    const GlassBodies bodies = find_glass(scene);
    for (const auto& [key, body] : bodies) {
        const auto holds_it = [&body = body](const auto& other) {
            const EnclosedVolume& volume = other.second.volume;
            return volume.is_closed() && !volume.is_inside_out() && is_within(body.box, other.second.box);
        };
        if (body.volume.is_inside_out() && std::none_of(bodies.begin(), bodies.end(), holds_it))
            notices.add("glass '" + scene.material_names[key.first] +
                            "' is closed and inside out, as a bubble of air is: its faces need turning if it "
                            "is solid (Blender: Mesh > Normals > Recalculate Outside)",
                        scene.material_places[key.first]);
    }
}

} // namespace clrt
