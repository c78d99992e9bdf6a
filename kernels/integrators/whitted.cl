// SPDX-License-Identifier: Apache-2.0
// Entry point of the recursive ray tracer.
#include "pixel.h"
#include "whitted.h"

RENDER_KERNEL(render_whitted, whitted_radiance)
