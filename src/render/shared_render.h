// SPDX-License-Identifier: Apache-2.0
// A render by several devices at once: one film, to which each adds the samples that it takes (crew.h).
#pragma once

#include "render/render.h"

#include <vector>

namespace clrt {

/// Renders as render() does, by all devices that the scene is prepared for. Samples are neither guided nor
/// adaptive, and none comes from chains. A device that fails is left out and said; Render::shares tells what
/// each did. Throws DeviceError when none is left, or where one lacks memory from the start.
Render render_shared(const std::vector<const PreparedScene*>& prepared, Progress& progress,
                     const RenderHooks& hooks = {});

} // namespace clrt
