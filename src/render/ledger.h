// SPDX-License-Identifier: Apache-2.0
// The bill: what each effect of a scene costs in time and gives in light, and whether compiling for the scene
// pays.
#pragma once

#include "bvh/bvh.h"
#include "console/progress.h"
#include "device/device.h"
#include "effects/effects.h"
#include "options/options.h"
#include "scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Rounds of a ledger. Of nine independent values, the second smallest and the second largest hold the median
/// between them with a probability of 96.1 % (1 - 2 (1 + 9) / 2^9), whatever their distribution: no busy
/// moment of the machine spoils it.
constexpr int LEDGER_ROUNDS = 9;

/// A median with its interval.
struct LedgerValue {
    double median = 0, low = 0, high = 0;
};

/// The median of LEDGER_ROUNDS values.
LedgerValue ledger_value(std::vector<double> values);

/// A program and what it takes to render with it.
struct LedgerProgram {
    double compile_seconds = 0; ///< building, and what the driver compiles at the first launch
    LedgerValue seconds;        ///< of one sample a pixel
};

/// One effect that the scene calls for, against the same picture without it and all that implies it.
struct LedgerRow {
    std::string effect;
    LedgerProgram without;
    LedgerValue seconds;     ///< that the effect takes, of one sample a pixel
    LedgerValue time_share;  ///< of the picture's time; negative: without it rendering takes longer
    LedgerValue light_share; ///< of the picture's mean luminance
};

struct Ledger {
    int width = 0, height = 0;
    BvhQuality bvh_quality = BvhQuality::FAST; ///< of the tree: what the picture itself would get
    std::string bvh_reason;
    std::uint32_t samples = 0;       ///< a pixel and round, in the round with the fewest
    bool is_processor_time = false;  ///< seconds are those of all threads together, else of the wall clock
    LedgerProgram specialised, full; ///< --effects auto (or as given), and all
    LedgerValue full_extra_share;    ///< time of the full program over that of the specialised one, less 1
    /// Samples a pixel after which the specialised program has earned its compilation, the full one being at
    /// hand; and for the upper and the lower end of the difference. None where the difference is not above 0.
    std::optional<double> break_even, break_even_low, break_even_high;
    std::vector<LedgerRow> rows;
    std::vector<std::string> not_measured; ///< effects that did not fit --time
    double seconds = 0;                    ///< of the wall clock that all of it took,
    double compile_seconds = 0;            ///< and of these what came before the rounds
};

/// Renders the scene in rounds: each round once with all that it calls for, once by the full program, and
/// once without each effect, in turning order and with the same random numbers, at least one sample a pixel
/// and round; with the tree that rendering by the same options would build. --time bounds all of it,
/// compiling included: what does not fit is not measured. Without it all effects are compiled and the rounds
/// take a minute. Says beforehand what it will take.
Ledger make_ledger(const Device& device, const Scene& scene, const Options& options, Progress& progress);

/// The table.
std::string format_ledger(const Ledger& ledger, const Options& options, const DeviceInfo& device);

/// The same as JSON, seconds and shares as numbers.
std::string ledger_json(const Ledger& ledger, const Options& options, const DeviceInfo& device);

} // namespace clrt
