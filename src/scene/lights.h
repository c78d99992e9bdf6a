// SPDX-License-Identifier: Apache-2.0
// Emissive triangles, point lights and suns, each with the table that chooses among them by power.
#pragma once

#include "options/light_options.h"
#include "scene/notices.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// Triangles smaller than this (area in the normalised frame, whose radius is 1 to 2) are never chosen as
/// lights: their side is below 1e-15, far under the spacing of floats near 1, and 1 / area must stay finite.
constexpr double SMALLEST_EMITTER_AREA = 1e-30;

/// Discs of a smaller angular radius (radians) become delta suns: their 1 - cos is below 1e-12, their
/// radiance would exceed 1e11 times their irradiance, and no shadow shows the difference.
constexpr double SMALLEST_SUN_RADIUS = 1e-6;

/// Area of a triangle in the frame of its corners, computed in double; 0 if a corner is not finite.
double triangle_area(const vec4& a, const vec4& b, const vec4& c);

/// Makes the table that chooses emissive triangles in proportion to weights; `areas` of the triangles.
void tabulate(const std::vector<double>& weights, const std::vector<double>& areas,
              std::vector<Emitter>& emitters);

/// The same of point lights and suns.
void tabulate(const std::vector<double>& weights, std::vector<Light>& lights);

struct Emitters {
    std::vector<Emitter> emitters; ///< in the order of the triangles
    double power = 0;              ///< pi area luminance, summed
};

/// Lists the emissive triangles and sets their `emitter`. `exitance` holds, for each material, the luminance
/// that it emits on average over its maps, times its coverage, doubled where both sides shine; 0: dark.
Emitters build_emitters(const std::vector<vec4>& positions, std::vector<Triangle>& triangles,
                        const std::vector<double>& exitance);

/// Luminance that leaves an emitter: pi area luminance, both sides where both shine.
double emitter_power(const Scene& scene, u32 emitter);

/// The same of all.
double emitters_power(const Scene& scene);

/// The irradiance, luminance, of a sun at normal incidence.
double sun_irradiance(const Light& sun);

/// The solid angle that a point light would light as brightly as on its axis: all of it, or that of a spot's
/// falloff.
double lit_solid_angle(const Light& light);

/// Luminance of a point light or sun that meets a bounding sphere of this radius.
double light_power(const Light& light, double radius);

struct Lights {
    std::vector<Light> lights;
    std::vector<std::string> sources; ///< by what each is there
    double power = 0;                 ///< luminance that meets the scene; normalised frame
};

/// How many lights are there by the same option, or file.
struct SourceCount {
    std::string source;
    size_t count = 0;
};

/// Those of a kind (LIGHT_*), in the scene's order.
std::vector<SourceCount> count_lights(const Scene& scene, u32 kind);

/// Point lights and suns of the options in the normalised frame, `radius` its bounding sphere. A light
/// without power is left out with a notice. Throws UsageError for values that are no light: not finite,
/// negative, a sun without direction or as wide as the sky.
Lights build_lights(const LightOptions& options, const Normalisation& frame, double radius,
                    NoticeList& notices);

} // namespace clrt
