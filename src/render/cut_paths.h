// SPDX-License-Identifier: Apache-2.0
// The light that is lost because --max-depth ends paths: a bias, which no error bar shows.
//
// Write a for the largest albedo, L for the largest radiance that a ray can meet where it ends, and B for E /
// pi, E being the largest irradiance by lights that no ray meets: B is what they make a matte surface of
// reflectance 1 shine with. Of all light, radiance R = max (L, reflected) obeys R <= L + a B + a R where only
// matte surfaces answer those lights, so R <= (L + a B) / (1 - a). A path that is cut would have gone on with
// the weight w, the product of BSDF times cosine over pdf, to meet R at most; at its last vertex it also lost
// the connection to lights that no ray meets, whose mean is at most w B. In all it lost at most w (R + B) <=
// w (L + B) / (1 - a). The mean over the cut paths is that of the picture's loss because the weight is
// that of a path which goes on by the same random numbers.
//
// There is no such number where a = 1, where a point light lies on a surface, and where a glossy surface
// answers a light that no ray meets: its highlight is as bright as it is narrow.
#pragma once

#include "film/bias_sources.h"
#include "film/render_progress.h"
#include "paths/path_plan.h"
#include "scene/scene.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// (L + B) / (1 - a), which times the weight of a cut path bounds what it lost; none where there is no bound.
/// Lights of other kinds (KIND_*) than `kinds` are not asked for.
std::optional<double> cut_radiance(const Scene& scene, unsigned kinds);

/// Those of a render (light that only hits find: render/unmet_light.h); bounds nothing where nothing was cut,
/// or where what was cut are paths from the lights, whose weights are not those of radiance.
BiasSources bias_sources(const Scene& scene, const PathPlan& paths, const RenderProgress& render,
                         Integrator integrator);

/// Samples a pixel by which a sum over all pixels is a mean, or more than the mean.
double samples_of_mean(const Film& film);

/// What --max-depth cut from a picture.
struct CutPaths {
    std::uint64_t paths = 0;
    std::uint64_t all = 0;                ///< paths of the film
    std::optional<double> light_bound;    ///< mean radiance over pixels and channels; 0 where nothing was cut
    std::optional<double> relative_bound; ///< the same over the picture's mean; none of a black picture
};

/// `radiance` is the scene's cut_radiance. The bound is that of an --adaptive picture as if all tiles had the
/// fewest samples of any.
CutPaths cut_paths(const RenderProgress& render, const std::optional<double>& radiance);

/// The line "cut" of the report; empty where nothing was cut.
std::string format_cut(const CutPaths& cut);

/// The JSON's "cut".
nlohmann::ordered_json cut_json(const CutPaths& cut);

} // namespace clrt
