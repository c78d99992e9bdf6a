// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_fit.h"

#include "error.h"
#include "scene/vectors.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

constexpr double DEFAULT_FOV_DEGREES = 40;
constexpr double MARGIN = 1.05;    // free space around what is fitted
constexpr double NEAR_FACE = 0.05; // of the box's size: how far a wall may lie from the box's face
constexpr double COVERED = 0.6;    // a face with this much wall counts as closed: windows and doors are open
constexpr int GRID = 16;           // points per side of a face
constexpr double INSIDE = 0.9;     // of the half size: where the eye stands in a closed room
constexpr double PARALLEL = 1e-6;  // sine of the angle below which up and look are parallel
constexpr double RESOLVED_PITCH =
    2.4e-7; // radians between rays of single precision that differ, four units of roundoff
const glm::dvec3 THREE_QUARTER_VIEW(0.5, 0.35, 1);

/// A face of a box: the axis it is perpendicular to and its end.
struct Face {
    int axis;
    double sign;
};
constexpr Face FACES[6] = {{2, 1}, {2, -1}, {0, 1}, {0, -1}, {1, 1}, {1, -1}};

using Cells = std::bitset<GRID * GRID>;

/// Twice the signed area of (a, b, p).
double edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Marks the grid's points that lie in a triangle given in grid coordinates (a cell is 1x1, points at the
/// centres).
void mark_cells(Cells& cells, const glm::dvec2 (&corner)[3]) {
    const auto [low_x, high_x] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [low_y, high_y] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    const int x0 = std::max(0, int(low_x - 0.5)), x1 = std::min(GRID - 1, int(high_x + 0.5));
    const int y0 = std::max(0, int(low_y - 0.5)), y1 = std::min(GRID - 1, int(high_y + 0.5));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const glm::dvec2 p(x + 0.5, y + 0.5);
            const double e0 = edge(corner[0], corner[1], p), e1 = edge(corner[1], corner[2], p),
                         e2 = edge(corner[2], corner[0], p);
            if ((e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0))
                cells.set(size_t(y * GRID + x));
        }
}

struct Corners {
    glm::dvec3 p[3];
};

/// Component `axis` of the triangle's normal, of any length.
double normal_along(const Corners& corners, int axis) {
    return glm::cross(corners.p[1] - corners.p[0], corners.p[2] - corners.p[0])[axis];
}

/// Marks what one triangle covers of one face, if it lies near the face and its front looks into the box.
void cover_face(Cells& cells, const Face& face, const Corners& corners, const Bounds& box) {
    const glm::dvec3 size = box.high - box.low;
    const double plane = face.sign > 0 ? box.high[face.axis] : box.low[face.axis];
    const int u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
    glm::dvec2 on_grid[3];
    for (int i = 0; i < 3; ++i) {
        if (std::fabs(corners.p[i][face.axis] - plane) > NEAR_FACE * size[face.axis])
            return;
        on_grid[i] = {(corners.p[i][u] - box.low[u]) / size[u] * GRID,
                      (corners.p[i][v] - box.low[v]) / size[v] * GRID};
    }
    if (normal_along(corners, face.axis) * face.sign < 0)
        mark_cells(cells, on_grid);
}

Corners corners_of(const std::vector<vec4>& positions, const Triangle& triangle) {
    Corners corners;
    const u32 index[3] = {triangle.v0, triangle.v1, triangle.v2};
    for (int i = 0; i < 3; ++i)
        corners.p[i] = {positions[index[i]].x, positions[index[i]].y, positions[index[i]].z};
    return corners;
}

constexpr size_t GRAIN = 1 << 14; // triangles per task

Bounds bounds_of(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles) {
    const double most = std::numeric_limits<double>::max();
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, triangles.size(), GRAIN), Bounds{glm::dvec3(most), glm::dvec3(-most)},
        [&](const tbb::blocked_range<size_t>& range, Bounds box) {
            for (size_t i = range.begin(); i < range.end(); ++i)
                for (const glm::dvec3& p : corners_of(positions, triangles[i]).p) {
                    box.low = glm::min(box.low, p);
                    box.high = glm::max(box.high, p);
                }
            return box;
        },
        [](const Bounds& a, const Bounds& b) {
            return Bounds{glm::min(a.low, b.low), glm::max(a.high, b.high)};
        });
}

using FaceCells = std::array<Cells, 6>;

FaceCells merge(FaceCells a, const FaceCells& b) {
    for (size_t f = 0; f < 6; ++f)
        a[f] |= b[f];
    return a;
}

/// Half the vertical and half the horizontal angle of view, as tangents.
struct ViewTangents {
    double vertical, horizontal;
};

ViewTangents view_tangents(double fov_degrees, glm::ivec2 size) {
    const double vertical = std::tan(glm::radians(fov_degrees) / 2);
    return {vertical, vertical * size.x / size.y};
}

/// The distance from which a sphere fits into the narrower angle of view.
double sphere_distance(double radius, const ViewTangents& view) {
    const double half_angle = std::atan(std::min(view.vertical, view.horizontal));
    return MARGIN * radius / std::sin(half_angle);
}

/// In front of a room's open side, so that the opening fills the picture; inside if there is none.
glm::dvec3 eye_for_room(const Bounds& bounds, const BoxCover& cover, const ViewTangents& view) {
    const size_t open = size_t(std::min_element(cover.begin(), cover.end()) - cover.begin());
    const Face face = FACES[open];
    const glm::dvec3 half = (bounds.high - bounds.low) * 0.5;
    glm::dvec3 eye = bounds.centre();
    if (cover[open] >= COVERED) {
        eye[face.axis] += face.sign * INSIDE * half[face.axis];
        return eye;
    }
    // Seen along an axis with +Y up, the picture's height is y (z when looking along y), its width the other
    // one.
    const double height = face.axis == 1 ? half.z : half.y, width = face.axis == 0 ? half.z : half.x;
    const double distance = MARGIN * std::max(height / view.vertical, width / view.horizontal);
    eye[face.axis] += face.sign * (half[face.axis] + distance);
    return eye;
}

glm::dvec3 fitted_eye(const glm::dvec3& at, const Bounds& bounds, const BoxCover& cover,
                      const ViewTangents& view) {
    const auto closed = std::count_if(cover.begin(), cover.end(), [](double c) { return c >= COVERED; });
    if (closed >= 4) {
        const glm::dvec3 eye = eye_for_room(bounds, cover, view);
        if (eye != at)
            return eye;
    }
    // A sphere around `at` that holds the box; a box that is a single point is seen from a distance for
    // radius 1.
    const double radius = bounds.radius() + glm::distance(at, bounds.centre());
    const double distance = sphere_distance(radius > 0 ? radius : 1, view);
    return at + glm::normalize(THREE_QUARTER_VIEW) * distance;
}

/// Another up vector where the wanted one points along the view: the picture's right stays +X.
glm::dvec3 up_beside(const glm::dvec3& look) {
    if (std::fabs(look.y) > std::max(std::fabs(look.x), std::fabs(look.z)))
        return {0, 0, look.y < 0 ? -1 : 1};
    return {0, 1, 0};
}

void check_vector(const std::optional<glm::dvec3>& v, const char* option) {
    if (v && !is_finite(*v))
        throw UsageError(fmt::format("{}: expected three finite numbers, found {}", option, triple(*v)));
}

} // namespace

BoxCover measure_box_cover(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles) {
    BoxCover cover{};
    const Bounds box = bounds_of(positions, triangles);
    const glm::dvec3 size = box.high - box.low;
    if (!(size.x > 0 && size.y > 0 && size.z > 0))
        return cover; // nothing, or flat: no room
    const FaceCells cells = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, triangles.size(), GRAIN), FaceCells{},
        [&](const tbb::blocked_range<size_t>& range, FaceCells marked) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const Corners corners = corners_of(positions, triangles[i]);
                for (size_t f = 0; f < 6; ++f)
                    cover_face(marked[f], FACES[f], corners, box);
            }
            return marked;
        },
        merge);
    for (size_t f = 0; f < 6; ++f)
        cover[f] = double(cells[f].count()) / (GRID * GRID);
    return cover;
}

double field_of_view(const CameraOptions& options, glm::ivec2 size) {
    if (options.focal_length.has_value() != options.film_width.has_value())
        throw UsageError(
            "--focal-length and --film-width: expected both, found one; they give the angle of view "
            "together");
    double fov = options.fov_degrees.value_or(DEFAULT_FOV_DEGREES);
    if (options.focal_length) {
        const double focal = *options.focal_length, film = *options.film_width;
        if (!(std::isfinite(focal) && focal > 0 && std::isfinite(film) && film > 0))
            throw UsageError(fmt::format(
                "--focal-length, --film-width: expected lengths above 0, found {} and {}", focal, film));
        fov = glm::degrees(2 * std::atan(film * size.y / (2.0 * size.x * focal)));
    }
    if (!(fov > 0 && fov < 180))
        throw UsageError(fmt::format("--fov: expected an angle between 0 and 180 degrees, found {}", fov));
    return fov;
}

Camera fit_camera(const CameraOptions& options, glm::ivec2 size, const Bounds& bounds, const BoxCover& cover,
                  NoticeList& notices) {
    check_vector(options.eye, "--eye");
    check_vector(options.at, "--at");
    check_vector(options.up, "--up");
    if (options.up && *options.up == glm::dvec3(0))
        throw UsageError("--up: expected a direction, found 0,0,0");

    Camera camera;
    camera.fov_degrees = field_of_view(options, size);
    camera.at = options.at.value_or(bounds.centre());
    camera.eye = options.eye ? *options.eye
                             : fitted_eye(camera.at, bounds, cover, view_tangents(camera.fov_degrees, size));
    if (options.eye && !options.at && camera.eye == camera.at)
        camera.at.z -= bounds.radius() > 0 ? bounds.radius() : 1;
    if (camera.eye == camera.at)
        throw UsageError(
            fmt::format("--eye and --at: expected two different points, found {} twice", triple(camera.eye)));

    camera.up = options.up.value_or(glm::dvec3(0, 1, 0));
    const glm::dvec3 look = glm::normalize(camera.at - camera.eye);
    if (glm::length(glm::cross(look, glm::normalize(camera.up))) < PARALLEL) {
        const glm::dvec3 up = up_beside(look);
        notices.add(fmt::format("camera: --up {} points along the view, {} is taken instead",
                                triple(camera.up), triple(up)));
        camera.up = up;
    }
    const double pitch = 2 * std::tan(glm::radians(camera.fov_degrees) / 2) / size.y;
    if (pitch < RESOLVED_PITCH)
        notices.add(fmt::format(
            "camera: --fov {} puts pixels {:.1e} radians apart, rays of single precision differ from "
            "{:.1e} on: neighbours show the same",
            camera.fov_degrees, pitch, RESOLVED_PITCH));
    if (!options.eye || !options.at)
        notices.add(fmt::format("camera: --eye {} --at {} --up {} --fov {}", triple(camera.eye),
                                triple(camera.at), triple(camera.up), camera.fov_degrees));
    return camera;
}

} // namespace clrt
