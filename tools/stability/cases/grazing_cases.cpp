// SPDX-License-Identifier: Apache-2.0
#include "stability/cases/grazing_plane_case.h"
#include "stability/catalogue.h"

namespace clrt {

const std::vector<StabilityCase>& grazing_cases() {
    static const std::vector<StabilityCase> cases = {
        {"G01", "GrazedPlane", "a plane seen at 1e-1 to 1e-6 rad", "x = h / tan in double",
         "the study's: four roundings across the ray, over the angle along it", grazed_plane},
    };
    return cases;
}

} // namespace clrt
