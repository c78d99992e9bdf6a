// SPDX-License-Identifier: Apache-2.0
// Entry point of the path tracer.
#include "pixel.h"
#include "path.h"

RENDER_KERNEL(render_path, path_radiance)
