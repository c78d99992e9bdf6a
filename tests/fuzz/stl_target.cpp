// SPDX-License-Identifier: Apache-2.0
// The STL reader.
#include "scene/readers/stl_reader.h"
#include "sound_scene.h"

namespace clrt {

namespace {

void check_stl(const SceneDescription& scene) {
    promise(scene.materials.size() == 1, "there is one material");
    for (const glm::dvec3& p : scene.mesh.positions)
        promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite");
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    check_reader({"an STL", ".stl", is_stl, read_stl_scene}, "a.stl", as_text(data, size), check_stl);
    return 0;
}
