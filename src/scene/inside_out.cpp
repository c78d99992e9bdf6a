// SPDX-License-Identifier: Apache-2.0
#include "scene/inside_out.h"

#include "scene/enclosed_volume.h"
#include "scene/normalise.h"
#include "scene/placed_box.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace clrt {
namespace {

/// The glass of one object and material.
struct GlassBody {
    EnclosedVolume volume;
    Bounds box{glm::dvec3(std::numeric_limits<double>::max()),
               glm::dvec3(std::numeric_limits<double>::lowest())};
};

using GlassBodies = std::map<std::pair<u32, u32>, GlassBody>;

/// Of the triangles [first, end), by material and object.
GlassBodies find_glass(const Scene& scene, size_t first, size_t end) {
    GlassBodies bodies;
    for (size_t i = first; i < end; ++i) {
        const Triangle& t = scene.triangles[i];
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

/// Glass where it is in the scene.
struct PlacedGlass {
    u32 material;
    Bounds box;
    bool is_solid, is_in_doubt; ///< its fronts are outside; inside, and nothing has been asked of it before
};

void place(const GlassBodies& bodies, const Instance* instance, bool is_first,
           std::vector<PlacedGlass>& glass) {
    for (const auto& [key, body] : bodies) {
        Bounds box = body.box;
        if (instance) {
            const auto corners = PlacedBox{body.box}.corners_in(*instance);
            box = {corners[0], corners[0]};
            for (const glm::dvec3& corner : corners)
                box = {glm::min(box.low, corner), glm::max(box.high, corner)};
        }
        // A mirrored instance's winding is turned with it: its fronts stay where they are in its mesh.
        const bool is_inside_out = body.volume.is_inside_out();
        const bool is_solid = body.volume.is_closed() && !is_inside_out;
        if (is_solid || (is_inside_out && is_first))
            glass.push_back({key.first, box, is_solid, is_inside_out});
    }
}

std::vector<PlacedGlass> place_all_glass(const Scene& scene) {
    std::vector<PlacedGlass> glass;
    const size_t own = own_triangle_count(scene.triangles, scene.prototypes);
    place(find_glass(scene, 0, own), nullptr, true, glass);
    std::vector<GlassBodies> parts;
    for (const Prototype& part : scene.prototypes)
        parts.push_back(
            find_glass(scene, part.first_triangle, size_t(part.first_triangle) + part.triangle_count));
    std::set<u32> placed;
    for (size_t i = 1; i < scene.instances.size(); ++i) { // the first stands for the scene itself
        const Instance& instance = scene.instances[i];
        place(parts[instance.prototype], &instance, placed.insert(instance.prototype).second, glass);
    }
    return glass;
}

bool is_within(const Bounds& inner, const Bounds& outer) {
    return glm::all(glm::greaterThanEqual(inner.low, outer.low)) &&
           glm::all(glm::lessThanEqual(inner.high, outer.high));
}

} // namespace

void note_inside_out_glass(const Scene& scene, NoticeList& notices) {
    const std::vector<PlacedGlass> glass = place_all_glass(scene);
    std::set<u32> noted;
    for (const PlacedGlass& body : glass) {
        if (!body.is_in_doubt || noted.count(body.material))
            continue;
        const auto holds_it = [&](const PlacedGlass& other) {
            return other.is_solid && is_within(body.box, other.box);
        };
        if (std::any_of(glass.begin(), glass.end(), holds_it))
            continue;
        noted.insert(body.material);
        notices.add("glass '" + scene.material_names[body.material] +
                        "' is closed and inside out, as a bubble of air is: its faces need turning if it "
                        "is solid (Blender: Mesh > Normals > Recalculate Outside)",
                    scene.material_places[body.material]);
    }
}

} // namespace clrt
