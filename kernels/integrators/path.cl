// SPDX-License-Identifier: Apache-2.0
// Entry point of the path tracer.
#define CONNECTS_THROUGH_SLABS 1
#define CAMERA_RAYS_ARE_SPLIT 1
#define LIGHT_SAMPLES_ARE_SPLIT 1
#include "path.h"

#define INTEGRATOR_KERNEL render_path
#define INTEGRATOR_RADIANCE path_radiance
#include "entry_point.h"
