// SPDX-License-Identifier: Apache-2.0
// Light that is no part of the scene.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// The sun: a disc at infinity.
struct SunOptions {
    glm::dvec3 towards{0, 1, 0};  ///< direction to the sun, any length but 0
    glm::dvec3 irradiance{0};     ///< at normal incidence, linear RGB
    double diameter_degrees = 0;  ///< angular diameter; 0 is a delta light
    const char* source = "--sun"; ///< by what it is there, in messages
};

/// The cone in which a spot light shines: by all of its intensity up to the inner angle from the axis, not at
/// all from the outer one on, in between by the square of (cos a - cos outer) / (cos inner - cos outer), as
/// glTF's KHR_lights_punctual has it.
struct SpotCone {
    glm::dvec3 direction{0, 0, -1}; ///< in which it shines, any length but 0
    double outer_degrees = 45;      ///< 0 to 180; 0: no light
    double inner_degrees = 0;       ///< 0 to the outer angle
};

/// A point light, or a spot.
struct PointOptions {
    glm::dvec3 position{0};         ///< scene units
    glm::dvec3 intensity{0};        ///< W/sr per channel, lengths in scene units
    std::optional<SpotCone> cone{}; ///< absent: it shines all around
    const char* source = "--point"; ///< by what it is there, in messages
};

/// What camera rays that hit nothing show, in place of the environment and the discs of suns. It lights
/// nothing: rays that have left a surface see the sky.
struct BackgroundOptions {
    glm::dvec3 radiance{0};
    bool is_transparent = false; ///< radiance 0, and pictures get an alpha channel
};

/// A matte plane under the scene.
struct GroundOptions {
    std::optional<glm::dvec3> albedo; ///< 0..1; absent: no ground, where the studio would have one
};

struct LightOptions {
    bool studio = true; ///< light by a studio (scene/studio.h) where nothing gives light, else by a white sky
    std::string environment_file;          ///< lat-long map; empty: none
    std::optional<glm::dvec3> environment; ///< constant radiance
    double environment_scale = 1;
    double environment_rotation_degrees = 0; ///< about +Y
    std::vector<SunOptions> suns;
    std::vector<PointOptions> points;
    bool two_sided = false; ///< emissive faces shine on both sides
    std::optional<GroundOptions> ground;
    std::optional<BackgroundOptions> background;
};

/// Whether pictures have an alpha channel: --background transparent.
bool has_transparent_background(const LightOptions& light);

} // namespace clrt
