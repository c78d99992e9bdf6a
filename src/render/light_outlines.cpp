// SPDX-License-Identifier: Apache-2.0
#include "render/light_outlines.h"

#include "scene/casters.h"
#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <utility>

namespace clrt {

namespace {

/// Triangles are cut off nearer to the camera than this share of the scene's extent.
constexpr double NEAREST_SHARE = 1e-6;

/// Lights are small whose rectangles have sides of less than so many pixels, the film's margin included:
/// probes meet larger ones.
constexpr double SMALL_SIDE = 4;

/// The largest shares of the window's pixels in which emission comes by rays though probes find no light: of
/// those around small lights, and of those that may see smooth surfaces, where rays are longer. A share of .1
/// costs 1.6 camera rays a sample.
constexpr double FEW_SMALL = 0.1, FEW_MIRRORS = 0.05;

/// Points of a triangle on the film, pixels right of and below the picture's centre.
struct FilmBox {
    glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec2& point, double margin) {
        low = glm::min(low, point - margin);
        high = glm::max(high, point + margin);
    }
};

/// Projects through a perspective or an orthographic camera that stands still.
class FilmProjection {
public:
    explicit FilmProjection(const RenderParams& params)
        : camera_(params.camera), look_(to_dvec3(camera_.look)), right_(to_dvec3(camera_.film_dx)),
          down_(to_dvec3(camera_.film_dy)), eye_(to_dvec3(camera_.eye)),
          volume_(glm::dot(look_, glm::cross(right_, down_))),
          nearest_(NEAREST_SHARE * double(params.scene_extent)),
          margin_(double(params.filter_radius) + double(params.patch_last)) {}

    /// Around a triangle.
    FilmBox box(const std::array<glm::dvec3, 3>& corners) const {
        FilmBox box;
        for (size_t i = 0; i < 3; ++i) {
            const glm::dvec3 from = corners[i] - eye_, to = corners[(i + 1) % 3] - eye_;
            const double near = depth(from), far = depth(to);
            if (!is_perspective() || near >= nearest_)
                add(from, box);
            if (is_perspective() && (near >= nearest_) != (far >= nearest_))
                add(from + (to - from) * ((nearest_ - near) / (far - near)), box);
        }
        return box;
    }

private:
    bool is_perspective() const { return camera_.projection == PROJECTION_PERSPECTIVE; }

    /// Along the axis, in units of the vector look, whatever the film's angle to it.
    double depth(const glm::dvec3& way) const { return glm::dot(way, glm::cross(right_, down_)) / volume_; }

    /// A point of the lens moves what is out of focus on the film.
    void add(const glm::dvec3& way, FilmBox& box) const {
        const double scale = is_perspective() ? 1 / std::max(depth(way), nearest_) : 1;
        const double blur = is_perspective() ? std::abs(scale - double(camera_.inverse_focus))
                                             : std::abs(1 - depth(way) * double(camera_.inverse_focus));
        const double lens = double(camera_.lens_radius) / std::min(camera_.pixel_x, camera_.pixel_y);
        const glm::dvec2 film(glm::dot(way, glm::cross(down_, look_)),
                              glm::dot(way, glm::cross(look_, right_)));
        const glm::dvec2 shift(camera_.shift_x, camera_.shift_y);
        box.add(film / volume_ * scale - shift, margin_ + (lens > 0 ? lens * blur : 0));
    }

    const CameraParams& camera_;
    glm::dvec3 look_, right_, down_, eye_;
    double volume_, nearest_, margin_;
};

/// The pixels of a window that are inside of boxes. A box costs the same whatever its size.
class WindowCover {
public:
    explicit WindowCover(const RenderParams& params)
        : width_(params.crop_width), height_(params.crop_height),
          corner_(double(params.width) / 2 - params.crop_x, double(params.height) / 2 - params.crop_y),
          changes_((width_ + 1) * (height_ + 1)) {}

    void add(const FilmBox& box) {
        const size_t left = index(box.low.x + corner_.x, width_), top = index(box.low.y + corner_.y, height_);
        const size_t right = index(std::ceil(box.high.x + corner_.x), width_);
        const size_t bottom = index(std::ceil(box.high.y + corner_.y), height_);
        if (left >= right || top >= bottom)
            return;
        ++at(left, top), --at(right, top), --at(left, bottom), ++at(right, bottom);
    }

    /// Of all pixels, whether they are inside of one; each sum of changes is that of the pixels above, and of
    /// those to the left.
    std::vector<bool> covered() {
        std::vector<bool> found(width_ * height_);
        for (size_t y = 0; y < height_; ++y)
            for (size_t x = 0; x < width_; ++x) {
                at(x, y) += (x ? at(x - 1, y) : 0) + (y ? at(x, y - 1) : 0) - (x && y ? at(x - 1, y - 1) : 0);
                found[y * width_ + x] = at(x, y) != 0;
            }
        return found;
    }

private:
    static size_t index(double position, size_t count) {
        return position > 0 ? size_t(std::min(position, double(count))) : 0; // 0, too, for a NaN
    }
    std::int32_t& at(size_t x, size_t y) { return changes_[y * (width_ + 1) + x]; }

    size_t width_, height_;
    glm::dvec2 corner_; ///< the picture's centre, from the window's corner
    std::vector<std::int32_t> changes_;
};

bool is_projected(const CameraParams& camera) {
    return (camera.projection == PROJECTION_PERSPECTIVE || camera.projection == PROJECTION_ORTHOGRAPHIC) &&
           camera.moves == 0;
}

std::array<glm::dvec3, 3> corners_of(const Scene& scene, const Triangle& t) {
    return {to_dvec3(scene.positions[t.v0]), to_dvec3(scene.positions[t.v1]),
            to_dvec3(scene.positions[t.v2])};
}

/// Adds bits to the states of the pixels that are covered, unless they are more than a share of all.
void add_to_few(WindowCover cover, double largest_share, unsigned bits, std::vector<std::uint8_t>& states) {
    const std::vector<bool> covered = cover.covered();
    const double count = double(std::count(covered.begin(), covered.end(), true));
    for (size_t i = 0; i < states.size(); ++i)
        if (covered[i] && count <= largest_share * double(states.size()))
            states[i] = std::uint8_t(states[i] | bits);
}

/// What may show the images of lights and stands still.
WindowCover cover_of_mirrors(const Scene& scene, const RenderParams& params,
                             const FilmProjection& projection) {
    WindowCover mirrors(params);
    if (scene.prototypes.empty() && scene.position_moves.empty())
        for (const Triangle& triangle : scene.triangles)
            if (is_smooth(scene.materials[triangle.material]))
                mirrors.add(projection.box(corners_of(scene, triangle)));
    return mirrors;
}

} // namespace

std::vector<std::uint8_t> find_light_outlines(const Scene& scene, const RenderParams& params) {
    if (scene.emitters.empty() || EMISSION_RAYS(params) <= 1 || !is_projected(params.camera))
        return {};
    const FilmProjection projection(params);
    WindowCover lights(params), small(params);
    for (const Emitter& emitter : scene.emitters) {
        const FilmBox box = projection.box(corners_of(scene, scene.triangles[emitter.triangle]));
        lights.add(box);
        if (std::max(box.high.x - box.low.x, box.high.y - box.low.y) < SMALL_SIDE)
            small.add(box);
    }
    std::vector<std::uint8_t> states(size_t(params.crop_width) * params.crop_height, EMISSION_BY_PATHS);
    add_to_few(std::move(lights), 1, EMISSION_OPEN, states);
    add_to_few(std::move(small), FEW_SMALL, EMISSION_SMALL, states);
    if (params.path_choices & MIRRORS_SHOW_EMISSION)
        add_to_few(cover_of_mirrors(scene, params, projection), FEW_MIRRORS,
                   EMISSION_OPEN | EMISSION_SMALL | EMISSION_GOES_ON, states);
    return states;
}

} // namespace clrt
