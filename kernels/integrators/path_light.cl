// SPDX-License-Identifier: Apache-2.0
// Entry point of the path tracer with splats.
#define EMISSION_IS_AIMED 1
#define SPLATS_ARE_WEIGHTED 1
#define CONNECTS_THROUGH_SLABS 1
#define CAMERA_RAYS_ARE_SPLIT 1
#include "path_light.h"

#define INTEGRATOR_KERNEL render_path_light
#define INTEGRATOR_RADIANCE path_light_radiance
#include "entry_point.h"
