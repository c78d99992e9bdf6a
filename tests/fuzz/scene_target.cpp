// SPDX-License-Identifier: Apache-2.0
// From a scene's text to its trees: any OBJ with any MTL gives a scene whose indices are in range, and trees
// of all layouts and qualities, or a SceneError. A line "====" ends the OBJ and starts the MTL, m.mtl.
#include "bvh/bvh.h"
#include "effects/effects.h"
#include "error.h"
#include "fuzz_target.h"
#include "scene/load_scene.h"

#include <cmath>

namespace clrt {

namespace {

constexpr std::string_view MTL_MARK = "\n====\n";

void check(const Scene& scene) {
    promise(!scene.materials.empty(), "a scene has materials");
    for (const Triangle& triangle : scene.triangles) {
        promise(triangle.material < scene.materials.size(), "materials are in range");
        for (const u32 corner : {triangle.v0, triangle.v1, triangle.v2}) {
            promise(corner < scene.positions.size(), "corners are in range");
            const vec4& p = scene.positions[corner];
            promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "corners are finite");
        }
    }
}

void build_trees(const Scene& scene) {
    for (const BvhLayout layout : ALL_LAYOUTS)
        for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH})
            promise(build_bvh(scene.positions, scene.triangles, layout, quality).triangle_count <=
                        scene.triangles.size(),
                    "a tree holds no triangle that is not there");
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    const std::string_view text = as_text(data, size);
    const size_t mark = text.find(MTL_MARK);
    Options options;
    options.scene.path = fuzz_folder().write("a.obj", std::string(text.substr(0, mark)));
    fuzz_folder().write("m.mtl", std::string(mark == text.npos ? "" : text.substr(mark + MTL_MARK.size())));
    try {
        Progress silent(Toggle::OFF, true);
        const Scene scene = load_scene(options, silent);
        check(scene);
        find_effects(scene, options);
        build_trees(scene);
    } catch (const SceneError&) {
    }
    return 0;
}
