// SPDX-License-Identifier: Apache-2.0
// Takes effects out of a scene that calls for them: what is left is a scene that does not call for them, so
// that every program renders it alike and no kernel meets data that it was not built for.
#pragma once

#include "options/options.h"
#include "scene/scene.h"

namespace clrt {

/// Changes the scene and the options to what the column `without` of the effect table says, for each of
/// `effects` and for those that imply one of them.
void take_out_effects(EffectMask effects, Scene& scene, Options& options);

/// Whether taking these effects out may turn triangles round, so that a tree over the scene as it was is none
/// over what is left. (A tree around triangles that move is also one around those that have stopped.)
bool turns_triangles(EffectMask effects);

} // namespace clrt
