// SPDX-License-Identifier: Apache-2.0
// The PLY reader: any bytes give a sound mesh or a SceneError.
#include "error.h"
#include "fuzz_target.h"
#include "scene/readers/ply_header.h"
#include "scene/readers/ply_reader.h"

#include <cmath>

namespace clrt {

namespace {

void check_sound_ply(const SceneDescription& scene) {
    const Mesh& mesh = scene.mesh;
    promise(!mesh.triangles.empty() && scene.materials.size() == 1, "a mesh has triangles of one material");
    promise(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size(), "colours are of positions");
    for (const MeshTriangle& triangle : mesh.triangles)
        for (int c = 0; c < 3; ++c) {
            promise(triangle.v[c] < mesh.positions.size(), "corners are in range");
            const glm::dvec3& p = mesh.positions[triangle.v[c]];
            promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "corners are finite");
            promise(triangle.n[c] == NO_INDEX || triangle.n[c] < mesh.normals.size(), "normals are in range");
            promise(triangle.t[c] == NO_INDEX || triangle.t[c] < mesh.uvs.size(), "coordinates are in range");
        }
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    Progress silent(Toggle::OFF, true);
    NoticeList notices;
    try {
        is_ply(as_text(data, size));
        check_sound_ply(read_ply_scene({"a.ply", std::string(as_text(data, size))},
                                       {silent, notices, {}, MtlReading::AUTO, {}}));
    } catch (const SceneError&) {
    }
    return 0;
}
