// SPDX-License-Identifier: Apache-2.0
// Whether what a path has found serves other pixels (kernels/integrators/path_reuse.h).
//
// It lowers the noise of light that comes by detours, several times in rooms, and costs shadow rays. What it
// is worth, two pilots of the same samples tell, one by each program: small pictures, so that their pixels
// lie further apart than those of the picture and the gain is rather told too small. Work is counted in rays,
// never in seconds: the same picture comes out everywhere. The pilots are there where the render is long
// enough for them; a part of a picture (--first-sample) is rendered as it is asked for, and a film that is
// gone on with as it began.
#pragma once

#include "console/progress.h"
#include "render/prepared_scene.h"

#include <memory>

namespace clrt {

/// Squared error times rays without reuse over that with it, from which on it is taken.
constexpr double WORTHWHILE_REUSE_GAIN = 1.1;

/// Decides `--path-reuse auto` of a plan, says so, and leaves on or off in its options. `parts` are those of
/// the plan that are there; what the pilots needed is added, and programs of the other kind are taken out.
/// Throws UsageError where it is asked for and the scene does not allow it, DeviceError, KernelBuildError and
/// SceneError.
void choose_path_reuse(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                       PreparedParts& parts, Progress& progress);

} // namespace clrt
