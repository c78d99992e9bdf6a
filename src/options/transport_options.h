// SPDX-License-Identifier: Apache-2.0
// Which light is simulated.
#pragma once

#include "options/integrators.h"
#include "options/toggle.h"

#include <optional>
#include <string>

namespace clrt {

/// The name of no integrator: one of those that simulate all light is chosen (render/integrator_choice.h).
inline constexpr const char* CHOSEN_INTEGRATOR = "auto";

/// An integrator reads those of the others that its row takes (options/integrators.h).
struct TransportOptions {
    Integrator integrator = Integrator::PATH;
    /// Whether an integrator is chosen, `integrator` being path until one is: asked for, or, as no other is
    /// named, where a pilot can tell (render/integrator_choice.h).
    Toggle choose = Toggle::OFF;
    std::optional<int> max_depth;    ///< path segments; none: as many as the integrator's row says
    int roulette_depth = 5;          ///< first segment that Russian roulette may end
    double min_contribution = 0.002; ///< smallest weight worth a ray
    Toggle guide = Toggle::AUTO;     ///< directions where paths have found light
    /// Rays that a guide is learnt from before --guide auto judges it, and that it waits for where no pilot
    /// has told that light is hard to find; no option of the command line. They take two cores of a CPU a
    /// second or two, about as long as a guide's first compilation.
    double guide_after_rays = 1 << 22;
    /// What paths of other pixels have found (kernels/integrators/path_reuse.h); auto: until that is chosen
    /// (render/reuse_choice.h), none.
    Toggle path_reuse = Toggle::AUTO;
    /// Camera rays a sample from which pixels take emission that the outline of a light crosses
    /// (kernels/integrators/emission_rays.h); 1: none have any.
    int emission_rays = 16;
    /// Light samples of a path's first vertex, a power of two (kernels/path/light_samples.h); 0, auto: until
    /// that is chosen (render/light_samples_choice.h), one.
    int light_samples = 0;
    int shadow_rays = 4;      ///< of a vertex to lamps, sky, and every sun with a disc
    int gloss_rays = 4;       ///< of a vertex by a rough reflection
    int translucent_rays = 4; ///< of a vertex by a rough dielectric, reflected and refracted
    std::string paths;        ///< path notation (paths/path_expression.h); empty: every path
};

/// The largest path length in segments for these options.
int effective_max_depth(const TransportOptions& transport);

} // namespace clrt
