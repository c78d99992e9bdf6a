// SPDX-License-Identifier: Apache-2.0
// Light that a picture may lack because none of its samples has met it.
//
// Light that only hits find, such as a caustic of the sun seen through glass, is met by one path in many
// thousand. Until the first has met it, it is missing, and all replicates agree on a picture without it: no
// error bar shows that. If a share p of all paths takes such a way, N independent ones miss it with
// probability (1 - p)^N, so that with 95 % confidence p is at most 3 / N where none has met it (the rule of
// three: Hanley and Lippman-Hand 1983). What comes by a way that no sample has taken is then at most 3 / N
// times the largest radiance that a sample brings.
#pragma once

#include "film/bias_sources.h"
#include "film/render_progress.h"
#include "options/integrators.h"
#include "paths/path_plan.h"
#include "scene/scene.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace clrt {

/// Such light of a scene; none where there is none. Weights of paths are taken as 1 at most, as if surfaces
/// reflected all light, and as if none were guided: they can be larger where a guide expects no light. A
/// guide that leads paths to such light, as that of bdpt does, makes the largest sample about as much smaller
/// as it has made their squared error. Highlights, LS+E, are not held to be rare, though small ones in curved
/// mirrors are.
std::optional<HitLight> hit_light(const Scene& scene, const PathPlan& paths, Integrator integrator,
                                  const RenderProgress& render);

/// What may be missing.
struct UnmetLight {
    std::string paths;                    ///< as an expression
    double light_bound = 0;               ///< mean radiance over the scene's pixels, with 95 % confidence
    std::optional<double> relative_bound; ///< the same over the scene's mean; none of a black picture
};

/// Less than this share of the scene's mean is not worth a word.
constexpr double LEAST_UNMET = 0.01;

/// None where it is less than LEAST_UNMET, but for black pictures. The bound is that of an --adaptive picture
/// as if all tiles had the fewest samples of any. It is over the pixels that errors are stated over
/// (ErrorPixels::SCENE).
std::optional<UnmetLight> unmet_light(const RenderProgress& render, const std::optional<HitLight>& hits);

/// The line "unmet" of the report; empty where there is nothing to say.
std::string format_unmet(const std::optional<UnmetLight>& unmet);

/// The JSON's "unmet".
nlohmann::ordered_json unmet_json(const std::optional<UnmetLight>& unmet);

} // namespace clrt
