// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_reader.h"

#include "error.h"
#include "scene/readers/gltf_animation.h"
#include "scene/readers/gltf_cameras.h"
#include "scene/readers/gltf_extensions.h"
#include "scene/readers/gltf_flatten.h"

#include <fmt/format.h>

namespace clrt {

namespace {

void note_light_units(const SceneDescription& scene, GltfLights units, const std::string& path,
                      NoticeList& notices) {
    if (scene.points.empty() && scene.suns.empty())
        return;
    notices.add(
        units == GltfLights::BLENDER
            ? fmt::format("lights are in candela and lux and are divided by {}, emission is taken as it "
                          "is: --gltf-lights raw takes both as they are",
                          LUMENS_A_WATT)
            : "lights and emission are taken as they are (--gltf-lights raw)",
        {path, 0});
}

} // namespace

SceneDescription read_gltf_scene(SceneFile source, const ReadContext& context) {
    const GltfFile file(std::move(source));
    check_gltf_extensions(file.json(), context.notices);
    SceneDescription scene;
    scene.is_y_up = true;
    GltfBuffers buffers(file, scene.files);
    GltfMaterials materials(buffers, context);
    GltfMeshes meshes(buffers, materials, context.notices);
    const std::vector<GltfNode> nodes =
        read_gltf_nodes(file.json(), read_gltf_poses(buffers, context.gltf, context.notices));
    for (const GltfNode& node : nodes) {
        add_gltf_camera(file.json(), node, scene);
        add_gltf_light(file.json(), node, context.gltf.lights, scene);
    }
    note_light_units(scene, context.gltf.lights, file.name(), context.notices);
    flatten_gltf(nodes, buffers, meshes, materials, context, scene);
    if (scene.mesh.triangles.empty() && scene.instances.empty())
        throw SceneError(file.name(), 0,
                         fmt::format("the file's scene has no triangles to render; triangles that are left "
                                     "out: {}",
                                     scene.dropped_faces));
    scene.materials = materials.take();
    context.progress.update({"load", 1});
    return scene;
}

} // namespace clrt
