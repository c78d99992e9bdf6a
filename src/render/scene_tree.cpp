// SPDX-License-Identifier: Apache-2.0
#include "render/scene_tree.h"

#include "render/bvh_quality.h"

#include <spdlog/spdlog.h>
#include <utility>

namespace clrt {

SceneTree build_scene_tree(const Scene& scene, const Options& options, BvhLayout layout) {
    BvhQualityChoice choice = choose_bvh_quality(options, scene.triangles.size());
    spdlog::debug("tree: {} ({})", name_of(choice.quality), choice.reason);
    return {build_instanced_bvh(scene.positions, scene.triangles, scene.prototypes, scene.instances, layout,
                                choice.quality, scene.position_moves),
            std::move(choice.reason)};
}

} // namespace clrt
