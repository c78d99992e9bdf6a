// SPDX-License-Identifier: Apache-2.0
// Entry point of the ray caster.
#include "raycast.h"

#define INTEGRATOR_KERNEL render_raycast
#define INTEGRATOR_RADIANCE raycast_radiance
#include "entry_point.h"
