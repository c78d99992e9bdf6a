// SPDX-License-Identifier: Apache-2.0
// An OBJ with its material libraries -> what every reader gives.
#pragma once

#include "scene/readers/reader_table.h"

namespace clrt {

/// Reads the OBJ (obj_reader.h) and its libraries (mtl_libraries.h), and describes every material that a face
/// uses: repaired as its writer means it (mtl_repair.h), but with --mtl plain, and with the colours of
/// vertices (obj_colours.h). A name that no library defines is grey, with a notice.
SceneDescription read_obj_scene(SceneFile file, const ReadContext& context);

} // namespace clrt
