// SPDX-License-Identifier: Apache-2.0
#include "render/ledger.h"

#include "render/ledger_bench.h"
#include "render/ledger_plan.h"
#include "seconds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

/// The variant and its pairs with the picture.
struct Measured {
    const LedgerVariant& variant;
    const LedgerPairs& pairs;
};

/// Makes one ledger.
class LedgerMaker {
public:
    LedgerMaker(const Device& device, const Scene& scene, const Options& options, Progress& progress)
        : bench_(device, scene, options), variants_(ledger_variants(scene, options)),
          plan_(options.sampling.time_seconds, options.sampling.spp), options_(options), progress_(progress) {
    }

    Ledger make();

private:
    void compile_beside_picture(LedgerVariant& variant);
    void price_full_program(const LedgerVariant& variant, const LedgerPairs& pairs);
    void announce() const;
    LedgerPairs pairs_of(LedgerVariant& other, double seconds);
    void price(size_t i);
    void describe();
    double now() const { return seconds_since(start_); }

    const Clock::time_point start_ = Clock::now();
    const LedgerBench bench_;
    std::vector<LedgerVariant> variants_; ///< the picture, by the full program, effects
    LedgerPlan plan_;
    const Options& options_;
    Progress& progress_;
    Ledger ledger_;
    double pair_seconds_ = 0;
    std::vector<double> compile_seconds_; ///< of the picture's program, each time
};

double seconds_of(const LedgerRun& run) {
    return run.seconds;
}

LedgerValue times(double factor, const LedgerValue& value) {
    return {factor * value.median, factor * value.low, factor * value.high};
}

/// The effect's part of the picture's time: the picture is what has the effect.
LedgerRow shown_row(const Measured& measured) {
    LedgerRow row;
    const LedgerValue without = relative_change(measured.pairs.log_ratio());
    row.time_share = {-without.median, -without.high, -without.low};
    row.light_share = measured.pairs.light_share();
    return row;
}

/// What the code adds to the picture's time: the other variant is what has the code.
LedgerRow absent_row(const Measured& measured) {
    LedgerRow row;
    row.time_share = relative_change(measured.pairs.log_ratio());
    return row;
}

LedgerProgram program_of(const LedgerVariant& variant, const std::vector<LedgerRun>& runs) {
    std::vector<double> seconds;
    std::transform(runs.begin(), runs.end(), std::back_inserter(seconds), seconds_of);
    return {variant.compile_seconds, paired_estimate(seconds)};
}

LedgerRow make_row(LedgerOf of, const Measured& measured) {
    LedgerRow row = of == LedgerOf::ABSENT ? absent_row(measured) : shown_row(measured);
    row.effect = measured.variant.effect;
    row.other = program_of(measured.variant, measured.pairs.other);
    row.seconds = times(program_of(measured.variant, measured.pairs.picture).seconds.median, row.time_share);
    row.pairs = measured.pairs.size();
    return row;
}

void set_break_even(double threads, Ledger& ledger) {
    const auto samples = [&](double extra_share) {
        const double gain = ledger.specialised.seconds.median * extra_share;
        return gain > 0 ? std::optional<double>(ledger.specialised.compile_seconds * threads / gain)
                        : std::nullopt;
    };
    ledger.break_even = samples(ledger.full_extra_share.median);
    ledger.break_even_low = samples(ledger.full_extra_share.high);
    ledger.break_even_high = samples(ledger.full_extra_share.low);
}

/// Compilers take a third longer at one moment than at another: the picture's program is compiled right
/// before each other one.
void LedgerMaker::compile_beside_picture(LedgerVariant& variant) {
    const double begun = now();
    bench_.compile(variants_[0]);
    compile_seconds_.push_back(variants_[0].compile_seconds);
    const double first = now() - begun;
    VariantSeconds seconds = bench_.compile(variant);
    seconds.compile += first;
    plan_.add(seconds);
}

/// Says what is to come before it takes its time.
void LedgerMaker::announce() const {
    const size_t variants = variants_.size() - 1;
    const double needed = plan_.needed(variants, now());
    const size_t fitting = plan_.fitting(variants, now());
    progress_.finish();
    if (fitting == variants)
        spdlog::info("the ledger of {} effects takes {:.0f} s or more", variants - 1, needed);
    else
        spdlog::warn("the ledger of {} effects takes {:.0f} s or more, compiling included: about {} of them "
                     "fit --time {:g}",
                     variants - 1, needed, fitting - 1, *options_.sampling.time_seconds);
}

/// Pairs of the picture and another variant, for so many seconds.
LedgerPairs LedgerMaker::pairs_of(LedgerVariant& other, double seconds) {
    const double end = now() + seconds;
    const auto run = [&](LedgerVariant& variant) {
        return [&](std::uint32_t pair) { return bench_.run(variant, pair, ledger_.samples); };
    };
    return take_pairs(run(variants_[0]), run(other), [&] { return now() < end; });
}

void LedgerMaker::price_full_program(const LedgerVariant& variant, const LedgerPairs& pairs) {
    ledger_.specialised = program_of(variants_[0], pairs.picture);
    ledger_.full = program_of(variant, pairs.other);
    ledger_.full_extra_share = relative_change(pairs.log_ratio());
    ledger_.full_compile_extra = variant.compile_seconds - compile_seconds_.back();
    ledger_.full_pairs = pairs.size();
}

/// Compiles a variant where that is not done, and bills it.
void LedgerMaker::price(size_t i) {
    progress_.update({"ledger", double(i - 1) / double(variants_.size() - 1), 0, -1});
    LedgerVariant& variant = variants_[i];
    if (!variant.planned)
        compile_beside_picture(variant);
    const double begun = now();
    const LedgerPairs pairs = pairs_of(variant, plan_.pair_seconds(variants_.size() - 1, begun));
    plan_.add_pairs(now() - begun);
    pair_seconds_ += now() - begun;
    if (i == 1)
        price_full_program(variant, pairs);
    else {
        ledger_.rows.push_back(make_row(options_.run.ledger, {variant, pairs}));
        ledger_.rows.back().compile_extra = variant.compile_seconds - compile_seconds_.back();
    }
    // Its scene and programs are not needed any more.
    variant.planned.reset();
    variant.parts = {};
}

/// What the ledger is of.
void LedgerMaker::describe() {
    const FilmOptions& film = options_.film;
    ledger_.of = options_.run.ledger;
    ledger_.width = film.crop ? film.crop->x1 - film.crop->x0 : film.size.x;
    ledger_.height = film.crop ? film.crop->y1 - film.crop->y0 : film.size.y;
    ledger_.clock = bench_.clock();
    ledger_.bvh_quality = bench_.tree().bvh.quality;
    ledger_.bvh_reason = bench_.tree().reason;
}

Ledger LedgerMaker::make() {
    progress_.update({"compile", 0, 0, -1});
    bench_.compile(variants_[0]); // what the compiler does once is no program's
    compile_beside_picture(variants_[1]);
    announce();
    ledger_.samples = plan_.samples();
    price(1);
    size_t i = 2;
    while (i < variants_.size() && plan_.fitting(variants_.size() - 1, now()) >= i)
        price(i++);
    for (; i < variants_.size(); ++i)
        ledger_.not_measured.push_back(variants_[i].effect);
    describe();
    ledger_.specialised.compile_seconds = paired_estimate(compile_seconds_).median;
    for (size_t k = 1; k < compile_seconds_.size(); ++k)
        ledger_.compile_scatter =
            std::max(ledger_.compile_scatter, std::fabs(compile_seconds_[k] - compile_seconds_[k - 1]));
    if (variants_[0].mask != variants_[1].mask) // else the same program: what differs is noise
        set_break_even(bench_.threads(), ledger_);
    ledger_.seconds = now();
    ledger_.compile_seconds = ledger_.seconds - pair_seconds_;
    return std::move(ledger_);
}

} // namespace

Ledger make_ledger(const Device& device, const Scene& scene, const Options& options, Progress& progress) {
    return LedgerMaker(device, scene, options, progress).make();
}

} // namespace clrt
