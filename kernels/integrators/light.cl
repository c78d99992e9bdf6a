// SPDX-License-Identifier: Apache-2.0
// Entry point of the light tracer.
#define CAMERA_RAYS_ARE_SPLIT 1
#include "light.h"

#define INTEGRATOR_KERNEL render_light
#define INTEGRATOR_RADIANCE light_radiance
#include "entry_point.h"
