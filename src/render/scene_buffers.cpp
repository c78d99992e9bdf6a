// SPDX-License-Identifier: Apache-2.0
#include "render/scene_buffers.h"

namespace clrt {

SceneBuffers upload_scene(const Device& device, const Scene& scene, const Bvh& bvh) {
    SceneBuffers result;
    const auto add = [&](const char* name, const auto& data) {
        result.buffers.emplace_back(name, upload_buffer(device, name, data));
    };
    add("bvh_nodes", bvh.nodes);
    add("bvh_leaves", bvh.leaves);
    add("triangles", scene.triangles);
    add("positions", scene.positions);
    add("normals", scene.normals);
    add("uvs", scene.uvs);
    add("materials", scene.materials);
    add("textures", scene.textures);
    add("texel_words", scene.texel_words);
    add("emitters", scene.emitters);
    add("lights", scene.lights);
    add("environment", scene.environment.texels);
    return result;
}

void bind_scene(const SceneBuffers& scene, Kernel& kernel) {
    for (const auto& [name, buffer] : scene.buffers)
        kernel.set(name, buffer);
}

} // namespace clrt
