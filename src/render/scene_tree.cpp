// SPDX-License-Identifier: Apache-2.0
#include "render/scene_tree.h"

#include "render/bvh_quality.h"

#include <spdlog/spdlog.h>
#include <utility>

namespace clrt {

SceneTree build_scene_tree(const Scene& scene, const Options& options, BvhLayout layout) {
    BvhQualityChoice choice = choose_bvh_quality(options, scene.triangles.size());
    spdlog::debug("tree: {} ({})", name_of(choice.quality), choice.reason);
    const bool compare = choice.quality == BvhQuality::HIGH && !options.bvh.quality;
    SceneTree tree;
    tree.bvh = compare ? build_better_bvh(scene.positions, scene.triangles, layout)
                       : build_bvh(scene.positions, scene.triangles, layout, choice.quality);
    tree.reason = std::move(choice.reason);
    if (tree.bvh.quality != choice.quality)
        tree.reason += ", but cutting triangles gains too little here";
    return tree;
}

} // namespace clrt
