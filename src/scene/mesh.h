// SPDX-License-Identifier: Apache-2.0
// Triangles as files of any format give them: world units, indices into arrays of attributes.
#pragma once

#include "kernels/shared/types.h"

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace clrt {

/// Indices from 0 into the arrays of a Mesh. Normals and texture coordinates may be absent: NO_INDEX.
struct MeshTriangle {
    u32 v[3], n[3], t[3];
    u32 material; ///< into SceneDescription::materials
    u32 object;   ///< into Mesh::object_names
};

struct Mesh {
    std::vector<glm::dvec3> positions; ///< in double: map coordinates leave floats no digits for the scene
    std::vector<glm::vec3> normals;    ///< of any length but 0
    /// Where positions and normals are when the shutter closes; both empty where none moves.
    std::vector<glm::dvec3> end_positions;
    std::vector<glm::vec3> end_normals;
    std::vector<glm::vec2> uvs;          ///< (0,0) is the lower left corner of a picture
    std::vector<glm::vec2> second_uvs;   ///< beside each of them; empty where no texture reads them
    std::vector<glm::vec3> colours;      ///< of each position, linear; empty if no material asks for them
    std::vector<MeshTriangle> triangles; ///< in the file's order
    std::vector<u32> smoothing; ///< each triangle's smoothing group, NO_INDEX for none; empty if none has any
    std::vector<std::string> object_names; ///< "" for what has no name
    size_t first_normals_triangle = 0;     ///< the first triangle with corner normals or a smoothing group,
    size_t first_normals_line = 0; ///< and the line of its face; 0 where no triangle has any, or no lines
};

} // namespace clrt
