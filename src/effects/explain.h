// SPDX-License-Identifier: Apache-2.0
// The text of --explain: what would be rendered and why, without rendering.
#pragma once

#include "effects/effects.h"
#include "options/options.h"
#include "scene/scene.h"

#include <string>

namespace clrt {

/// Effects with their witnesses, materials as understood, and every fallback; a table, or JSON with
/// --explain=json.
std::string explain(const Scene& scene, const Effects& effects, const Options& options);

} // namespace clrt
