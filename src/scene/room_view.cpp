// SPDX-License-Identifier: Apache-2.0
#include "scene/room_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace clrt {
namespace {

/// Points of the lattice along each axis of the box.
constexpr int LATTICE = 9;
/// Rays from a point of the lattice to all sides.
constexpr int SPHERE_RAYS = 64;
/// A point lies in a room when so many of them meet a front.
constexpr double ENCLOSED = 0.85;
/// A room is at least this part of the lattice's free points: hollow things have small cavities.
constexpr double ROOMY = 0.1;
/// Rays from outside per side of a face.
constexpr int OUTSIDE_GRID = 16;
/// A side shows nothing when so many of its rays end at backs, or in one plane at the box's face.
constexpr double BLIND = 0.7;
/// Of the box's size: how far from the face that plane may lie.
constexpr double NEAR_SIDE = 0.05;
/// A side is open when so many of its rays get so deep into the box, of its size.
constexpr double OPEN = 0.6, DEEP = 0.3;
/// Blind sides of a room at least.
constexpr int BLIND_SIDES_WITH_LAMPS = 4, BLIND_SIDES_WITHOUT = 5;
/// So many of them in one plane without lamps: things whose fronts are inside by mistake are no boxes.
constexpr int PLANE_SIDES = 3;
/// Where eyes may be, from the middle of the box along up, as a share of its height.
constexpr double EYE_HEIGHTS = 0.2;
/// Free cells around the eye.
constexpr double ELBOW_ROOM = 3;
/// Directions around, and levels of each, that a view is chosen from.
constexpr int AZIMUTHS = 48, LEVELS = 9;
/// What backs are worth to a view, beside fronts.
constexpr double BACK_WORTH = 0.3;
/// What things before one another are worth, beside the depth of what is seen.
constexpr double RICHNESS = 3;
/// And what things are worth that are no walls: who looks across a room at a bare one sees far and nothing.
constexpr double FURNISHED = 1.2;
/// Cells of the grid that a wall may fill beside the box's face.
constexpr double WALL_CELLS = 2;
/// Tangent of the angle by which the eye looks down: floors have more on them than ceilings.
constexpr double LOOK_DOWN = 0.12;

/// Directions spread evenly over the sphere (Fibonacci lattice).
glm::dvec3 sphere_direction(int i) {
    const double z = 1 - (i + 0.5) * 2 / SPHERE_RAYS, r = std::sqrt(1 - z * z);
    const double angle = i * glm::pi<double>() * (3 - std::sqrt(5.));
    return {r * std::cos(angle), z, r * std::sin(angle)};
}

/// What rays to all sides find.
struct RaysAround {
    double fronts = 0;  ///< share of the rays
    double nearest = 0; ///< distance
};

RaysAround cast_around(const VoxelGrid& grid, const glm::dvec3& p) {
    RaysAround around{0, glm::length(grid.box().high - grid.box().low)};
    for (int i = 0; i < SPHERE_RAYS; ++i) {
        const VoxelGrid::Hit hit = grid.cast(p, sphere_direction(i));
        around.fronts += double(hit.is_hit && hit.is_front) / SPHERE_RAYS;
        around.nearest = std::min(around.nearest, hit.distance);
    }
    return around;
}

glm::dvec3 lattice_point(const Bounds& box, int i, int j, int k) {
    return box.low + (box.high - box.low) * (glm::dvec3(i, j, k) + 0.5) / double(LATTICE);
}

/// Casts a lattice of rays from outside through a face of the box and calls see(hit, depth): the depth in the
/// box, as a share of its size.
template <class See>
void look_through(const VoxelGrid& grid, const BoxFace& side, const See& see) {
    const Bounds& box = grid.box();
    const glm::dvec3 size = box.high - box.low;
    const int axis = side.axis, u = (axis + 1) % 3, v = (axis + 2) % 3;
    glm::dvec3 direction(0), origin;
    direction[axis] = -side.sign;
    origin[axis] = (side.sign > 0 ? box.high : box.low)[axis] + side.sign * size[axis];
    for (int i = 0; i < OUTSIDE_GRID; ++i)
        for (int j = 0; j < OUTSIDE_GRID; ++j) {
            origin[u] = box.low[u] + size[u] * (i + 0.5) / OUTSIDE_GRID;
            origin[v] = box.low[v] + size[v] * (j + 0.5) / OUTSIDE_GRID;
            const VoxelGrid::Hit hit = grid.cast(origin, direction);
            see(hit, hit.distance / size[axis] - 1);
        }
}

/// Sides of the box that show nothing from outside.
struct BlindSides {
    int all = 0;    ///< backs of walls, or one plane
    int planes = 0; ///< of them: in one plane at the box's face
    int backs = 0;  ///< of them: backs
};

BlindSides count_blind_sides(const VoxelGrid& grid) {
    BlindSides blind;
    for (const BoxFace& side : BOX_FACES) {
        int hits = 0, backs = 0, planes = 0, either = 0;
        look_through(grid, side, [&](const VoxelGrid::Hit& hit, double depth) {
            const bool is_plane = depth < NEAR_SIDE;
            hits += hit.is_hit;
            backs += hit.is_hit && hit.is_back;
            planes += hit.is_hit && is_plane;
            either += hit.is_hit && (hit.is_back || is_plane);
        });
        if (hits == 0 || either < BLIND * hits)
            continue;
        ++blind.all;
        blind.planes += planes >= BLIND * hits;
        blind.backs += backs >= BLIND * hits;
    }
    return blind;
}

/// Lamps tell rooms from other boxes.
bool may_be_room(const VoxelGrid& grid, bool has_lamps) {
    const BlindSides blind = count_blind_sides(grid);
    return has_lamps ? blind.all >= BLIND_SIDES_WITH_LAMPS
                     : blind.all >= BLIND_SIDES_WITHOUT && blind.planes >= PLANE_SIDES && blind.backs > 0;
}

/// How far one sees to all sides, what that is worth, nothing where the room is open, and where things are
/// (1).
struct Panorama {
    std::array<std::array<double, LEVELS>, AZIMUTHS> depth{}, worth{}, things{};
};

/// Whether a point lies further in than the walls along the box's faces.
bool is_within_walls(const VoxelGrid& grid, const glm::dvec3& p) {
    const Bounds& box = grid.box();
    const glm::dvec3 size = box.high - box.low;
    for (int axis = 0; axis < 3; ++axis) {
        const double wall = std::max(NEAR_SIDE * size[axis], WALL_CELLS * grid.cell());
        if (p[axis] < box.low[axis] + wall || p[axis] > box.high[axis] - wall)
            return false;
    }
    return true;
}

glm::dvec3 view_direction(const glm::dmat3& frame, int azimuth) {
    const double angle = 2 * glm::pi<double>() * azimuth / AZIMUTHS;
    return frame[0] * std::sin(angle) + frame[2] * std::cos(angle) - frame[1] * LOOK_DOWN;
}

Panorama look_around_level(const VoxelGrid& grid, const glm::dvec3& p, const glm::dmat3& frame,
                           double tangent) {
    Panorama panorama;
    for (int a = 0; a < AZIMUTHS; ++a)
        for (int l = 0; l < LEVELS; ++l) {
            const double slope = tangent * ((l + 0.5) * 2 / LEVELS - 1);
            const glm::dvec3 direction = glm::normalize(view_direction(frame, a) + frame[1] * slope);
            const VoxelGrid::Hit hit = grid.cast(p, direction);
            panorama.depth[size_t(a)][size_t(l)] = hit.distance;
            panorama.worth[size_t(a)][size_t(l)] =
                hit.is_hit ? hit.distance * (hit.is_front ? 1 : BACK_WORTH) : 0;
            panorama.things[size_t(a)][size_t(l)] =
                hit.is_hit && is_within_walls(grid, p + direction * hit.distance);
        }
    return panorama;
}

/// Share of a depth that a neighbour's lies before or behind it.
double step_between(double a, double b) {
    return std::fabs(a - b) / std::max(a, b);
}

/// A direction from a point, and how good it is.
struct Outlook {
    double worth = -1;
    glm::dvec3 direction{0};
    double depth = 0; ///< mean
};

/// What a picture shows whose middle is at an azimuth and which reaches `beside` azimuths to either side.
Outlook look_at(const Panorama& panorama, const glm::dmat3& frame, int azimuth, int beside) {
    const double rays = double(2 * beside + 1) * LEVELS;
    double worth = 0, depth = 0, steps = 0, things = 0;
    for (int b = azimuth - beside; b <= azimuth + beside; ++b)
        for (size_t l = 0; l < LEVELS; ++l) {
            const auto column = size_t((b + AZIMUTHS) % AZIMUTHS),
                       next = size_t((b + 1 + AZIMUTHS) % AZIMUTHS);
            const double here = panorama.depth[column][l];
            worth += panorama.worth[column][l] / rays;
            depth += here / rays;
            steps += step_between(here, panorama.depth[next][l]) / rays;
            things += panorama.things[column][l] / rays;
        }
    return {worth * (1 + RICHNESS * steps + FURNISHED * things), view_direction(frame, azimuth), depth};
}

/// The direction in which a picture shows most.
Outlook best_outlook(const VoxelGrid& grid, const glm::dvec3& p, const glm::dmat3& frame,
                     const ViewTangents& view) {
    const Panorama panorama = look_around_level(grid, p, frame, view.vertical);
    const int beside = int(std::atan(view.horizontal) / (2 * glm::pi<double>()) * AZIMUTHS);
    Outlook best;
    for (int a = 0; a < AZIMUTHS; ++a) {
        const Outlook outlook = look_at(panorama, frame, a, beside);
        if (outlook.worth > best.worth)
            best = outlook;
    }
    return best;
}

} // namespace

bool is_open(const VoxelGrid& grid, const BoxFace& side) {
    int deep = 0;
    look_through(grid, side, [&](const VoxelGrid::Hit&, double depth) { deep += depth > DEEP; });
    return deep >= OPEN * OUTSIDE_GRID * OUTSIDE_GRID;
}

std::optional<RoomView> find_room_view(const VoxelGrid& grid, bool has_lamps, const glm::dvec3& up,
                                       const ViewTangents& view) {
    if (!may_be_room(grid, has_lamps))
        return std::nullopt;
    const Bounds& box = grid.box();
    const glm::dmat3 frame = up_frame(up);
    const double height = glm::dot(glm::abs(up), box.high - box.low);
    int free = 0, enclosed = 0;
    Outlook best;
    glm::dvec3 eye(0);
    for (int i = 0; i < LATTICE; ++i)
        for (int j = 0; j < LATTICE; ++j)
            for (int k = 0; k < LATTICE; ++k) {
                const glm::dvec3 p = lattice_point(box, i, j, k);
                if (!grid.is_free(p))
                    continue;
                ++free;
                const RaysAround around = cast_around(grid, p);
                if (around.fronts < ENCLOSED)
                    continue;
                ++enclosed;
                if (around.nearest < ELBOW_ROOM * grid.cell() ||
                    std::fabs(glm::dot(p - box.centre(), up)) > EYE_HEIGHTS * height)
                    continue;
                const Outlook outlook = best_outlook(grid, p, frame, view);
                if (outlook.worth > best.worth) {
                    best = outlook;
                    eye = p;
                }
            }
    if (best.worth <= 0 || enclosed < ROOMY * free)
        return std::nullopt;
    return RoomView{eye, eye + best.direction * best.depth};
}

} // namespace clrt
