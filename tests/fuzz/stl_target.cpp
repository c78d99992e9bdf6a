// SPDX-License-Identifier: Apache-2.0
// The STL reader: any bytes give a sound mesh or a SceneError.
#include "error.h"
#include "fuzz_target.h"
#include "scene/readers/stl_reader.h"

#include <cmath>

namespace clrt {

namespace {

void check_sound(const SceneDescription& scene) {
    const Mesh& mesh = scene.mesh;
    promise(!mesh.triangles.empty(), "a mesh has triangles");
    promise(scene.materials.size() == 1, "there is one material");
    for (const glm::dvec3& p : mesh.positions)
        promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite");
    for (const MeshTriangle& triangle : mesh.triangles) {
        for (const u32 v : triangle.v)
            promise(v < mesh.positions.size(), "corners are in range");
        promise(triangle.material == 0 && triangle.object < mesh.object_names.size(), "names are in range");
    }
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    Progress silent(Toggle::OFF, true);
    NoticeList notices;
    try {
        is_stl(as_text(data, size));
        check_sound(read_stl_scene({"a.stl", std::string(as_text(data, size))},
                                   {silent, notices, {}, MtlReading::AUTO}));
    } catch (const SceneError&) {
    }
    notices.lines();
    return 0;
}
