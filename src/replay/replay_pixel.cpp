// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_pixel.h"

#include "paths/path_report.h"
#include "replay/replay_report.h"

#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// That of the picture, or single where that is double.
Precision replay_precision(const Options& options) {
    return options.device.precision == Precision::FAST ? Precision::FAST : Precision::SINGLE;
}

} // namespace

PixelReplayer::PixelReplayer(const PreparedScene& prepared, ReplayTwin twin)
    : prepared_(prepared), first_(prepared, replay_precision(prepared.planned->options)) {
    const bool has_double =
        prepared.device.info.fp64 || prepared.planned->options.device.precision == Precision::DOUBLE;
    if (twin == ReplayTwin::WHERE_FP64 && has_double)
        twin_.emplace(prepared, Precision::DOUBLE);
}

PixelReplay PixelReplayer::replay(const SampleAddress& address) {
    const PlannedScene& planned = *prepared_.planned;
    ReplayReport report{planned.options,
                        planned.scene,
                        prepared_.device.info,
                        first_.quantum(),
                        first_.run({address}).front(),
                        std::nullopt};
    if (twin_)
        report.twin = twin_->run({address}).front();
    return {format_replay(report, planned.options.run.verbosity > 0), replay_json(report)};
}

PixelReplay replay_pixel(const PreparedScene& prepared) {
    const PlannedScene& planned = *prepared.planned;
    if (planned.effects.paths.is_empty)
        spdlog::warn("{}", path_summary(planned.effects.paths));
    const RunOptions& run = planned.options.run;
    return PixelReplayer(prepared, ReplayTwin::WHERE_FP64)
        .replay({u32(run.pixel->y) * u32(planned.options.film.size.x) + u32(run.pixel->x), run.sample});
}

} // namespace clrt
