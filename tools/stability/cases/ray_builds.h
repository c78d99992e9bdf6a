// SPDX-License-Identifier: Apache-2.0
// What the cases that trace rays share: the builds' kernels, and rays as text.
#pragma once

#include "probes/ray_device.h"
#include "stability/stability_case.h"

#include <functional>
#include <string>

namespace clrt {

/// The device's kernels with one robust part replaced by the textbook's (tools/naive).
const KernelVariant& plain_triangles(const ProbeDevice& device);
const KernelVariant& plain_boxes(const ProbeDevice& device);
const KernelVariant& plain_offsets(const ProbeDevice& device);

/// A build of the ray tracing kernels: `naive` are those of Build::NAIVE.
RayDeviceOptions ray_options(Build build, const KernelVariant& naive);

/// Calls `trace(options, text)` for what of a build is traced: in single every layout and quality of tree,
/// else the fast eight-wide tree.
void for_each_tree(Build build, const KernelVariant& naive,
                   const std::function<void(const RayDeviceOptions&, const std::string&)>& trace);

/// The builds without the textbook's: for cases that have none.
std::vector<Build> robust_builds(const CaseRun& run);

/// Origin and direction in hex floats.
std::string ray_text(const TestRay& ray);

} // namespace clrt
