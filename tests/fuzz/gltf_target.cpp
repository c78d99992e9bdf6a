// SPDX-License-Identifier: Apache-2.0
// The glTF reader: any bytes give a sound description or a SceneError. Packed meshes are left to the
// libraries that unpack them, but for what they are told.
#include "error.h"
#include "fuzz_target.h"
#include "scene/place_instances.h"
#include "scene/readers/gltf_file.h"
#include "scene/readers/gltf_reader.h"

#include <cmath>

namespace clrt {

namespace {

void check_triangle(const Mesh& mesh, const MeshTriangle& triangle, const SceneDescription& scene) {
    for (int c = 0; c < 3; ++c) {
        promise(triangle.v[c] < mesh.positions.size(), "corners are in range");
        const glm::dvec3& p = mesh.positions[triangle.v[c]];
        promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "corners are finite");
        promise(triangle.n[c] == NO_INDEX || triangle.n[c] < mesh.normals.size(), "normals are in range");
        promise(triangle.t[c] == NO_INDEX || triangle.t[c] < mesh.uvs.size(), "coordinates are in range");
    }
    promise(triangle.material < scene.materials.size() && triangle.object < scene.mesh.object_names.size(),
            "names are in range");
}

void check_sound(const SceneDescription& scene) {
    promise(!scene.mesh.triangles.empty() || !scene.instances.empty(), "a scene has triangles");
    promise(scene.mesh.colours.empty() || scene.mesh.colours.size() == scene.mesh.positions.size(),
            "colours are of positions");
    for (const MeshTriangle& triangle : scene.mesh.triangles)
        check_triangle(scene.mesh, triangle, scene);
    for (const Mesh& prototype : scene.prototypes)
        for (const MeshTriangle& triangle : prototype.triangles)
            check_triangle(prototype, triangle, scene);
    for (const MeshInstance& instance : scene.instances) {
        promise(instance.prototype < scene.prototypes.size() &&
                    instance.object < scene.mesh.object_names.size(),
                "instances are of prototypes and objects");
        promise(kind_of_map(instance.to_world) == MapKind::PLACES, "instances can be undone");
    }
    for (const PointOptions& point : scene.points)
        promise(point.intensity.x >= 0 && std::isfinite(point.position.x), "lights are lights");
    for (const FileCamera& camera : scene.cameras)
        promise(camera.camera.eye != camera.camera.at, "cameras look somewhere");
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    Progress silent(Toggle::OFF, true);
    NoticeList notices;
    try {
        is_gltf(as_text(data, size));
        for (const Toggle instances : {Toggle::OFF, Toggle::ON})
            check_sound(read_gltf_scene({"a.glb", std::string(as_text(data, size))},
                                        {silent, notices, {}, MtlReading::AUTO, {}, instances}));
    } catch (const SceneError&) {
    }
    notices.lines();
    return 0;
}
