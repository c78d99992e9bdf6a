// SPDX-License-Identifier: Apache-2.0
// Entry point of the bidirectional path tracer.
#define SPLATS_ARE_WEIGHTED 1
#define INNER_CONNECTIONS 1
#define CONNECTS_THROUGH_SLABS 1
#define CAMERA_RAYS_ARE_SPLIT 1
#include "bdpt.h"

#define INTEGRATOR_KERNEL render_bdpt
#define INTEGRATOR_RADIANCE bdpt_radiance
#include "entry_point.h"
