// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_pixel.h"

#include "bvh/bvh.h"
#include "effects/take_out.h"
#include "paths/path_report.h"
#include "replay/replay_report.h"

#include <spdlog/spdlog.h>

namespace clrt {

PixelReplay replay_pixel(const Device& device, Scene scene, Options options) {
    Effects effects = find_effects(scene, options);
    take_out_effects(effects.left_out, scene, options);
    if (effects.left_out)
        effects.paths = plan_paths(scene, options);
    if (effects.paths.is_empty)
        spdlog::warn("{}", path_summary(effects.paths));

    const BvhLayout layout = choose_layout(options.bvh.layout, device.info);
    const SceneBuffers buffers =
        upload_scene(device, scene, build_bvh(scene.positions, scene.triangles, layout));
    const SampleAddress address{
        u32(options.run.pixel->y) * u32(options.film.size.x) + u32(options.run.pixel->x), options.run.sample};
    double quantum = 1;
    const auto trace = [&](Precision precision) {
        Replay replay(device, scene, options, precision, effects, layout, buffers);
        quantum = replay.quantum();
        return replay.run({address}).front();
    };
    const Precision first = options.device.precision == Precision::FAST ? Precision::FAST : Precision::SINGLE;
    ReplayReport report{options, scene, device.info, 1, trace(first), std::nullopt};
    if (device.info.fp64 || options.device.precision == Precision::DOUBLE)
        report.twin = trace(Precision::DOUBLE);
    report.quantum = quantum;
    return {format_replay(report, options.run.verbosity > 0), replay_json(report)};
}

} // namespace clrt
