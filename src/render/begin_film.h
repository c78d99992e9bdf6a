// SPDX-License-Identifier: Apache-2.0
// The film that a render starts with.
#pragma once

#include "render/render.h"

#include <vector>

namespace clrt {

/// Gives `result` the film that the render goes on from, or an empty one, in as many replicates as fit all
/// devices; returns the constants of its launches. Throws UsageError for more samples than it can hold, and
/// DeviceError where too few replicates fit for --adaptive.
RenderParams begin_film(const PlannedScene& planned, const std::vector<const Device*>& devices,
                        const RenderProgress* resume, Render& result);

} // namespace clrt
