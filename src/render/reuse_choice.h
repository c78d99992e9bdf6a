// SPDX-License-Identifier: Apache-2.0
// Whether what a path has found serves other pixels (kernels/integrators/path_reuse.h).
//
// It lowers the noise of light that comes by detours, several times in rooms, and costs shadow rays. What it
// is worth, two pilots of the same samples tell, one with it and one without: tiles of the picture, spread
// over it, because paths serve pixels side by side the better. Work is counted in rays, those to other
// pixels' paths as a part of one, never in seconds: the same picture comes out everywhere. The pilots are
// there where the render is long enough for them; a part of a picture (--first-sample) is rendered as it is
// asked for, and a film that is gone on with as it began.
#pragma once

#include "console/progress.h"
#include "render/pilot.h"

#include <memory>
#include <optional>

namespace clrt {

/// Squared error times work without reuse over that with it, from which on it is taken.
constexpr double WORTHWHILE_REUSE_GAIN = 1.1;

/// What pilots of the same samples tell.
struct ReusePilots {
    PathPilot alone, reusing;
    double gain = 0; ///< of squared error times work by reuse; 0 where a signal stops them
};

/// Has the program compiled ahead that a plan will want first: with reuse, where that is open.
void expect_reuse(const Device& device, const std::shared_ptr<PlannedScene>& planned);

/// Prepares a plan of path for pilots. Where reuse is open they are rendered by programs that reuse paths
/// where they are told to (PATHS_ARE_SHARED), so that pilots with and without it, and the picture
/// with it, need no others; else by the picture's. `parts` are those of the plan that are there, and get what
/// was made. Throws what prepare_render throws.
PreparedScene prepare_path_pilot(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                                 PreparedParts& parts);

/// What pilots tell of a plan for path, which stays as it was; none where paths may not be reused, or the
/// render is too small to tell. `parts` are as prepare_path_pilot leaves them. Throws DeviceError and
/// KernelBuildError.
std::optional<ReusePilots> run_reuse_pilots(const Device& device,
                                            const std::shared_ptr<PlannedScene>& planned,
                                            PreparedParts& parts);

/// Decides `--path-reuse auto` of a plan, says so, and leaves on or off in its options. `parts` are those of
/// the plan that are there; what the pilots needed is added, and programs of the other kind are taken out.
/// Returns what it has gone by, if there were pilots; `parts.reusing` are then what they were rendered by.
/// Throws UsageError where it is asked for and the scene does not allow it, DeviceError, KernelBuildError and
/// SceneError.
std::optional<ReusePilots> choose_path_reuse(const Device& device,
                                             const std::shared_ptr<PlannedScene>& planned,
                                             PreparedParts& parts, Progress& progress);

/// Size of the pilots that compare ways to sample paths, in tiles; none where so small ones tell nothing, and
/// for parts of a picture.
std::optional<PilotSize> size_of_path_pilots(const PlannedScene& planned);

} // namespace clrt
