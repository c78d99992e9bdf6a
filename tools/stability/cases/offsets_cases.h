// SPDX-License-Identifier: Apache-2.0
// Parts of the group of cases about leaving surfaces (offsets_closed_cases.cpp).
#pragma once

#include "probes/meshes.h"
#include "stability/stability_case.h"

namespace clrt {

void shadow_ray_ends(CaseRun& run);
void light_tight_rooms(CaseRun& run);
void shadow_terminator(CaseRun& run);

/// Follows rays around a convex room, off its walls in random directions, and counts those that get out.
void count_escapes(const CaseRun& run, const Scene& room, size_t paths, const std::string& name,
                   Figure& escapes);

} // namespace clrt
