// SPDX-License-Identifier: Apache-2.0
// Timings of naive against robust kernel functions, in so many rounds; each stands beside the cases that use
// the same expressions.
#pragma once

#include "stability/probe_set.h"

namespace clrt {

/// Reflectance of a dielectric (cases/dielectric_cases.cpp).
ProbeTime time_fresnel(const ProbeDevice& device, int rounds);

/// Adding a sample to the film against a sum in float, blocks of floats joined by two-sum, a sum in double,
/// and against the film without its look for bad samples (cases/film_cases.cpp).
ProbeTime time_film_plain(const ProbeDevice& device, int rounds);
ProbeTime time_film_blocks(const ProbeDevice& device, int rounds);
ProbeTime time_film_double(const ProbeDevice& device, int rounds);
ProbeTime time_film_guard(const ProbeDevice& device, int rounds);

/// The distribution of microfacet normals (cases/roughness_cases.cpp).
ProbeTime time_ggx_d(const ProbeDevice& device, int rounds);

/// A word as a number, and a frame around a normal (cases/number_cases.cpp).
ProbeTime time_uniforms(const ProbeDevice& device, int rounds);
ProbeTime time_frames(const ProbeDevice& device, int rounds);

/// Choosing one of many lights (cases/light_table_cases.cpp).
ProbeTime time_light_choice(const ProbeDevice& device, int rounds);

/// Points on triangles, by solid angle against by area (cases/solid_angle_case.cpp).
ProbeTime time_solid_angle(const ProbeDevice& device, int rounds);

/// The power heuristic (cases/light_cases.cpp).
ProbeTime time_mis_weight(const ProbeDevice& device, int rounds);

/// Rays through a soup of triangles, by both edge tests and by both box tests (cases/intersection_cases.cpp).
ProbeTime time_edge_test(const ProbeDevice& device, int rounds);
ProbeTime time_slab(const ProbeDevice& device, int rounds);

/// Surfaces of hits and where rays leave them (cases/offsets_cases.cpp).
ProbeTime time_offset(const ProbeDevice& device, int rounds);

/// The point of a hit, along the ray and by its weights (cases/scale_cases.cpp).
ProbeTime time_hit_point(const ProbeDevice& device, int rounds);

} // namespace clrt
