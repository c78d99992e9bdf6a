// SPDX-License-Identifier: Apache-2.0
// Entry point of the recursive ray tracer.
#include "whitted.h"

#define INTEGRATOR_KERNEL render_whitted
#define INTEGRATOR_RADIANCE whitted_radiance
#include "entry_point.h"
