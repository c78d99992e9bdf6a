// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codecs/mesh_codecs.h"

namespace clrt {

/// MeshCodecs::decode_draco; without the library it throws and says so.
DracoMesh decode_draco_mesh(std::string_view bytes, const std::vector<u32>& ids);

} // namespace clrt
