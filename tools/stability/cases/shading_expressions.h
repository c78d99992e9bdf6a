// SPDX-License-Identifier: Apache-2.0
// Expressions that cases of several groups probe, and cases that stand in a file beside their group's.
#pragma once

#include "stability/probe_set.h"
#include "stability/stability_case.h"

namespace clrt {

/// "fresnel": a cosine, b index ratio -> reflectance.
const ProbedExpression& fresnel_expression();

// Dielectric bodies (dielectric_scenes.cpp).
void index_one_ball(CaseRun& run);
void glass_slab(CaseRun& run);
void slab_shift(CaseRun& run);
void thin_slab(CaseRun& run);
void start_inside(CaseRun& run);
void trapped_light(CaseRun& run);
void glass_ball(CaseRun& run);

// Furnaces of single BSDFs (bsdf_furnaces.cpp).
void bsdf_furnace(CaseRun& run);
void coloured_lobes(CaseRun& run);

// Numbers and frames (number_cases.cpp).
void bases(CaseRun& run);
void uniforms(CaseRun& run);
void streams(CaseRun& run);
void nets(CaseRun& run);

// Tables that lights are chosen by (light_table_cases.cpp).
void dark_lights(CaseRun& run);
void many_lights(CaseRun& run);

// Triangles by solid angle (solid_angle_case.cpp).
void solid_angles(CaseRun& run);

} // namespace clrt
