// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_pixel.h"

#include "paths/path_report.h"
#include "replay/replay_report.h"

#include <spdlog/spdlog.h>

namespace clrt {

PixelReplay replay_pixel(const PreparedScene& prepared) {
    const Options& options = prepared.planned->options;
    if (prepared.planned->effects.paths.is_empty)
        spdlog::warn("{}", path_summary(prepared.planned->effects.paths));
    const SampleAddress address{
        u32(options.run.pixel->y) * u32(options.film.size.x) + u32(options.run.pixel->x), options.run.sample};
    double quantum = 1;
    const auto trace = [&](Precision precision) {
        Replay replay(prepared, precision);
        quantum = replay.quantum();
        return replay.run({address}).front();
    };
    const Precision first = options.device.precision == Precision::FAST ? Precision::FAST : Precision::SINGLE;
    const DeviceInfo& device = prepared.device.info;
    ReplayReport report{options, prepared.planned->scene, device, 1, trace(first), std::nullopt};
    if (device.fp64 || options.device.precision == Precision::DOUBLE)
        report.twin = trace(Precision::DOUBLE);
    report.quantum = quantum;
    return {format_replay(report, options.run.verbosity > 0), replay_json(report)};
}

} // namespace clrt
