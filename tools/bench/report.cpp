// SPDX-License-Identifier: Apache-2.0
#include "bench/report.h"

#include "bench/embree_side.h"
#include "bench/report_json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace clrt {

namespace {

/// The median, and the quartiles of the rounds.
std::string ratio_text(const Spread& ratio) {
    return fmt::format("{:.3f} [{:.3f} {:.3f}]", ratio.median, ratio.low, ratio.high);
}

double per_triangle(double value, const SceneSpeed& scene) {
    return scene.triangles ? value / double(scene.triangles) : 0;
}

double triangles_per_second(double seconds, const SceneSpeed& scene) {
    return seconds > 0 ? double(scene.triangles) / seconds : 0;
}

Json tree_json(const TreeFigures& tree, const SceneSpeed& scene) {
    return {{"build_seconds", tree.cost.wall},
            {"build_cpu_seconds", tree.cost.cpu},
            {"triangles_per_second", triangles_per_second(tree.cost.wall, scene)},
            {"bytes", tree.bytes},
            {"bytes_per_triangle", per_triangle(double(tree.bytes), scene)}};
}

Json verdict_json(const Verdict& verdict) {
    Json json = {{"twins", verdict.twins},
                 {"differences", verdict.differences},
                 {"judged", verdict.judged},
                 {"clrt_wrong", verdict.clrt_wrong},
                 {"embree_wrong", verdict.rival_wrong}};
    if (!verdict.first_wrong.empty())
        json["first_wrong"] = verdict.first_wrong;
    return json;
}

Json kind_json(const KindSpeed& kind) {
    Json json = {{"rays", kind.rays},
                 {"hits", kind.hits},
                 {"ratio", spread_json(kind.ratio)},
                 {"ratio_robust", spread_json(kind.ratio_robust)},
                 {"clrt_rays_per_second", spread_json(kind.clrt)},
                 {"embree_rays_per_second", spread_json(kind.embree)},
                 {"embree_robust_rays_per_second", spread_json(kind.embree_robust)}};
    json["visits_per_ray"] = {
        {"nodes", kind.visits.nodes}, {"leaves", kind.visits.leaves}, {"triangles", kind.visits.triangles}};
    json["hits_compared"] = {{"embree", verdict_json(kind.verdict)},
                             {"embree_robust", verdict_json(kind.verdict_robust)}};
    return json;
}

Json scene_json(const SceneSpeed& scene) {
    Json json;
    json["scene"] = scene.path;
    json["triangles"] = scene.triangles;
    json["layout"] = scene.layout;
    for (const KindSpeed& kind : scene.kinds)
        json["ratio"][ray_kind_name(kind.kind)] = kind.ratio.median;
    for (const KindSpeed& kind : scene.kinds)
        json["kinds"][ray_kind_name(kind.kind)] = kind_json(kind);
    json["tree"]["clrt"] = tree_json(scene.clrt, scene);
    json["tree"]["clrt"]["sah_cost"] = scene.sah_cost;
    json["tree"]["embree"] = tree_json(scene.embree, scene);
    json["tree"]["embree_builder"] = {{"quality", quality_name(scene.builder_quality)},
                                      {"build_seconds", scene.embree_builder.cost.wall},
                                      {"build_cpu_seconds", scene.embree_builder.cost.cpu},
                                      {"sah_cost", scene.embree_builder.sah_cost},
                                      {"references", scene.embree_builder.references}};
    return json;
}

/// The geometric mean over the scenes, by kind.
Json mean_ratios(const std::vector<SceneSpeed>& scenes) {
    Json json = Json::object();
    for (const RayKind kind : RAY_KINDS) {
        double logs = 0;
        int count = 0;
        for (const SceneSpeed& scene : scenes)
            for (const KindSpeed& speed : scene.kinds)
                if (speed.kind == kind)
                    logs += std::log(speed.ratio.median), ++count;
        json[ray_kind_name(kind)] = count ? Json(std::exp(logs / count)) : Json();
    }
    return json;
}

std::string tree_text(const char* name, const TreeFigures& tree, const SceneSpeed& scene, bool cpu_time) {
    const double seconds = cpu_time ? tree.cost.cpu : tree.cost.wall;
    return fmt::format("{} {:.3f} s, {:.2f} Mtris/s, {:.1f} bytes a triangle", name, seconds,
                       1e-6 * triangles_per_second(seconds, scene), per_triangle(double(tree.bytes), scene));
}

/// One line on the hits that differ from a rival's; nothing where none does.
std::string verdict_text(const KindSpeed& kind, const Verdict& verdict, const char* rival) {
    if (verdict.differences == 0)
        return "";
    std::string text =
        fmt::format("hits    {}: {} of {} rays differ from {} beyond rounding; wrong: clrt {}, {} {}",
                    ray_kind_name(kind.kind), verdict.differences, verdict.rays, rival, verdict.clrt_wrong,
                    rival, verdict.rival_wrong);
    if (verdict.judged < verdict.differences)
        text += fmt::format(" (of the first {})", verdict.judged);
    if (!verdict.first_wrong.empty())
        text += "\n        clrt is WRONG " + verdict.first_wrong;
    return text + "\n";
}

/// Averages over the rays of each kind.
std::string visits_text(const SceneSpeed& scene) {
    std::string text = "a ray visits";
    for (const KindSpeed& kind : scene.kinds)
        text += fmt::format("{} {} {:.1f} nodes, {:.1f} leaves, {:.1f} triangles",
                            &kind == &scene.kinds[0] ? "" : ";", ray_kind_name(kind.kind), kind.visits.nodes,
                            kind.visits.leaves, kind.visits.triangles);
    return text + "\n";
}

} // namespace

Json run_json(const BenchOptions& bench, const DeviceInfo& device) {
    Json json;
    json["version"] = CLRT_VERSION;
    json["command"] = fmt::format("{}", fmt::join(bench.command, " "));
    json["device"] = {{"platform", device.platform}, {"name", device.name}, {"driver", device.driver}};
    return json;
}

Json spread_json(const Spread& spread) {
    return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}};
}

std::string format_speed(const SceneSpeed& scene, bool cpu_time) {
    std::string text = fmt::format("{}: {} triangles, {}\n", scene.path, scene.triangles, scene.layout);
    text += fmt::format("{:<8}{:>10}{:>9}{:>9}   {:<22}{:>9}   {}\n", "rays", "number", "clrt", "Embree",
                        "clrt / Embree", "robust", "clrt / robust");
    for (const KindSpeed& kind : scene.kinds)
        text +=
            fmt::format("{:<8}{:>10}{:>9.3f}{:>9.3f}   {:<22}{:>9.3f}   {}\n", ray_kind_name(kind.kind),
                        kind.rays, 1e-6 * kind.clrt.median, 1e-6 * kind.embree.median, ratio_text(kind.ratio),
                        1e-6 * kind.embree_robust.median, ratio_text(kind.ratio_robust));
    text += fmt::format("million rays a second of {} time; ratios: median [quartiles] of the rounds\n",
                        cpu_time ? "CPU" : "wall");
    text += "trees " + tree_text("clrt", scene.clrt, scene, cpu_time) +
            fmt::format(", SAH cost {:.2f}; ", scene.sah_cost) +
            tree_text("Embree", scene.embree, scene, cpu_time) +
            fmt::format("; Embree's builder ({}) {:.3f} s, SAH cost {:.2f}\n",
                        quality_name(scene.builder_quality),
                        cpu_time ? scene.embree_builder.cost.cpu : scene.embree_builder.cost.wall,
                        scene.embree_builder.sah_cost);
    text += visits_text(scene);
    for (const KindSpeed& kind : scene.kinds)
        text += verdict_text(kind, kind.verdict, "Embree") +
                verdict_text(kind, kind.verdict_robust, "robust Embree");
    return text;
}

std::string speed_json(const BenchOptions& bench, const DeviceInfo& device,
                       const std::vector<SceneSpeed>& scenes) {
    Json json = run_json(bench, device);
    json["embree"] = embree_version();
    json["embree_isa"] = bench.isa.empty() ? Json() : Json(bench.isa);
    json["rounds"] = bench.rounds;
    json["time"] = bench.cpu_time ? "cpu" : "wall";
    json["ratio"] = mean_ratios(scenes);
    for (const SceneSpeed& scene : scenes)
        json["scenes"].push_back(scene_json(scene));
    return json.dump(2) + "\n";
}

std::string format_watertight(const std::vector<WatertightCase>& cases) {
    std::string text = fmt::format("{:<12} {:<33} {:>9} {:>12} {:>6} {:>8}\n", "mesh", "place", "triangles",
                                   "rays", "lost", "lost any");
    for (const WatertightCase& result : cases) {
        text += fmt::format("{:<12} {:<33} {:>9} {:>12} {:>6} {:>8}\n", result.mesh, result.place,
                            result.triangles, result.rays, result.lost, result.lost_any);
        if (const auto& ray = result.lost_ray)
            text += fmt::format(
                "             LOST from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g})\n",
                ray->origin.x, ray->origin.y, ray->origin.z, ray->direction.x, ray->direction.y,
                ray->direction.z);
    }
    return text;
}

std::string watertight_json(const BenchOptions& bench, const DeviceInfo& device,
                            const std::vector<WatertightCase>& cases, double seconds) {
    Json json = run_json(bench, device);
    std::uint64_t rays = 0;
    for (const WatertightCase& result : cases)
        rays += result.rays;
    json["rays"] = rays;
    json["lost"] = count_lost(cases);
    json["seconds"] = seconds;
    for (const WatertightCase& result : cases)
        json["cases"].push_back({{"mesh", result.mesh},
                                 {"place", result.place},
                                 {"triangles", result.triangles},
                                 {"rays", result.rays},
                                 {"lost", result.lost},
                                 {"lost_any", result.lost_any}});
    return json.dump(2) + "\n";
}

std::string format_robustness(const Robustness& robustness, bool cpu_time) {
    std::string text = fmt::format("{}: {} triangles, {}\n{:<36}", robustness.scene, robustness.triangles,
                                   robustness.layout, "variant");
    for (const VariantKind& kind : robustness.variants.front().kinds)
        text += fmt::format("{:<21}", ray_kind_name(kind.kind));
    text += fmt::format("{:<20}{}\n", "wrong", "lost of those aimed");
    for (const Variant& variant : robustness.variants) {
        size_t rays = 0, wrong = 0;
        text += fmt::format("{:<36}", variant.name);
        for (const VariantKind& kind : variant.kinds) {
            text += fmt::format(
                "{:<21}", fmt::format("{:.1f} ns ({:.3f})", 1e9 * kind.seconds.median, kind.ratio.median));
            rays += kind.rays;
            wrong += kind.wrong;
        }
        text += fmt::format("{:<20}{} of {}\n", fmt::format("{} of {}", wrong, rays), variant.lost,
                            variant.aimed);
    }
    return text + fmt::format("ns of {} time a ray (ratio to the first row), medians of the rounds\n",
                              cpu_time ? "CPU" : "wall");
}

std::string robustness_json(const BenchOptions& bench, const DeviceInfo& device,
                            const std::vector<Robustness>& scenes) {
    Json json = run_json(bench, device);
    json["rounds"] = bench.rounds;
    json["time"] = bench.cpu_time ? "cpu" : "wall";
    for (const Robustness& scene : scenes) {
        Json variants = Json::array();
        for (const Variant& variant : scene.variants) {
            Json entry = {{"name", variant.name}, {"aimed", variant.aimed}, {"lost", variant.lost}};
            for (const VariantKind& kind : variant.kinds)
                entry["kinds"][ray_kind_name(kind.kind)] = {{"seconds_per_ray", spread_json(kind.seconds)},
                                                            {"ratio", spread_json(kind.ratio)},
                                                            {"rays", kind.rays},
                                                            {"wrong", kind.wrong}};
            variants.push_back(entry);
        }
        json["scenes"].push_back({{"scene", scene.scene},
                                  {"triangles", scene.triangles},
                                  {"layout", scene.layout},
                                  {"variants", variants}});
    }
    return json.dump(2) + "\n";
}

} // namespace clrt
