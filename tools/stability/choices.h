// SPDX-License-Identifier: Apache-2.0
// Timings of naive against robust kernel functions; each stands beside the cases that use the same expressions.
#pragma once

#include "stability/probe_set.h"

namespace clrt {

/// Reflectance of a dielectric (cases/dielectric_cases.cpp).
ProbeTime time_fresnel(const Device& device);

/// Rays through a soup of triangles, by both edge tests and by both box tests (cases/intersection_cases.cpp).
ProbeTime time_edge_test(const Device& device);
ProbeTime time_slab(const Device& device);

/// Surfaces of hits and where rays leave them (cases/offsets_cases.cpp).
ProbeTime time_offset(const Device& device);

/// The point of a hit, along the ray and by its weights (cases/scale_cases.cpp).
ProbeTime time_hit_point(const Device& device);

} // namespace clrt
