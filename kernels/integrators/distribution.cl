// SPDX-License-Identifier: Apache-2.0
// Entry point of the distribution ray tracer.
#include "distribution.h"

#define INTEGRATOR_KERNEL render_distribution
#define INTEGRATOR_RADIANCE distribution_radiance
#include "entry_point.h"
