// SPDX-License-Identifier: Apache-2.0
// Metropolis light transport: what must hold once there is such an integrator.
#include "stability/catalogue.h"

namespace clrt {

namespace {

constexpr const char* INTEGRATOR = "a Metropolis integrator";

} // namespace

const std::vector<StabilityCase>& metropolis_cases() {
    static const std::vector<StabilityCase> cases = {
        {"M01", "BlackScene", "a scene whose bootstrap paths carry nothing", "black", "", nullptr,
         INTEGRATOR},
        {"M02", "RareLight", "light that one bootstrap path in a million finds, 256 seeds",
         "closed form of the brightness", "", nullptr, INTEGRATOR},
        {"M03", "StartUpBias", "a million chains of one mutation", "closed form", "", nullptr, INTEGRATOR},
        {"M04", "BadProposals", "one proposal in 1e4 infinite or NaN", "the run without them; counters", "",
         nullptr, INTEGRATOR},
        {"M05", "ConstantTarget", "a furnace, where all paths carry the same",
         "acceptance 1, exact brightness", "", nullptr, INTEGRATOR},
        {"M06", "SmallSteps", "1e9 small steps of a coordinate", "stays in [0, 1)", "", nullptr, INTEGRATOR},
    };
    return cases;
}

} // namespace clrt
