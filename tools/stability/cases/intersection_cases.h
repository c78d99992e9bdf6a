// SPDX-License-Identifier: Apache-2.0
// Parts of the group of intersection cases.
#pragma once

#include "probes/ray_device.h"
#include "stability/stability_case.h"

#include <string>
#include <vector>

namespace clrt {

/// Counts rays for which a tree and a loop over all triangles find different bits, in every build and tree.
void count_tree_differences(CaseRun& run, const Scene& scene, const std::vector<TestRay>& rays,
                            const std::string& name, Figure& differences);

// intersection_accuracy_cases.cpp
void false_hits(CaseRun& run);
void distance_and_weights(CaseRun& run);
void depth_order(CaseRun& run);
void deep_trees(CaseRun& run);
void far_ball(CaseRun& run);
void planet(CaseRun& run);

} // namespace clrt
