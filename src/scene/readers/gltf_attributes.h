// SPDX-License-Identifier: Apache-2.0
// The attributes and indices of a glTF primitive, plain or packed by Draco.
#pragma once

#include "codecs/mesh_codecs.h"
#include "scene/readers/gltf_accessors.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

class GltfAttributes {
public:
    /// Throws SceneError: JSON path, expected, found.
    GltfAttributes(GltfBuffers& buffers, const JsonValue& primitive);

    bool has(const char* name) const;

    /// Attribute `name`, one element a vertex; nothing where the primitive has none.
    std::optional<GltfNumbers> find(const char* name, GltfElement element);

    /// The vertices in the order in which they make up the primitive.
    std::vector<u32> order(size_t vertices);

    /// Draco packs triangles, whatever the mode says.
    bool is_draco() const { return draco_.has_value(); }

private:
    void unpack(const JsonValue& packing);
    GltfNumbers unpacked(const JsonValue& attribute, size_t place, GltfElement element) const;

    GltfBuffers& buffers_;
    JsonValue json_, attributes_;
    std::optional<DracoMesh> draco_;
    std::vector<std::string> draco_names_; // of draco_->attributes
};

} // namespace clrt
