// SPDX-License-Identifier: Apache-2.0
// The PLY reader.
#include "scene/readers/ply_header.h"
#include "scene/readers/ply_reader.h"
#include "sound_scene.h"

namespace clrt {

namespace {

void check_ply(const SceneDescription& scene) {
    promise(scene.materials.size() == 1, "there is one material");
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    check_reader({"a PLY", ".ply", is_ply, read_ply_scene}, "a.ply", as_text(data, size), check_ply);
    return 0;
}
