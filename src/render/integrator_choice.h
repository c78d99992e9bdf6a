// SPDX-License-Identifier: Apache-2.0
// Which integrator renders the picture, where none is named or --integrator is auto.
//
// What it must be able to do decides first: options that only path takes, light that path cannot find, a
// film that is gone on with. Where several could, each but path takes a pilot (render/pilot.h), all together
// at most PILOT_SHARE of the render's work, and the integrator with the least squared error times work wins:
// each is compared with what its own samples tell of path, or, where path chooses lights by a tree or finds
// lamps behind slabs, which others do without, with a pilot of path's own, caustics apart: it hardly meets
// them, and path+light's samples tell their noise, without what path is connected to through slabs. Where
// none is named and the scene cannot have caustics but of slabs, path takes a pilot before them, and where
// that finds the light no other is compiled; nor is bdpt where path+light's pilot tells that it finds the
// light, or path does but for caustics. Nor do candidates spend what path does on lamps behind slabs, beside
// other caustics too: there that pilot tells path's work. What they are left with, light of such lamps that
// hits alone find, their pilots tell by connections as path's: hits are too rare. Work is counted in rays,
// each weighing what it was measured to cost, never in seconds: the same picture comes out everywhere. The
// pilots' samples are dropped, so that the picture is, bit for bit, that of the integrator by name, unless
// both differ over a guide: a pilot of a candidate judges here whether one is worth it, a pilot of the
// integrator itself where it is named, and near the bound they need not agree.
//
// Where bdpt wins, path that reuses paths gets a pilot as well (render/reuse_choice.h), and the plan is for
// that if it gains as much. Path+light gains by reuse what path does.
//
// Where --max-depth is not asked for, bdpt takes as long paths as path does.
#pragma once

#include "console/progress.h"
#include "render/integrator_price.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Which integrator renders, and why.
struct IntegratorChoice {
    Integrator integrator = Integrator::PATH;
    bool is_told = false;                ///< auto was asked for, or others than path were tried or taken
    std::string reason;                  ///< in words, where it is told
    PilotSize pilot;                     ///< of each; 0 spp: there was none
    std::vector<IntegratorPrice> prices; ///< that it has found out
    SquaredErrors caustics{};            ///< of path by caustics, where path+light has told
    std::optional<PathPilot> unguided;   ///< what one of them has told of the integrator, without a guide
    double seconds = 0; ///< of choosing, compilation and tree included; nothing depends on it
};

/// Size of the pilots of a render; none where so small ones tell nothing.
std::optional<PilotSize> pilot_size(const PlannedScene& planned);

/// Has programs compiled ahead that choose_integrator will want, or whoever plans for what it chooses.
void expect_programs(const Device& device, const std::shared_ptr<PlannedScene>& planned);

/// Chooses, unless an integrator is named, says so, and plans for what is chosen. `parts` are those of the
/// plan that are there; what the pilots made and the render can use is added. Throws DeviceError,
/// KernelBuildError and SceneError.
IntegratorChoice choose_integrator(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                                   PreparedParts& parts, Progress& progress);

/// "path+light: ..." for the report; empty where nothing is told.
std::string choice_text(const IntegratorChoice& choice);

} // namespace clrt
