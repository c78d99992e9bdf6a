// SPDX-License-Identifier: Apache-2.0
// Why samples are bad: the quantity that went wrong first, found by replaying them.
#pragma once

#include "render/render.h"
#include "replay/replay.h"

#include <nlohmann/json_fwd.hpp>

namespace clrt {

/// What a bad sample is counted as (COUNT_*), and where it went wrong.
struct Cause {
    u32 kind = 0;            ///< COUNT_*; COUNT_WORDS: the replay is good, so it is no fault of the sample
    u32 quantity = 0;        ///< TRACE_*; 0: none
    u32 bounce = 0;          ///< of the vertex; 0: the camera
    u32 material = NO_INDEX; ///< there; NO_INDEX: none was hit
    bool operator==(const Cause& other) const {
        return kind == other.kind && quantity == other.quantity && bounce == other.bounce &&
               material == other.material;
    }
};

/// Bad samples of one cause.
struct CauseCount {
    Cause cause;
    std::uint64_t count = 0;
    SampleAddress example; ///< the first of them
};

/// The cause in one record: the first value that is not finite, negative where that has no meaning, or above
/// `largest` where the sample is too large, at the vertex from which the fault was carried on.
Cause find_cause(const SampleTrace& trace, const Scene& scene, double largest);

/// Causes of the samples that a render has noted, the most frequent first.
std::vector<CauseCount> count_causes(const std::vector<SampleTrace>& traces, const Scene& scene,
                                     double largest);

/// Replays the bad samples of a render. Throws what Replay throws.
std::vector<CauseCount> find_causes(const PreparedScene& prepared, const RenderCounts& counts);

/// "NaN", "infinite", "negative", "overflow".
const char* fault_name(u32 kind);

/// Samples that the causes stand for: all bad ones, or the first REPLAY_CAPACITY.
std::uint64_t replayed_samples(const std::vector<CauseCount>& causes);

/// One line a cause with the command that replays an example; says how many of `bad` samples they stand for
/// where it is not all.
std::string format_causes(const std::vector<CauseCount>& causes, std::uint64_t bad, const Scene& scene,
                          const Options& options);

/// The list `by_cause` of --stats.
nlohmann::ordered_json causes_json(const std::vector<CauseCount>& causes, const Scene& scene,
                                   const Options& options);

} // namespace clrt
