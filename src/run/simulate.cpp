// SPDX-License-Identifier: Apache-2.0
#include "run/simulate.h"

#include "error.h"
#include "paths/path_report.h"
#include "render/shared_render.h"

#include <algorithm>
#include <fmt/format.h>
#include <future>
#include <spdlog/spdlog.h>
#include <utility>

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
std::vector<CauseCount> explain_bad_samples(const PreparedScene& prepared, const Render& render) {
    if (prepared.planned->options.run.check == Check::OFF || render.counts.bad_samples.empty() ||
        render.stop_signal)
        return {};
    try {
        return find_causes(prepared, render.counts);
    } catch (const DeviceError& error) {
        spdlog::warn("bad samples cannot be replayed: {}", error.what());
        return {};
    }
}

/// Prepares the scene on every device; what compiles does so side by side.
void prepare(const std::vector<Device>& devices, const std::shared_ptr<const PlannedScene>& planned,
             PreparedParts parts, Simulation& done) {
    std::vector<std::future<std::shared_ptr<const RenderPrograms>>> programs;
    for (size_t i = 1; i < devices.size(); ++i)
        programs.push_back(
            std::async(std::launch::async, [&, i] { return plan_programs(devices[i], *planned); }));
    done.prepared.emplace(prepare_render(devices.front(), planned, std::move(parts)));
    for (size_t i = 1; i < devices.size(); ++i)
        done.others.push_back(
            prepare_scene(devices[i], planned, {done.prepared->tree, programs[i - 1].get()}));
}

} // namespace

Simulation simulate(const std::vector<Device>& devices, const std::shared_ptr<const PlannedScene>& planned,
                    Progress& progress, const RenderHooks& hooks, PreparedParts parts) {
    Simulation done;
    if (!planned->effects.paths.is_empty) {
        progress.update({"compile", -1, 0, -1});
        prepare(devices, planned, std::move(parts), done);
        for (const Device& device : devices) {
            std::optional<DeviceFacts> facts = ask_facts(device, planned->options, progress);
            if (!done.facts || (facts && promises_bits(*done.facts) && !promises_bits(*facts)))
                done.facts = std::move(facts);
        }
        simulate_again(progress, hooks, done);
    } else {
        spdlog::warn("{}", path_summary(planned->effects.paths));
        done.render = render_nothing(*planned);
    }
    return done;
}

void simulate_again(Progress& progress, const RenderHooks& hooks, Simulation& done) {
    if (!done.prepared)
        return;
    const std::vector<const PreparedScene*> scenes = working_scenes(done);
    if (done.others.empty()) {
        done.render = render(*done.prepared, progress, hooks);
    } else {
        done.render = render_shared(scenes, progress, hooks);
        for (size_t i = 0; i < scenes.size(); ++i)
            if (!done.render.shares[i].work.failure.empty())
                done.failed.push_back(&scenes[i]->device);
    }
    done.causes = explain_bad_samples(*working_scenes(done).front(), done.render);
}

std::vector<const PreparedScene*> working_scenes(const Simulation& done) {
    std::vector<const PreparedScene*> scenes;
    const auto add = [&](const PreparedScene& scene) {
        if (std::find(done.failed.begin(), done.failed.end(), &scene.device) == done.failed.end())
            scenes.push_back(&scene);
    };
    if (done.prepared)
        add(*done.prepared);
    std::for_each(done.others.begin(), done.others.end(), add);
    return scenes;
}

} // namespace clrt
