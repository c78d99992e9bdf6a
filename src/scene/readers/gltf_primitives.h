// SPDX-License-Identifier: Apache-2.0
// The primitives of glTF meshes -> triangles with their attributes, in the mesh's own frame.
#pragma once

#include "scene/mesh.h"
#include "scene/readers/gltf_accessors.h"
#include "scene/readers/gltf_attributes.h"
#include "scene/readers/gltf_materials.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <list>
#include <map>
#include <string>
#include <vector>

namespace clrt {

/// A joint of a skin that a vertex follows.
struct GltfInfluence {
    u32 joint; ///< into the skin's joints
    float weight;
};

/// What a morph target adds to each position and normal; empty where nothing.
struct GltfMorphTarget {
    std::vector<glm::vec3> positions, normals;
};

/// Attributes are empty where absent, else one a position.
struct GltfPrimitive {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs, second_uvs; ///< from the lower left; the second only beside the first
    std::vector<glm::vec3> colours;
    std::vector<GltfInfluence> influences; ///< the same number for each position, one after the other
    std::vector<GltfMorphTarget> targets;
    std::vector<u32> corners; ///< three a triangle, below the number of positions
    u32 material = 0;
};

/// Adds the texture coordinates of a primitive's vertices.
void add_coordinates(const GltfPrimitive& primitive, Mesh& mesh);

/// Reads meshes, each once.
class GltfMeshes {
public:
    GltfMeshes(GltfBuffers& buffers, GltfMaterials& materials, NoticeList& notices)
        : buffers_(buffers), materials_(materials), notices_(notices) {}

    /// The primitives of a mesh that have triangles. Throws SceneError: JSON path, expected, found.
    const std::vector<GltfPrimitive>& find(const JsonValue& index);

    /// Keeps what was made of a mesh as long as this.
    const std::vector<GltfPrimitive>& keep(std::vector<GltfPrimitive> primitives);

private:
    std::vector<GltfPrimitive> read_mesh(const JsonValue& mesh);
    std::optional<GltfPrimitive> read_primitive(const JsonValue& json);
    void read_coordinates(const JsonValue& json, GltfAttributes& attributes, const std::vector<size_t>& sets,
                          GltfPrimitive& primitive);
    void notice(const std::string& text, const JsonValue& json);

    GltfBuffers& buffers_;
    GltfMaterials& materials_;
    NoticeList& notices_;
    std::map<std::string, std::vector<GltfPrimitive>> meshes_; // by path
    std::list<std::vector<GltfPrimitive>> made_;
};

} // namespace clrt
