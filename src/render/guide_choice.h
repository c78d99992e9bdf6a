// SPDX-License-Identifier: Apache-2.0
// Whether --guide auto guides a picture from its first samples on. A pilot of path says how noisy samples are
// without a guide. Where they are, and the render is long enough for a guide to be learnt, tried and used,
// none of its samples is spent on waiting: a further pilot teaches the guide and judges it where the render
// is so long that this costs little, teaches it alone where light is very hard to find, and else the
// picture's samples do all (render/guiding.h). The pilots' samples are dropped: what they decide is
// independent of the picture's.
#pragma once

#include "console/progress.h"
#include "render/pilot.h"

#include <memory>
#include <optional>

namespace clrt {

/// Whether a guide may be worth its learning, where the options leave it open: light is hard to find, and
/// there is time. Of path and path+light a pilot must have found some; bdpt is guided to what a pilot hardly
/// can find. `integrator`: whom it would guide, planned or not; `unguided`: what a pilot has told of it.
bool is_guide_promising(const PlannedScene& planned, Integrator integrator, const PathPilot& unguided);

/// What a picture begins with whose guide is promising: what a pilot has learnt and judged, or what its own
/// samples are to teach. Throws as choose_integrator.
GuideProgress first_guide(const PreparedScene& prepared, const PathPilot& unguided);

/// Decides, and adds to `parts` what the picture is to begin with; nothing where its own first samples are to
/// tell. `unguided`: what another pilot has told of the plan's integrator; none: one is taken where the
/// options leave the choice. A guide that is there already stays. Throws as choose_integrator.
void choose_guide(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts,
                  std::optional<PathPilot> unguided, Progress& progress);

} // namespace clrt
