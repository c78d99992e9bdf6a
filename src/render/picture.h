// SPDX-License-Identifier: Apache-2.0
// A finished render -> a picture with its layers.
#pragma once

#include "output/image.h"
#include "render/render.h"

namespace clrt {

/// The picture with the layers that the options ask for (all that an EXR can hold by default), in world
/// units. Metadata is left to the report.
Picture make_picture(const Render& render, const Scene& scene, const Options& options);

/// The picture alone.
Picture make_plain_picture(const Render& render, const Options& options);

} // namespace clrt
