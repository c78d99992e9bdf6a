// SPDX-License-Identifier: Apache-2.0
// Timings of naive against robust kernel functions; each stands beside the cases that use the same expressions.
#pragma once

#include "stability/probe_set.h"

namespace clrt {

/// Reflectance of a dielectric (cases/dielectric_cases.cpp).
ProbeTime time_fresnel(const Device& device);

} // namespace clrt
