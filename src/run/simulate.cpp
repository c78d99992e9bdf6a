// SPDX-License-Identifier: Apache-2.0
#include "run/simulate.h"

#include "error.h"
#include "paths/path_report.h"
#include "render/bvh_quality.h"
#include "render/kernels.h"
#include "render/scene_buffers.h"

#include <fmt/format.h>
#include <future>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// How the device computes, said where its pictures are its own. Not asked without a cache, where every start
/// would pay. A device that cannot answer renders all the same.
std::optional<DeviceFacts> ask_facts(const Device& device, const Options& options, Progress& progress) {
    if (options.device.cache == Toggle::OFF)
        return std::nullopt;
    std::optional<DeviceFacts> facts;
    try {
        facts = device_facts(device, {options.device.cache, options.device.cache_folder});
    } catch (const DeviceError& error) {
        progress.finish();
        spdlog::warn("how the device computes stays unknown: {}", error.what());
        return std::nullopt;
    }
    const bool is_odd = options.device.precision == Precision::SINGLE && !promises_bits(*facts);
    if (is_odd || options.run.verbosity > 0)
        progress.finish();
    spdlog::debug("device: {}", describe_facts(*facts));
    if (is_odd)
        spdlog::info("this device breaks rules ({}), so its pictures may differ from other devices' in their "
                     "last bits",
                     fmt::join(broken_rules(*facts), ", "));
    return facts;
}

/// Finds out why samples are bad. The render is done: what fails here is only said.
std::vector<CauseCount> explain_bad_samples(const Device& device, const Scene& scene, const Effects& effects,
                                            const Options& options, const BvhLayout layout,
                                            const SceneBuffers& buffers, const Render& render) {
    if (options.run.check == Check::OFF || render.counts.bad_samples.empty() || render.stop_signal)
        return {};
    try {
        return find_causes(device, scene, options, effects, layout, buffers, render.counts);
    } catch (const DeviceError& error) {
        spdlog::warn("bad samples cannot be replayed: {}", error.what());
        return {};
    }
}

} // namespace

Simulation simulate(const Device& device, const Scene& scene, const Effects& effects, const Options& options,
                    Progress& progress, const RenderHooks& hooks) {
    // Compile while the tree is built.
    const BvhLayout layout = choose_layout(options.bvh.layout, device.info);
    progress.update({"compile", -1, 0, -1});
    std::future<RenderPrograms> compiling = std::async(std::launch::async, [&] {
        return build_render_programs(device, options, effects.mask, layout, effects.paths);
    });
    Simulation done;
    const BvhQualityChoice quality = choose_bvh_quality(options, scene.triangles.size());
    spdlog::debug("tree: {} ({})", name_of(quality.quality), quality.reason);
    const bool compare = quality.quality == BvhQuality::HIGH && !options.bvh.quality;
    done.bvh = compare ? build_better_bvh(scene.positions, scene.triangles, layout)
                       : build_bvh(scene.positions, scene.triangles, layout, quality.quality);
    done.bvh_reason = quality.reason;
    if (done.bvh.quality != quality.quality)
        done.bvh_reason += ", but cutting triangles gains too little here";
    done.programs = compiling.get();
    done.compile_seconds = done.programs->seconds;
    done.facts = ask_facts(device, options, progress);
    done.buffers = upload_scene(device, scene, done.bvh);
    simulate_again(device, scene, effects, options, progress, hooks, done);
    return done;
}

void simulate_again(const Device& device, const Scene& scene, const Effects& effects, const Options& options,
                    Progress& progress, const RenderHooks& hooks, Simulation& done) {
    done.render = render(device, *done.programs, *done.buffers, scene, options, progress, hooks);
    done.causes =
        explain_bad_samples(device, scene, effects, options, done.bvh.layout, *done.buffers, done.render);
}

Simulation simulate_nothing(const Scene& scene, const Effects& effects, const Options& options) {
    spdlog::warn("{}", path_summary(effects.paths));
    Simulation done;
    done.render = render_nothing(scene, options);
    return done;
}

} // namespace clrt
