// SPDX-License-Identifier: Apache-2.0
// Entry point of the ray caster.
#include "pixel.h"
#include "raycast.h"

RENDER_KERNEL(render_raycast, raycast_radiance)
