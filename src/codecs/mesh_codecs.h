// SPDX-License-Identifier: Apache-2.0
// The decoders of packed meshes, Draco and meshoptimizer. Few files need them and they take a millisecond to
// link at every start, so they are loaded when the first mesh does. Each may be missing: it is built where
// its library is there.
#pragma once

#include "kernels/shared/types.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace clrt {

/// One attribute of a Draco mesh: `components` floats a vertex.
struct DracoAttribute {
    size_t components = 0;
    std::vector<float> values;
};

struct DracoMesh {
    size_t vertices = 0;
    std::vector<u32> indices; ///< three a triangle, each below `vertices`
    std::vector<DracoAttribute> attributes;
};

/// How a buffer view is packed by meshoptimizer, in the words of EXT_meshopt_compression.
struct MeshoptLayout {
    std::string mode;   ///< ATTRIBUTES, TRIANGLES, INDICES
    std::string filter; ///< NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL
    size_t count = 0, stride = 0;
};

/// What the loaded library offers.
class MeshCodecs {
public:
    /// Decodes a mesh and those of its attributes whose unique ids are given. Throws std::runtime_error with
    /// what was found, such as "a damaged Draco mesh".
    virtual DracoMesh decode_draco(std::string_view bytes, const std::vector<u32>& ids) const = 0;
    /// Decodes count * stride bytes. Throws std::runtime_error likewise.
    virtual std::string decode_meshopt(std::string_view bytes, const MeshoptLayout& layout) const = 0;

protected:
    ~MeshCodecs() = default;
};

/// The library, loaded at the first call; threads may call it. Throws std::runtime_error where it is not
/// there.
const MeshCodecs& mesh_codecs();

/// The only function that the loaded file exports, of this type and name. The number changes with this
/// header.
using MeshCodecsEntry = const MeshCodecs*();
constexpr const char* MESH_CODECS_ENTRY = "clrt_mesh_codecs_1";

} // namespace clrt
