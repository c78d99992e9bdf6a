// SPDX-License-Identifier: Apache-2.0
#include "codecs/mesh_codecs.h"

#include "own_library.h"

namespace clrt {

const MeshCodecs& mesh_codecs() {
    static const MeshCodecs& codecs =
        load_own_library<MeshCodecs>(CLRT_MESH_CODECS, MESH_CODECS_ENTRY, "the library of packed meshes");
    return codecs;
}

} // namespace clrt
