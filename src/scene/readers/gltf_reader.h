// SPDX-License-Identifier: Apache-2.0
// glTF 2.0, .gltf and .glb.
#pragma once

#include "scene/readers/reader_table.h"

namespace clrt {

/// Reads the scene that a glTF file shows: geometry with its instances flattened, materials, cameras, lights.
/// Throws SceneError that names the JSON path (or byte), what was expected and what was found; also for a
/// required extension that cannot be read. What is left out is a notice.
SceneDescription read_gltf_scene(SceneFile file, const ReadContext& context);

} // namespace clrt
