// SPDX-License-Identifier: Apache-2.0
#include "bench/speed.h"

#include "bench/embree_side.h"
#include "bench/ray_sets.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Seconds of every round of one side.
using Rounds = std::vector<double>;

double seconds(const Cost& cost, bool cpu_time) {
    return cpu_time ? cost.cpu : cost.wall;
}

Spread rates(const Rounds& rounds, size_t rays) {
    std::vector<double> values;
    for (const double time : rounds)
        values.push_back(double(rays) / time);
    return spread_of(values);
}

Spread ratios(const Rounds& clrt, const Rounds& other) {
    std::vector<double> values;
    for (size_t i = 0; i < clrt.size(); ++i)
        values.push_back(other[i] / clrt[i]);
    return spread_of(values);
}

/// A kind of rays on its way through the rounds.
struct Contest {
    const RaySet& set;
    DeviceRays device_rays;
    std::vector<BenchHit> embree_hits, robust_hits;
    Rounds clrt, embree, robust;

    Contest(const RaySet& rays, const ClrtSide& side) : set(rays), device_rays(side.upload(rays.rays)) {}

    /// Traces once on every side, the order turning from round to round.
    void play(ClrtSide& clrt_side, const EmbreeSide& embree_side, const EmbreeSide& robust_side, u32 round,
              bool cpu_time) {
        const bool any = wants_any_hit(set.kind);
        for (u32 turn = 0; turn < 3; ++turn)
            switch ((round + turn) % 3) {
            case 0:
                clrt.push_back(seconds(measure([&] { clrt_side.trace(any, device_rays); }), cpu_time));
                break;
            case 1:
                embree.push_back(
                    seconds(measure([&] { embree_side.trace(any, set.rays, embree_hits); }), cpu_time));
                break;
            default:
                robust.push_back(
                    seconds(measure([&] { robust_side.trace(any, set.rays, robust_hits); }), cpu_time));
            }
    }

    /// Forgets the rounds so far, which were for warming up.
    void forget() {
        for (Rounds* rounds : {&clrt, &embree, &robust})
            rounds->clear();
    }

    /// Sums the rounds up, judges the hits of the last one and counts visits.
    KindSpeed result(ClrtSide& side, const RoundingBound& bound) const {
        const bool any = wants_any_hit(set.kind);
        KindSpeed speed;
        speed.kind = set.kind;
        speed.rays = set.rays.size();
        const std::vector<BenchHit> clrt_hits = side.read(device_rays);
        for (const BenchHit& hit : clrt_hits)
            speed.hits += hit.triangle != NO_INDEX;
        speed.verdict = arbitrate(side.scene(), bound, any, set.rays, clrt_hits, embree_hits);
        speed.verdict_robust = arbitrate(side.scene(), bound, any, set.rays, clrt_hits, robust_hits);
        speed.visits = side.count_visits(any, device_rays);
        speed.ratio = ratios(clrt, embree);
        speed.ratio_robust = ratios(clrt, robust);
        speed.clrt = rates(clrt, speed.rays);
        speed.embree = rates(embree, speed.rays);
        speed.embree_robust = rates(robust, speed.rays);
        return speed;
    }
};

} // namespace

bool is_wrong(const SceneSpeed& scene) {
    return std::any_of(scene.kinds.begin(), scene.kinds.end(), [](const KindSpeed& kind) {
        return kind.verdict.clrt_wrong > 0 || kind.verdict_robust.clrt_wrong > 0;
    });
}

SceneSpeed compare_speed(const Device& device, const BenchOptions& bench, const std::string& path,
                         Progress& progress) {
    const Options options = scene_options(bench, path);
    const std::shared_ptr<const PlannedScene> planned = plan_scene(load_scene(options, progress), options);
    progress.update({"trees and rays"});
    ClrtSide clrt(device, all_kernel_files(bench.clrt.device.kernels_folder), planned);
    const int threads = bench.clrt.device.threads;
    const EmbreeSide embree(planned->scene, /*robust=*/false, threads, bench.isa),
        robust(planned->scene, /*robust=*/true, threads, bench.isa);
    const std::vector<RaySet> sets = make_ray_sets(clrt, bench.rays);

    // Round 0 warms up: the driver finishes compiling, pages are touched.
    std::vector<Contest> contests;
    for (const RaySet& set : sets)
        if (!set.rays.empty())
            contests.emplace_back(set, clrt);
    for (u32 round = 0; round <= bench.rounds; ++round) {
        progress.update({"rounds", double(round) / (bench.rounds + 1)});
        for (Contest& contest : contests) {
            contest.play(clrt, embree, robust, round, bench.cpu_time);
            if (round == 0)
                contest.forget();
        }
    }
    progress.update({"hits"});

    SceneSpeed result;
    result.path = path;
    result.triangles = clrt.bvh().triangle_count;
    result.layout = fmt::format("{} {}", name_of(clrt.bvh().layout), name_of(clrt.bvh().quality));
    result.sah_cost = clrt.bvh().sah_cost;
    result.clrt = {clrt.build_cost(), 4 * (clrt.bvh().nodes.size() + clrt.bvh().leaves.size())};
    result.embree = {embree.build_cost(), embree.bytes()};
    result.builder_quality = matching_quality(clrt.bvh().quality);
    result.embree_builder = build_embree_tree(planned->scene, clrt.bvh().layout, result.builder_quality,
                                              bench.clrt.device.threads);
    const RoundingBound bound = rounding_bound(device.info.correctly_rounded_division);
    for (const Contest& contest : contests)
        result.kinds.push_back(contest.result(clrt, bound));
    progress.finish();
    return result;
}

} // namespace clrt
