// SPDX-License-Identifier: Apache-2.0
// What loading a scene takes of the options.
#pragma once

#include "options/options.h"

#include <glm/vec2.hpp>

namespace clrt {

struct SceneRequest {
    SceneOptions scene;
    CameraOptions camera;
    LightOptions light;
    glm::ivec2 size;    ///< of the picture, pixels: for the angle of view and what is framed
    bool is_size_given; ///< by an option, or pixels are
    bool writes_layers; ///< an EXR is asked for

    /// The part of all options that loading takes; not explicit, so that load_scene() takes them as they are.
    SceneRequest(const Options& options);
};

} // namespace clrt
