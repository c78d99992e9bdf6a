// SPDX-License-Identifier: Apache-2.0
#include "bench/trees.h"

#include "bench/embree_builder.h"
#include "effects/planned_scene.h"
#include "scene/load_scene.h"

#include <functional>

namespace clrt {

namespace {

/// What a builder made of the scene in one round.
struct Outcome {
    double sah_cost;
    size_t references;
    Cost cost;
};

/// A builder on its way through the rounds.
struct Builder {
    std::string name;
    std::function<Outcome()> build;
    Outcome last{};
    std::vector<double> wall{}, cpu{};

    void play() {
        last = build();
        wall.push_back(last.cost.wall);
        cpu.push_back(last.cost.cpu);
    }
    void forget() {
        wall.clear();
        cpu.clear();
    }
};

Outcome build_own(const Scene& scene, BvhLayout layout, BvhQuality quality) {
    Bvh bvh;
    const Cost cost = measure([&] { bvh = build_bvh(scene.positions, scene.triangles, layout, quality); });
    return {bvh.sah_cost, bvh.reference_count, cost};
}

std::vector<Builder> all_builders(const Scene& scene, BvhLayout layout, int threads) {
    std::vector<Builder> builders;
    for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH})
        builders.push_back({std::string("clrt ") + name_of(quality),
                            [&scene, layout, quality] { return build_own(scene, layout, quality); }});
    for (const RTCBuildQuality quality :
         {RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH})
        builders.push_back(
            {std::string("Embree ") + quality_name(quality), [&scene, layout, quality, threads] {
                 const EmbreeTree tree = build_embree_tree(scene, layout, quality, threads);
                 return Outcome{tree.sah_cost, tree.references, tree.cost};
             }});
    return builders;
}

size_t usable_triangles(const Scene& scene) {
    return build_bvh(scene.positions, scene.triangles, BvhLayout::BVH8).triangle_count;
}

} // namespace

SceneTrees compare_trees(const BenchOptions& bench, const std::string& path, BvhLayout layout,
                         Progress& progress) {
    const Options options = scene_options(bench, path);
    const std::shared_ptr<const PlannedScene> planned = plan_scene(load_scene(options, progress), options);
    const Scene& scene = planned->scene;
    std::vector<Builder> builders = all_builders(scene, layout, bench.clrt.device.threads);
    for (std::uint32_t round = 0; round <= bench.rounds; ++round) {
        progress.update({"trees", double(round) / (bench.rounds + 1)});
        for (Builder& builder : builders) {
            builder.play();
            if (round == 0)
                builder.forget();
        }
    }
    progress.finish();
    SceneTrees result{path, usable_triangles(scene), layout, {}};
    for (const Builder& builder : builders)
        result.trees.push_back({builder.name, builder.last.sah_cost, builder.last.references,
                                spread_of(builder.wall), spread_of(builder.cpu)});
    return result;
}

} // namespace clrt
