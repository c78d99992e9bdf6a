// SPDX-License-Identifier: Apache-2.0
// The glTF reader. Packed meshes are left to the libraries that unpack them, but for what they are told.
#include "scene/readers/gltf_file.h"
#include "scene/readers/gltf_reader.h"
#include "sound_scene.h"

namespace clrt {

namespace {

void check_gltf(const SceneDescription& scene) {
    for (const PointOptions& point : scene.points)
        promise(point.intensity.x >= 0 && std::isfinite(point.position.x), "lights are lights");
    for (const FileCamera& camera : scene.cameras)
        promise(camera.camera.eye != camera.camera.at, "cameras look somewhere");
}

/// A moment of the file's animations.
SceneDescription read_moment(SceneFile file, const ReadContext& context) {
    ReadContext moment = context;
    moment.gltf.time = 0.5;
    return read_gltf_scene(std::move(file), moment);
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    for (const auto read : {read_gltf_scene, read_moment})
        check_reader({"a glTF", ".gltf", is_gltf, read}, "a.glb", as_text(data, size), check_gltf);
    return 0;
}
