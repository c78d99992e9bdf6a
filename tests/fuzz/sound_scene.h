// SPDX-License-Identifier: Apache-2.0
// What every reader of scenes promises of its description.
#pragma once

#include "error.h"
#include "fuzz_target.h"
#include "scene/readers/reader_table.h"

#include <cmath>

namespace clrt {

inline void check_sound_triangle(const Mesh& mesh, const MeshTriangle& triangle, size_t materials) {
    for (int c = 0; c < 3; ++c) {
        promise(triangle.v[c] < mesh.positions.size(), "corners are in range");
        const glm::dvec3& p = mesh.positions[triangle.v[c]];
        promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "corners are finite");
        promise(triangle.n[c] == NO_INDEX || triangle.n[c] < mesh.normals.size(), "normals are in range");
        promise(triangle.t[c] == NO_INDEX || triangle.t[c] < mesh.uvs.size(), "coordinates are in range");
    }
    promise(triangle.material < materials, "materials are in range");
    promise(triangle.object < mesh.object_names.size(), "objects are in range");
}

inline void check_sound(const SceneDescription& scene) {
    const Mesh& mesh = scene.mesh;
    promise(!mesh.triangles.empty(), "a scene has triangles");
    promise(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size(), "colours are of positions");
    for (const MeshTriangle& triangle : mesh.triangles)
        check_sound_triangle(mesh, triangle, scene.materials.size());
}

/// What a target does: any bytes give a sound description, for which check(description) holds too, or a
/// SceneError. `name`: of the file that they are.
template <typename Check>
void check_reader(const SceneReader& reader, const char* name, std::string_view bytes, Check&& check) {
    Progress silent(Toggle::OFF, true);
    NoticeList notices;
    try {
        reader.recognises(bytes);
        const SceneDescription scene =
            reader.read({name, std::string(bytes)}, {silent, notices, {}, MtlReading::AUTO, {}});
        check_sound(scene);
        check(scene);
    } catch (const SceneError&) {
    }
    notices.lines();
}

} // namespace clrt
