// SPDX-License-Identifier: Apache-2.0
// What every reader of scenes promises of its description.
#pragma once

#include "error.h"
#include "fuzz_target.h"
#include "scene/place_instances.h"
#include "scene/readers/reader_table.h"

#include <cmath>

namespace clrt {

/// `mesh`: the scene's, or that of a prototype, whose objects are the scene's too.
inline void check_sound_triangle(const Mesh& mesh, const MeshTriangle& triangle,
                                 const SceneDescription& scene) {
    for (int c = 0; c < 3; ++c) {
        promise(triangle.v[c] < mesh.positions.size(), "corners are in range");
        const glm::dvec3& p = mesh.positions[triangle.v[c]];
        promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "corners are finite");
        promise(triangle.n[c] == NO_INDEX || triangle.n[c] < mesh.normals.size(), "normals are in range");
        promise(triangle.t[c] == NO_INDEX || triangle.t[c] < mesh.uvs.size(), "coordinates are in range");
    }
    promise(triangle.material < scene.materials.size(), "materials are in range");
    promise(triangle.object < scene.mesh.object_names.size(), "objects are in range");
}

inline void check_sound_coordinates(const Mesh& mesh) {
    promise(mesh.second_uvs.empty() || mesh.second_uvs.size() == mesh.uvs.size(),
            "second coordinates lie beside the first");
}

inline void check_sound(const SceneDescription& scene) {
    const Mesh& mesh = scene.mesh;
    promise(!mesh.triangles.empty() || !scene.instances.empty(), "a scene has triangles");
    check_sound_coordinates(mesh);
    promise(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size(), "colours are of positions");
    for (const MeshTriangle& triangle : mesh.triangles)
        check_sound_triangle(mesh, triangle, scene);
    for (const Mesh& prototype : scene.prototypes) {
        check_sound_coordinates(prototype);
        for (const MeshTriangle& triangle : prototype.triangles)
            check_sound_triangle(prototype, triangle, scene);
    }
    for (const MeshInstance& instance : scene.instances) {
        promise(instance.prototype < scene.prototypes.size() && instance.object < mesh.object_names.size(),
                "instances are of prototypes and objects");
        promise(kind_of_map(instance.to_world) == MapKind::PLACES, "instances can be undone");
    }
}

/// What a target does: any bytes give a sound description, for which check(description) holds too, or a
/// SceneError, with and without instances. `name`: of the file that they are.
template <typename Check>
void check_reader(const SceneReader& reader, const char* name, std::string_view bytes, Check&& check) {
    Progress silent(Toggle::OFF, true);
    NoticeList notices;
    try {
        reader.recognises(bytes);
        for (const Toggle instances : {Toggle::OFF, Toggle::ON}) {
            const SceneDescription scene = reader.read(
                {name, std::string(bytes)}, {silent, notices, {}, MtlReading::AUTO, {}, instances});
            check_sound(scene);
            check(scene);
        }
    } catch (const SceneError&) {
    }
    notices.lines();
}

} // namespace clrt
