// SPDX-License-Identifier: Apache-2.0
#include "scene/casters.h"

#include "scene/placed_box.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

namespace clrt {
namespace {

/// Halves of halves: LARGEST_CASTER_COUNT spheres.
constexpr int LARGEST_LEVEL = 5;
/// A part is split where the squared radii of its halves sum to less than this share of its own: what more
/// spheres cost every light path must be worth it.
constexpr double LARGEST_SPLIT_SHARE = 0.8;
/// Centres and radii are rounded to floats, and so are rays.
constexpr double RADIUS_MARGIN = 1 + 1e-5;

/// Corners of a triangle where the shutter opens and where it closes.
struct CasterCorners {
    std::vector<glm::dvec3> points;
    glm::dvec3 middle{0};
};

using Part = std::vector<CasterCorners>;

CasterCorners caster_corners(const Scene& scene, const Triangle& triangle) {
    CasterCorners corners;
    for (const u32 corner : {triangle.v0, triangle.v1, triangle.v2}) {
        corners.points.push_back(to_dvec3(scene.positions[corner]));
        if (!scene.position_moves.empty())
            corners.points.push_back(corners.points.back() + to_dvec3(scene.position_moves[corner]));
    }
    for (const glm::dvec3& point : corners.points)
        corners.middle += point / double(corners.points.size());
    return corners;
}

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    glm::dvec3 middle() const { return 0.5 * (low + high); }
};

/// Around the middle of the box.
vec4 sphere_of(const Part& part) {
    Box box;
    for (const CasterCorners& corners : part)
        for (const glm::dvec3& point : corners.points)
            box.add(point);
    double square = 0;
    for (const CasterCorners& corners : part)
        for (const glm::dvec3& point : corners.points) {
            const glm::dvec3 way = point - box.middle();
            square = std::max(square, glm::dot(way, way));
        }
    return to_vec4(box.middle(), std::sqrt(square) * RADIUS_MARGIN);
}

/// Adds the boxes of instances whose prototypes have casters.
void add_instances(const Scene& scene, Part& all) {
    std::vector<PlacedBox> boxes;
    for (const Prototype& prototype : scene.prototypes)
        boxes.push_back(box_of_prototype(scene, prototype, [&](const Triangle& triangle) {
            return is_caster(scene.materials[triangle.material]);
        }));
    for (size_t i = 1; i < scene.instances.size(); ++i)
        if (const PlacedBox& box = boxes[scene.instances[i].prototype]; !box.is_empty()) {
            CasterCorners corners;
            for (const glm::dvec3& point : box.corners_in(scene.instances[i]))
                corners.points.push_back(point);
            for (const glm::dvec3& point : corners.points)
                corners.middle += point / double(corners.points.size());
            all.push_back(std::move(corners));
        }
}

/// The triangles on both sides of the plane through the middle of where they are widest apart.
std::pair<Part, Part> halves_of(Part part) {
    Box middles;
    for (const CasterCorners& corners : part)
        middles.add(corners.middle);
    const glm::dvec3 size = middles.high - middles.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto second = std::partition(part.begin(), part.end(), [&](const CasterCorners& corners) {
        return corners.middle[axis] < middles.middle()[axis];
    });
    return {Part(std::make_move_iterator(part.begin()), std::make_move_iterator(second)),
            Part(std::make_move_iterator(second), std::make_move_iterator(part.end()))};
}

/// The cheapest cover by spheres of all ways to halve the part.
std::vector<vec4> cover(Part part, int level) {
    std::vector<vec4> one{sphere_of(part)};
    if (level == LARGEST_LEVEL)
        return one;
    auto [first, second] = halves_of(std::move(part));
    if (first.empty() || second.empty())
        return one;
    std::vector<vec4> more = cover(std::move(first), level + 1);
    for (const vec4& sphere : cover(std::move(second), level + 1))
        more.push_back(sphere);
    return caster_squares(more) < LARGEST_SPLIT_SHARE * caster_squares(one) ? more : one;
}

} // namespace

bool is_smooth(const Material& material) {
    const bool may_be_smooth = material.alpha_x == 0 || material.map_roughness != NO_INDEX;
    return (material.lobes & LOBE_MIRROR) || ((material.lobes & LOBES_GLASS) && may_be_smooth);
}

bool is_caster(const Material& material) {
    if (is_smooth(material))
        return true;
    return (material.lobes & (LOBE_GLOSSY | LOBES_GLASS)) == LOBE_GLOSSY &&
           std::max(material.alpha_x, material.alpha_y) <= CASTER_LARGEST_ALPHA;
}

bool has_casters(const Scene& scene) {
    return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const Triangle& triangle) {
        return is_caster(scene.materials[triangle.material]);
    });
}

std::vector<vec4> find_casters(const Scene& scene) {
    Part all;
    const size_t own = own_triangle_count(scene.triangles, scene.prototypes);
    for (size_t i = 0; i < own; ++i)
        if (is_caster(scene.materials[scene.triangles[i].material]))
            all.push_back(caster_corners(scene, scene.triangles[i]));
    add_instances(scene, all);
    return all.empty() ? std::vector<vec4>() : cover(std::move(all), 0);
}

double caster_squares(const std::vector<vec4>& casters) {
    double sum = 0;
    for (const vec4& caster : casters)
        sum += double(CASTER_RADIUS(caster)) * double(CASTER_RADIUS(caster));
    return sum;
}

double caster_solid_angle(const std::vector<vec4>& casters, const glm::dvec3& point, double largest) {
    double sum = 0;
    for (const vec4& caster : casters) {
        const glm::dvec3 way = to_dvec3(caster) - point;
        const double sine_squared =
            double(CASTER_RADIUS(caster)) * double(CASTER_RADIUS(caster)) / glm::dot(way, way);
        const double one_minus_cos =
            sine_squared < 1 ? sine_squared / (1 + std::sqrt(1 - sine_squared)) : 2.0;
        sum += std::min(2 * PI * one_minus_cos, largest);
    }
    return sum;
}

} // namespace clrt
