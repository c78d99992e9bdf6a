// SPDX-License-Identifier: Apache-2.0
// The bill: what each effect of a scene costs in time and gives in light, what the code of the others would
// cost, and whether compiling for the scene pays.
#pragma once

#include "bvh/bvh.h"
#include "console/progress.h"
#include "device/device.h"
#include "effects/effects.h"
#include "options/options.h"
#include "render/paired_estimate.h"
#include "scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// A program is given a bit for an effect, if without the effect's code scenes that do not show it render
/// faster by more than this (DESIGN, section 3).
constexpr double EFFECT_RULE_SHARE = 0.01;

/// Which clock a ledger's seconds are of.
enum class LedgerClock {
    PROCESSOR, ///< all threads of this process together: devices that are the processor
    DEVICE     ///< launches by the device's own clock
};

/// A program and what it takes to render with it.
struct LedgerProgram {
    double compile_seconds = 0; ///< building, and what the driver compiles at the first launch
    LedgerValue seconds;        ///< of one sample a pixel
};

/// One effect against the picture: the picture without it and all that implies it, where the picture shows
/// the effect; else the same picture by a program with the effect's code.
struct LedgerRow {
    std::string effect;
    LedgerProgram other;      ///< what the picture's program was paired with
    double compile_extra = 0; ///< seconds that compiling it took longer than the picture's right before it
    LedgerValue seconds;      ///< that the effect or its code takes, of one sample a pixel
    LedgerValue time_share;   ///< of the picture's time; negative: without it rendering takes longer
    LedgerValue light_share;  ///< of the picture's mean luminance; 0 where it is not shown
    size_t pairs = 0;
};

struct Ledger {
    LedgerOf of = LedgerOf::SHOWN;
    int width = 0, height = 0;
    BvhQuality bvh_quality = BvhQuality::FAST; ///< of the tree: what the picture itself would get
    std::string bvh_reason;
    std::uint32_t samples = 0; ///< a pixel and run
    LedgerClock clock = LedgerClock::PROCESSOR;
    LedgerProgram specialised, full; ///< --effects auto (or as given), and all
    /// The most by which compiling the specialised program took longer or shorter than the time before: it
    /// is compiled beside each other one, and smaller differences are not seen.
    double compile_scatter = 0;
    double full_compile_extra = 0; ///< as in a row
    LedgerValue full_extra_share;  ///< time of the full program over that of the specialised one, less 1
    size_t full_pairs = 0;
    /// Samples a pixel after which the specialised program has earned its compilation, the full one being at
    /// hand; and for the upper and the lower end of the difference. None where the difference is not above 0.
    std::optional<double> break_even, break_even_low, break_even_high;
    std::vector<LedgerRow> rows;
    std::vector<std::string> not_measured; ///< effects that did not fit --time
    double seconds = 0;                    ///< of the wall clock that all of it took,
    double compile_seconds = 0;            ///< and of these what was not pairs
};

/// Prices the effects that the picture shows, or the code of the absent ones (Options::run). Renders the
/// picture in pairs: once with all that it calls for and once without an effect, or by the full program, one
/// after the other, in turning order, with the same samples, until the interval of their ratio is narrow
/// (is_narrow) or the effect's share of the time is spent; with the tree that rendering by the same options
/// would build. --time bounds all of it, compiling included: what does not fit is not measured. Without it
/// all effects are compiled and the pairs take a minute at most, but where FEWEST_PAIRS of each take longer.
/// Says beforehand what it will take.
Ledger make_ledger(const Device& device, const Scene& scene, const Options& options, Progress& progress);

/// "costs 3.0 % (1.0 - 5.0)", "saves ..." or "no cost seen (at most 1.0 %)".
std::string describe_cost(const LedgerValue& share);

/// What an absent effect's share of the time says about EFFECT_RULE_SHARE.
enum class RuleSide { BELOW, ABOVE, UNDECIDED };
RuleSide rule_side(const LedgerValue& share);

/// The table.
std::string format_ledger(const Ledger& ledger, const Options& options, const DeviceInfo& device);

/// The same as JSON, seconds and shares as numbers.
std::string ledger_json(const Ledger& ledger, const Options& options, const DeviceInfo& device);

} // namespace clrt
