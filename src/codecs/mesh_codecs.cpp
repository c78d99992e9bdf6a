// SPDX-License-Identifier: Apache-2.0
#include "codecs/mesh_codecs.h"

#include <dlfcn.h>
#include <stdexcept>

namespace clrt {

namespace {

/// Loads CLRT_MESH_CODECS, a file that is looked for in the folders of the program's run path.
const MeshCodecs& load_codecs() {
    void* const library = dlopen(CLRT_MESH_CODECS, RTLD_LAZY | RTLD_LOCAL);
    void* const entry = library ? dlsym(library, MESH_CODECS_ENTRY) : nullptr;
    if (!entry)
        throw std::runtime_error(std::string("the library of packed meshes cannot be loaded: ") + dlerror());
    return *reinterpret_cast<MeshCodecsEntry*>(entry)();
}

} // namespace

const MeshCodecs& mesh_codecs() {
    static const MeshCodecs& codecs = load_codecs();
    return codecs;
}

} // namespace clrt
