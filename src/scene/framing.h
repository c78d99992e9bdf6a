// SPDX-License-Identifier: Apache-2.0
// The eye from which a scene fills the picture: as near as the picture's edges allow.
#pragma once

#include "scene/normalise.h"
#include "scene/scene.h"
#include "scene/view_frame.h"

#include <glm/vec2.hpp>
#include <optional>

namespace clrt {

/// Half the vertical and half the horizontal angle of view, as tangents.
struct ViewTangents {
    double vertical, horizontal;
};

/// Share of the picture that what is framed may take along the side where it is tight: 4 % stay free at
/// either end.
constexpr double FRAMED_SHARE = 0.92;

/// Distance of the eye from the nearest point at least, in radii of what is framed: the near end of a long
/// thing that points at the eye is then at most three times as large as the far one.
constexpr double LEAST_DISTANCE = 1;

/// Height of a film in parallel projection at least, in radii of what is framed: that of a long thing that
/// points at the eye.
constexpr double LEAST_HEIGHT = 0.1;

/// What the camera frames, and its middle.
struct Framed {
    bool without_floor = false; ///< a floor reaches out of the picture
    double floor_top = 0;       ///< along up, normalised frame: triangles that end below it are the floor
    std::optional<Bounds>
        lamps_within;     ///< lamps that reach out of it are far away, up frame; absent: none is
    Bounds box;           ///< of what is framed, axes of the up frame, normalised frame
    glm::dvec3 centre{0}; ///< of the box, normalised frame
};

/// Everything. `up` is a unit vector.
Framed frame_all(const Scene& scene, const glm::dvec3& up);

/// Everything, less lamps far away, beside whose distance the rest is small, and less a floor that is far
/// wider than what stands on it: triangles that lie in the lowest plane say nothing about where the scene is,
/// however far they reach. `up` is a unit vector.
Framed find_framed(const Scene& scene, const glm::dvec3& up);

/// The eye, in the normalised frame, from which a picture with these axes holds all that is framed with a
/// margin: the nearest one, and in the middle of those where the picture is wider than needed. Exact, from
/// the farthest points along the normals of the four planes that bound the view. Where `at` is given, the eye
/// lies on the line through it.
glm::dvec3 framing_eye(const Scene& scene, const Framed& framed, const glm::dvec3& up,
                       const PictureAxes& axes, const ViewTangents& view,
                       const std::optional<glm::dvec3>& at);

/// A film in parallel projection.
struct ParallelFilm {
    glm::dvec3 eye{0}; ///< its middle, before all that is framed, normalised frame
    double height = 0; ///< normalised frame
};

/// The smallest film with these axes, `aspect` times as wide as high, that holds all that is framed with a
/// margin; where `at` is given, its middle lies on the line through it.
ParallelFilm framing_film(const Scene& scene, const Framed& framed, const glm::dvec3& up,
                          const PictureAxes& axes, double aspect, const std::optional<glm::dvec3>& at);

} // namespace clrt
