// SPDX-License-Identifier: Apache-2.0
#include "scene/sky_portals.h"

#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>

namespace clrt {

namespace {

/// Paths that have met so many surfaces and more leave through what the sky lights those by.
constexpr float FEWEST_SURFACES = 1;
/// Of the paths that have met a surface, at most this part leaves from their first: more do out of doors.
constexpr double MOST_LEAVE_AT_ONCE = 0.4;
/// Escapes from which on a rectangle tells where its edges are, and what part of all it must have.
constexpr size_t FEWEST_ESCAPES = 24;
constexpr double SMALLEST_PART = 0.02;
/// Planes that are tried along an axis, and between the neighbours of the best of all, so many times; and
/// escapes that they are judged by.
constexpr int PLANES = 20, FINER_PLANES = 6, REFINEMENTS = 3;
constexpr size_t JUDGES = 1500;
/// Windows lie beyond most of the points that paths come from; walls outside are no further than so many
/// times as far as the outermost is from the middle one.
constexpr double LEAST_QUANTILE = 0.25, BEYOND = 0.25;
/// A gap divides a rectangle if it is this part of its side, and so many times as wide as the mean distance
/// of points along it: chance leaves no such gaps.
constexpr double WIDE_GAP = 0.04, CERTAIN_GAP = 12;
/// A strip along a side is cut off if what is left has so many times as many points cubed for its area: so
/// are strips with less than a third of the density of the others.
constexpr double WORTHWHILE_CUT = 1.1;
/// The last paths, with less than this part of the light of all, are left to the map's table and the BSDF.
constexpr double LAST_PART = 0.05;
/// Of the median luminance: what is brighter counts as this.
constexpr double BRIGHTEST = 16;
/// Paths that go nearly along a plane tell little about it.
constexpr double SMALLEST_COS = 0.1;
/// Planes that are taken, one after the other, at most.
constexpr int MOST_PLANES = 6;

struct Ray {
    glm::dvec3 origin, direction; ///< in the frame of the axes
    double luminance;
};

struct Rectangle {
    glm::dvec2 low, high;
    size_t points = 0;
    double area() const { return (high.x - low.x) * (high.y - low.y); }
};

/// A plane across an axis, and the rectangles in it.
struct Plane {
    int axis = 0;
    double sign = 1, place = 0; ///< paths leave towards sign * axis; the coordinate times the sign
    std::vector<Rectangle> rectangles;

    /// How well its first `count` rectangles show windows: many paths pass them close together.
    double merit(size_t count) const {
        double points = 0, area = 0;
        for (size_t i = 0; i < count; ++i) {
            points += double(rectangles[i].points);
            area += rectangles[i].area();
        }
        return points > 0 ? points * points / area : 0;
    }
    double merit() const { return merit(rectangles.size()); }
};

/// Where a path crosses a plane; false where it does not.
bool crossing(const Plane& plane, const Ray& ray, glm::dvec2& at) {
    const double speed = plane.sign * ray.direction[plane.axis];
    const double way = plane.place - plane.sign * ray.origin[plane.axis];
    if (speed < SMALLEST_COS || way < 0)
        return false;
    const glm::dvec3 p = ray.origin + ray.direction * (way / speed);
    at = {p[(plane.axis + 1) % 3], p[(plane.axis + 2) % 3]};
    return true;
}

using Points = std::vector<glm::dvec2>;
using PointRange = std::pair<Points::iterator, Points::iterator>;

size_t size_of(const PointRange& points) {
    return size_t(points.second - points.first);
}

/// A place along a side of a box: the points below it are another rectangle's than those above, or one of
/// the two is none's.
struct Cut {
    enum class Keeps { BOTH, BELOW, ABOVE } keeps = Keeps::BOTH;
    int axis = -1; ///< none
    double place = 0;
};

Rectangle box_of(const PointRange& points) {
    Rectangle box{*points.first, *points.first, size_of(points)};
    for (auto point = points.first; point != points.second; ++point) {
        box.low = glm::min(box.low, *point);
        box.high = glm::max(box.high, *point);
    }
    return box;
}

/// Where the points of a box are divided: at the widest gap or, where there is none, at the edge of the strip
/// without which they are densest. Ways through the windows of other walls cross a wall's plane beyond its
/// own windows, far apart.
Cut best_cut(const PointRange& points, const Rectangle& box, size_t fewest) {
    Cut gap, strip;
    double widest = std::max(WIDE_GAP, CERTAIN_GAP / double(box.points)), densest = WORTHWHILE_CUT;
    for (int axis = 0; axis < 2; ++axis) {
        std::sort(points.first, points.second,
                  [&](const glm::dvec2& a, const glm::dvec2& b) { return a[axis] < b[axis]; });
        const double low = box.low[axis], side = box.high[axis] - low;
        double last = 0; // of the side's length
        for (size_t below = 1; below < box.points; ++below) {
            const double at = points.first[long(below)][axis], place = (at - low) / side;
            if (place - last > widest) {
                widest = place - last;
                gap = {Cut::Keeps::BOTH, axis, at};
            }
            const auto take_denser = [&](Cut::Keeps keeps, size_t count, double length) {
                const double part = double(count) / double(box.points);
                if (count >= fewest && part * part * part > densest * length) {
                    densest = part * part * part / length;
                    strip = {keeps, axis, at};
                }
            };
            take_denser(Cut::Keeps::BELOW, below, last);
            take_denser(Cut::Keeps::ABOVE, box.points - below, 1 - place);
            last = place;
        }
    }
    return gap.axis >= 0 ? gap : strip;
}

/// Adds the boxes of the points, divided where they are to be, that have so many of them.
void add_rectangles(const PointRange& points, size_t fewest, std::vector<Rectangle>& rectangles) {
    if (size_of(points) < fewest)
        return;
    Rectangle box = box_of(points);
    const Cut cut = best_cut(points, box, fewest);
    if (cut.axis < 0) {
        // The edges are about as far beyond the outermost points as neighbours are from each other.
        const glm::dvec2 beyond = (box.high - box.low) / double(box.points);
        box.low -= beyond;
        box.high += beyond;
        rectangles.push_back(box);
        return;
    }
    const auto middle = std::partition(points.first, points.second,
                                       [&](const glm::dvec2& point) { return point[cut.axis] < cut.place; });
    if (cut.keeps != Cut::Keeps::ABOVE)
        add_rectangles({points.first, middle}, fewest, rectangles);
    if (cut.keeps != Cut::Keeps::BELOW)
        add_rectangles({middle, points.second}, fewest, rectangles);
}

/// The rectangles of a plane that show windows best together, each with `fewest` of the paths at least; of
/// all of them every `step`th is looked at.
void fill(const std::vector<Ray>& rays, size_t step, size_t fewest, Plane& plane) {
    Points points;
    glm::dvec2 at;
    for (size_t i = 0; i < rays.size(); i += step)
        if (crossing(plane, rays[i], at))
            points.push_back(at);
    std::vector<Rectangle>& rectangles = plane.rectangles;
    rectangles.clear();
    add_rectangles({points.begin(), points.end()}, std::max(fewest / step, FEWEST_ESCAPES / 4), rectangles);
    const auto density = [](const Rectangle& r) { return double(r.points) / r.area(); };
    std::sort(rectangles.begin(), rectangles.end(),
              [&](const Rectangle& a, const Rectangle& b) { return density(a) > density(b); });
    while (rectangles.size() > 1 && plane.merit(rectangles.size() - 1) > plane.merit())
        rectangles.pop_back();
}

/// A search for the plane through which most paths pass closest together.
class PlaneSearch {
public:
    PlaneSearch(const std::vector<Ray>& rays, size_t fewest)
        : rays_(rays), step_(std::max<size_t>(rays.size() / JUDGES, 1)), fewest_(fewest) {
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {-1.0, 1.0})
                look_along(axis, sign);
        for (int k = 0; k < REFINEMENTS && most_ > 0; ++k) {
            const Plane around = best_;
            distance_ /= FINER_PLANES / 2;
            for (int i = -FINER_PLANES / 2; i <= FINER_PLANES / 2; ++i)
                look_at(around.axis, around.sign, around.place + i * distance_);
        }
        fill(rays_, 1, fewest_, best_);
    }
    const Plane& best() const { return best_; }

private:
    void look_along(int axis, double sign) {
        std::vector<double> places;
        for (size_t i = 0; i < rays_.size(); i += step_)
            if (sign * rays_[i].direction[axis] > SMALLEST_COS)
                places.push_back(sign * rays_[i].origin[axis]);
        if (places.size() < FEWEST_ESCAPES / 4)
            return;
        std::sort(places.begin(), places.end());
        const double low = places[size_t(LEAST_QUANTILE * double(places.size()))], last = places.back();
        const double high = last + BEYOND * (last - places[places.size() / 2]);
        const double distance = (high - low) / PLANES;
        for (int k = 0; k <= PLANES; ++k)
            if (look_at(axis, sign, low + k * distance))
                distance_ = distance;
    }

    /// Whether a plane is better than all before.
    bool look_at(int axis, double sign, double place) {
        Plane plane{axis, sign, place, {}};
        fill(rays_, step_, fewest_, plane);
        const double found = plane.merit();
        if (!(found > most_))
            return false;
        most_ = found;
        best_ = std::move(plane);
        return true;
    }

    const std::vector<Ray>& rays_;
    size_t step_, fewest_;
    Plane best_;
    double most_ = 0, distance_ = 0;
};

/// Takes away the paths that pass one of a plane's rectangles.
void take_away(const Plane& plane, std::vector<Ray>& rays) {
    rays.erase(std::remove_if(rays.begin(), rays.end(),
                              [&](const Ray& ray) {
                                  glm::dvec2 at;
                                  return crossing(plane, ray, at) &&
                                         std::any_of(plane.rectangles.begin(), plane.rectangles.end(),
                                                     [&](const Rectangle& r) {
                                                         return at.x >= r.low.x && at.x <= r.high.x &&
                                                                at.y >= r.low.y && at.y <= r.high.y;
                                                     });
                              }),
               rays.end());
}

vec4 packed(const glm::dvec3& v, double w) {
    return {float(v.x), float(v.y), float(v.z), float(w)};
}

SkyPortal make_portal(const Plane& plane, const Rectangle& rectangle, const glm::dmat3& axes) {
    const int u = (plane.axis + 1) % 3, v = (plane.axis + 2) % 3;
    const glm::dvec2 size = rectangle.high - rectangle.low;
    const glm::dvec3 corner =
        axes[plane.axis] * (plane.sign * plane.place) + axes[u] * rectangle.low.x + axes[v] * rectangle.low.y;
    SkyPortal portal{};
    portal.corner = packed(corner, 0);
    portal.axis_u = packed(axes[u], size.x);
    portal.axis_v = packed(axes[v], size.y);
    portal.normal = packed(axes[plane.axis] * -plane.sign, 0);
    return portal;
}

/// Escapes from surfaces that see little of the sky.
bool is_from_within(const Escape& escape) {
    return escape.origin.w >= FEWEST_SURFACES;
}

/// Luminance beyond which what a path sees counts no more: few meet the sun, by chance.
double largest_luminance(const std::vector<Escape>& escapes) {
    std::vector<double> all;
    for (const Escape& escape : escapes)
        if (is_from_within(escape))
            all.push_back(double(escape.direction.w));
    if (all.empty())
        return 0;
    const auto middle = all.begin() + long(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return BRIGHTEST * *middle;
}

/// The paths that leave within, in the frame of the axes; none where there is no within.
std::vector<Ray> ways_out(const std::vector<Escape>& escapes, const glm::dmat3& axes) {
    std::vector<Ray> rays;
    const glm::dmat3 to_axes = glm::transpose(axes);
    const double largest = largest_luminance(escapes);
    double at_once = 0;
    for (const Escape& escape : escapes) {
        at_once += std::abs(escape.origin.w) == FEWEST_SURFACES ? 1 : 0;
        if (!is_from_within(escape))
            continue;
        rays.push_back({to_axes * to_dvec3(escape.origin), to_axes * to_dvec3(escape.direction),
                        std::fmin(double(escape.direction.w), largest)});
    }
    if (at_once > MOST_LEAVE_AT_ONCE * double(escapes.size()))
        rays.clear();
    return rays;
}

double light_of(const std::vector<Ray>& rays) {
    double sum = 0;
    for (const Ray& ray : rays)
        sum += ray.luminance;
    return sum;
}

} // namespace

glm::dmat3 scene_axes(const Scene& scene) {
    // Normals as long as the areas of their triangles; what lies across the main axis turns about it.
    std::vector<glm::dvec3> normals;
    glm::dvec3 squares(0);
    for (const Triangle& triangle : scene.triangles) {
        const glm::dvec3 p = to_dvec3(scene.positions[triangle.v0]);
        const glm::dvec3 normal = glm::cross(to_dvec3(scene.positions[triangle.v1]) - p,
                                             to_dvec3(scene.positions[triangle.v2]) - p);
        const double area = glm::length(normal);
        if (!(area > 0))
            continue;
        normals.push_back(normal);
        squares += normal * normal * normal * normal / (area * area * area);
    }
    const int up = squares.x > squares.y && squares.x > squares.z ? 0 : squares.y >= squares.z ? 1 : 2;
    const int u = (up + 1) % 3, v = (up + 2) % 3;
    double cosines = 0, sines = 0;
    for (const glm::dvec3& normal : normals) {
        const double angle = std::atan2(normal[v], normal[u]), area = std::hypot(normal[u], normal[v]);
        cosines += area * std::cos(4 * angle);
        sines += area * std::sin(4 * angle);
    }
    const double turn = std::atan2(sines, cosines) / 4;
    glm::dmat3 axes(1.0);
    axes[u] = axes[v] = glm::dvec3(0);
    axes[u][u] = axes[v][v] = std::cos(turn);
    axes[u][v] = std::sin(turn);
    axes[v][u] = -std::sin(turn);
    return axes;
}

std::vector<SkyPortal> find_portals(const std::vector<Escape>& escapes, const glm::dmat3& axes) {
    std::vector<Ray> rays = ways_out(escapes, axes);
    const size_t fewest = std::max(size_t(SMALLEST_PART * double(rays.size())), FEWEST_ESCAPES);
    std::vector<SkyPortal> portals;
    const double all = light_of(rays);
    for (int k = 0; k < MOST_PLANES && rays.size() >= fewest && light_of(rays) >= LAST_PART * all; ++k) {
        const Plane plane = PlaneSearch(rays, fewest).best();
        if (plane.rectangles.empty() || portals.size() + plane.rectangles.size() > MOST_PORTALS)
            break;
        take_away(plane, rays);
        for (const Rectangle& rectangle : plane.rectangles)
            portals.push_back(make_portal(plane, rectangle, axes));
    }
    return portals;
}

SkyThroughPortals light_through(const std::vector<SkyPortal>& portals, const std::vector<Escape>& escapes) {
    const double largest = largest_luminance(escapes);
    double light = 0, ways_out = 0, ways = 0, area = 0;
    for (const Escape& escape : escapes) {
        // One that has never left has no direction; one from the open has no way more from within.
        const bool is_lost = escape.direction.x == 0 && escape.direction.y == 0 && escape.direction.z == 0;
        const double surfaces = is_lost ? ESCAPE_SEGMENTS - 1 : std::abs(double(escape.origin.w));
        ways += is_lost || is_from_within(escape) ? surfaces : std::fmax(surfaces - 1, 0.0);
        if (is_from_within(escape)) {
            light += std::fmin(double(escape.direction.w), largest);
            ways_out += 1;
        }
    }
    for (const SkyPortal& portal : portals)
        area += double(portal.axis_u.w) * double(portal.axis_v.w);
    // Ways are chosen by the cosine.
    return ways_out > 0 ? SkyThroughPortals{PI * light / ways, PI * light / ways_out * area}
                        : SkyThroughPortals{};
}

} // namespace clrt
