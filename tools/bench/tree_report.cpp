// SPDX-License-Identifier: Apache-2.0
// What --trees prints and writes.
#include "bench/embree_side.h"
#include "bench/report.h"
#include "bench/report_json.h"

#include <fmt/format.h>

namespace clrt {

namespace {

std::string seconds_text(const Spread& seconds) {
    return fmt::format("{:.4f} [{:.4f} {:.4f}]", seconds.median, seconds.low, seconds.high);
}

Json built_tree_json(const BuiltTree& tree) {
    return {{"sah_cost", tree.sah_cost},
            {"references", tree.references},
            {"build_seconds", spread_json(tree.wall)},
            {"build_cpu_seconds", spread_json(tree.cpu)}};
}

} // namespace

std::string format_trees(const SceneTrees& scene) {
    std::string text =
        fmt::format("{}: {} triangles, {}\n", scene.path, scene.triangles, name_of(scene.layout));
    text += fmt::format("{:<15}{:>9}{:>12}   {:<25}{}\n", "tree", "SAH cost", "references", "seconds",
                        "CPU seconds");
    for (const BuiltTree& tree : scene.trees)
        text += fmt::format("{:<15}{:>9.3f}{:>12}   {:<25}{}\n", tree.builder, tree.sah_cost, tree.references,
                            seconds_text(tree.wall), seconds_text(tree.cpu));
    return text + "seconds: median [quartiles] of the rounds\n";
}

std::string trees_json(const BenchOptions& bench, const DeviceInfo& device,
                       const std::vector<SceneTrees>& scenes) {
    Json json = run_json(bench, device);
    json["embree"] = embree_version();
    json["rounds"] = bench.rounds;
    for (const SceneTrees& scene : scenes) {
        Json entry;
        entry["scene"] = scene.path;
        entry["triangles"] = scene.triangles;
        entry["layout"] = name_of(scene.layout);
        for (const BuiltTree& tree : scene.trees)
            entry["trees"][tree.builder] = built_tree_json(tree);
        json["scenes"].push_back(entry);
    }
    return json.dump(2) + "\n";
}

} // namespace clrt
