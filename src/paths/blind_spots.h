// SPDX-License-Identifier: Apache-2.0
// Blind spots: paths that a scene has and a picture asks for, but that no technique of the integrator
// samples. Their light is missing, and no error bar shows it.
//
// What an integrator can sample is written as expressions. Its rays meet lights that have an extent; light
// sampling connects a surface to any light, but only where the surface next to the light scatters other than
// as a delta function (Veach 1997, section 8.3.2). So a path tracer never sees light of points and of suns
// without a disc that comes by mirrors or smooth glass, such as LpS+DE.
//
// The images of such lights, L S* E, are no blind spots: a point without extent shows as a dot whose
// brightness depends on the size of the pixels, so that no picture has it.
#pragma once

#include "options/integrators.h"
#include "paths/path_expression.h"
#include "scene/scene.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clrt {

struct PathPlan;

/// A class of paths that is not sampled.
struct BlindSpot {
    std::string paths; ///< as an expression, such as "LpS+D(D|S)*E"; behind "part of " where some is sampled
    std::string cause; ///< the light, and the material next to it
    std::string where; ///< "file:line" of that material; empty: none
    std::string seen = {}; ///< lights that would be seen instead, for the log; not in files; empty: none
};

/// The blind spots of an integrator in the scene of the plan, whose letters and kinds of light are known
/// already, within a picture of the paths of `picture` that have at most `max_depth` segments; one for each
/// kind of light and material next to it.
std::vector<BlindSpot> find_blind_spots(const PathPlan& plan, const PathExpression& picture,
                                        Integrator integrator, int max_depth);

/// Paths that no technique finds but a path from the eye that happens to hit the light, other than by delta
/// lobes alone: by chance, and the rarer the smaller the light is.
struct HitPaths {
    std::string paths;      ///< as an expression, such as "LS(D|S)*DSE"; empty: there are none
    unsigned kinds = 0;     ///< KIND_* of their lights
    bool are_smooth = true; ///< no lobes count as smooth that are only nearly so
};

/// Those of an integrator; arguments as those of find_blind_spots.
HitPaths find_hit_paths(const PathPlan& plan, const PathExpression& picture, Integrator integrator,
                        int max_depth);

/// Lines "not seen ...", one a blind spot.
std::string format_blind_spots(const std::vector<BlindSpot>& spots);

/// The JSON's "blind_spots", and back.
nlohmann::ordered_json blind_spots_json(const std::vector<BlindSpot>& spots);
std::vector<BlindSpot> read_blind_spots(const nlohmann::ordered_json& json);

} // namespace clrt
