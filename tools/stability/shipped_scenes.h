// SPDX-License-Identifier: Apache-2.0
// The scenes that clrt ships.
#pragma once

#include "options/options.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// Their names, sorted: folders NAME with NAME.obj beside the installed program (../share/clrt/scenes), else
/// in the source tree. Throws SceneError where there is neither.
std::vector<std::string> shipped_scenes();

/// A shipped scene with its options, as `clrt NAME.obj` would read them.
struct ShippedScene {
    explicit ShippedScene(const std::string& name);
    Options options;
    Scene load() const;
};

} // namespace clrt
