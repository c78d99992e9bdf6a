// SPDX-License-Identifier: Apache-2.0
#include "bench/robustness.h"

#include "bench/arbitrate.h"
#include "bench/closed_meshes.h"
#include "bench/clrt_side.h"
#include "bench/ray_sets.h"
#include "bench/watertight.h"
#include "render/kernels.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace clrt {

namespace {

constexpr std::uint64_t DEFAULT_AIMED_RAYS = 4000000;

std::vector<Variant> make_variants() {
    const auto variant = [](const char* name, bool triangle, bool box) {
        Variant result;
        result.name = name;
        result.plain_triangle = triangle;
        result.plain_box = box;
        return result;
    };
    return {variant("watertight triangles, padded boxes", false, false),
            variant("Moeller-Trumbore, padded boxes", true, false),
            variant("watertight triangles, plain boxes", false, true),
            variant("Moeller-Trumbore, plain boxes", true, true)};
}

/// A kind of rays with what every variant took and found.
struct TimedSet {
    RaySet set;
    std::vector<std::vector<double>> seconds; ///< by variant and round
    std::vector<std::vector<BenchHit>> hits;  ///< by variant, of the last round

    /// Traces by one variant.
    void play(ClrtSide& side, size_t variant, bool cpu_time) {
        const DeviceRays rays = side.upload(set.rays);
        const bool any = wants_any_hit(set.kind);
        side.trace(any, rays); // warms the caches up for this variant
        const Cost cost = measure([&] { side.trace(any, rays); });
        seconds[variant].push_back((cpu_time ? cost.cpu : cost.wall) / double(set.rays.size()));
        hits[variant] = side.read(rays);
    }

    VariantKind result(size_t variant) const {
        VariantKind kind;
        kind.kind = set.kind;
        kind.rays = set.rays.size();
        kind.seconds = spread_of(seconds[variant]);
        std::vector<double> ratios;
        for (size_t round = 0; round < seconds[variant].size(); ++round)
            ratios.push_back(seconds[variant][round] / seconds[0][round]);
        kind.ratio = spread_of(ratios);
        return kind;
    }
};

std::vector<TimedSet> timed_sets(ClrtSide& robust, size_t rays, size_t variants) {
    std::vector<TimedSet> result;
    for (RaySet& set : make_ray_sets(robust, rays))
        if (!set.rays.empty() && std::count(std::begin(TIMED_KINDS), std::end(TIMED_KINDS), set.kind)) {
            TimedSet timed;
            timed.set = std::move(set);
            timed.seconds.resize(variants);
            timed.hits.resize(variants);
            result.push_back(std::move(timed));
        }
    return result;
}

/// Times the variants in turns and counts their wrong hits; where a variant differs from the robust one, all
/// triangles in double decide.
void time_variants(const Device& device, const BenchOptions& bench, const KernelFiles& files,
                   const std::shared_ptr<const PlannedScene>& planned, Progress& progress,
                   std::vector<Variant>& variants) {
    std::vector<std::unique_ptr<ClrtSide>> sides;
    for (const Variant& variant : variants)
        sides.push_back(std::make_unique<ClrtSide>(
            device, with_naive(files, variant.plain_triangle, variant.plain_box), planned));
    std::vector<TimedSet> sets = timed_sets(*sides[0], bench.rays, variants.size());
    for (u32 round = 0; round < bench.rounds; ++round) {
        progress.update({"rounds", double(round) / bench.rounds});
        for (TimedSet& set : sets)
            for (size_t turn = 0; turn < variants.size(); ++turn) {
                const size_t variant = (round + turn) % variants.size();
                set.play(*sides[variant], variant, bench.cpu_time);
            }
    }
    progress.update({"hits"});
    const RoundingBound bound = rounding_bound(device.info.correctly_rounded_division);
    for (const TimedSet& set : sets)
        for (size_t i = 0; i < variants.size(); ++i) {
            VariantKind kind = set.result(i);
            // The robust variant is judged beside the plainest.
            const Verdict verdict = arbitrate(planned->scene, bound, wants_any_hit(kind.kind), set.set.rays,
                                              set.hits[i], i == 0 ? set.hits.back() : set.hits[0]);
            kind.wrong = verdict.clrt_wrong;
            variants[i].kinds.push_back(kind);
        }
}

} // namespace

Robustness compare_robustness(const Device& device, const BenchOptions& bench, const std::string& path,
                              Progress& progress) {
    Robustness result;
    result.variants = make_variants();
    const Options options = scene_options(bench, path);
    const std::shared_ptr<const PlannedScene> planned =
        plan_scene(path.empty() ? make_rough_scene() : load_scene(options, progress), options);
    const BvhLayout layout = choose_layout(options.bvh.layout, device.info);
    result.scene = path.empty() ? "a rough torus in a ball" : path;
    result.layout = name_of(layout);
    result.triangles = planned->scene.triangles.size();

    const KernelFiles files = all_kernel_files(bench.clrt.device.kernels_folder);
    time_variants(device, bench, files, planned, progress, result.variants);
    for (size_t i = 0; i < result.variants.size(); ++i) {
        Variant& variant = result.variants[i];
        WatertightRequest request;
        request.rays = bench.aimed_rays > 0 ? bench.aimed_rays : DEFAULT_AIMED_RAYS;
        request.layout = layout;
        request.files = with_naive(files, variant.plain_triangle, variant.plain_box);
        const auto cases = run_watertight(device, request, [&](double share) {
            progress.update({"aimed rays", (double(i) + share) / double(result.variants.size())});
        });
        for (const WatertightCase& aimed : cases)
            variant.aimed += 2 * aimed.rays;
        variant.lost = count_lost(cases);
    }
    progress.finish();
    return result;
}

bool is_wrong(const Robustness& robustness) {
    const Variant& robust = robustness.variants.front();
    return robust.lost > 0 || std::any_of(robust.kinds.begin(), robust.kinds.end(),
                                          [](const VariantKind& kind) { return kind.wrong > 0; });
}

} // namespace clrt
