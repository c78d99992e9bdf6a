// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codecs/mesh_codecs.h"

namespace clrt {

/// MeshCodecs::decode_meshopt; without the library it throws and says so.
std::string decode_meshopt_view(std::string_view bytes, const MeshoptLayout& layout);

} // namespace clrt
