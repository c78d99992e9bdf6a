// SPDX-License-Identifier: Apache-2.0
#include "render/ledger.h"

#include "bvh/bvh.h"
#include "console/signals.h"
#include "effects/take_out.h"
#include "error.h"
#include "render/ledger_plan.h"
#include "render/render.h"
#include "render/scene_buffers.h"
#include "seconds.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

/// Seconds that all threads of this process were at work.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double mean_luminance(const Film& film) {
    const std::vector<float> mean = film_mean(film);
    double sum = 0;
    for (size_t i = 0; i + 2 < mean.size(); i += 3)
        sum += 0.2126 * double(mean[i]) + 0.7152 * double(mean[i + 1]) + 0.0722 * double(mean[i + 2]);
    return mean.empty() ? 0 : 3 * sum / double(mean.size());
}

/// One way to render the scene, and what each round of it gave.
struct Variant {
    std::string effect; ///< that is left out; empty: none
    Options options;
    u32 mask = 0;
    PreparedParts parts; ///< made once
    double compile_seconds = 0;
    std::vector<double> seconds, light; ///< a round; seconds of one sample a pixel
};

/// Renders variants, all of them with the tree of the picture as asked for.
class Bench {
public:
    Bench(const Device& device, const Scene& scene, const Options& options) : device_(device), scene_(scene) {
        const auto picture = plan_scene(scene, options);
        options_ = picture->options;
        is_turned_ = turns_triangles(picture->effects.left_out);
        tree_ = plan_tree(device.info, *picture);
    }

    const SceneTree& tree() const { return *tree_; }

    bool is_processor_time() const { return device_.info.type == "CPU"; }

    /// Threads that a processor second is shared by; 1 where seconds are those of the wall clock.
    double threads() const {
        return is_processor_time() ? double(std::max(device_.info.compute_units, 1u)) : 1;
    }

    /// Makes a variant's tree and programs and lets the driver finish them. Compilers work on one thread, and
    /// alone: their seconds are counted. Returns what it took by the wall clock.
    VariantSeconds compile(Variant& variant) const {
        const auto begun = Clock::now();
        variant.options.sampling.spp = 1;
        const auto planned = plan_scene(scene_, variant.options);
        variant.mask = planned->effects.mask;
        variant.parts.tree = tree_of(*planned);
        const double start = processor_seconds();
        variant.parts.programs = plan_programs(device_, *planned);
        const double built = processor_seconds() - start;
        const auto rendered = Clock::now();
        const Render render = run(planned, variant.parts, nullptr);
        const double launched = render.first_launch_seconds;
        variant.compile_seconds = (is_processor_time() ? built : variant.parts.programs->seconds) + launched;
        const double run_seconds = seconds_since(rendered) - launched - render.run_seconds;
        return {seconds_since(begun) - run_seconds - render.run_seconds, run_seconds, render.run_seconds};
    }

    /// Renders a variant; adds the seconds of one sample a pixel and the light to it.
    void measure(Variant& variant, int round, std::uint32_t samples) const {
        Options options = variant.options;
        options.sampling.seed += u32(round);
        options.sampling.spp = samples;
        double seconds = 0;
        const Render render = run(plan_scene(scene_, std::move(options)), variant.parts, &seconds);
        variant.seconds.push_back(seconds / double(samples));
        variant.light.push_back(mean_luminance(render.film));
    }

private:
    /// The tree of the picture, or another by the same rule where triangles are turned round.
    std::shared_ptr<const SceneTree> tree_of(const PlannedScene& planned) const {
        if (turns_triangles(planned.effects.left_out) == is_turned_)
            return tree_;
        return std::make_shared<SceneTree>(build_scene_tree(planned.scene, options_, tree_->bvh.layout));
    }

    /// The scene is planned and uploaded for every run, so that only one of them is in memory at a time.
    Render run(const std::shared_ptr<const PlannedScene>& planned, const PreparedParts& parts,
               double* seconds) const {
        const PreparedScene prepared = prepare_render(device_, planned, parts);
        Progress silent(Toggle::OFF, true);
        const double start = processor_seconds();
        Render result = render(prepared, silent);
        if (seconds)
            *seconds = is_processor_time() ? processor_seconds() - start : result.seconds;
        if (stop_signal())
            throw UsageError("the ledger was stopped by a signal; it needs all its rounds");
        return result;
    }

    const Device& device_;
    const Scene& scene_;
    Options options_;        ///< of the picture as asked for, --time and --spp included
    bool is_turned_ = false; ///< its triangles
    std::shared_ptr<const SceneTree> tree_;
};

/// The picture as asked for, the full program, and the picture without each effect that it shows.
std::vector<Variant> make_variants(const Scene& scene, Options options) {
    options.output.files.clear();
    options.sampling.time_seconds.reset();
    const Effects effects = find_effects(scene, options);
    Variant as_asked;
    as_asked.options = options;
    std::vector<Variant> variants(2, as_asked);
    variants[1].options.effects.list.reset();
    variants[1].options.effects.all = true;
    variants[1].options.effects.off = effects.left_out;
    for (const Effect& effect : effects.list) {
        if (!effect.present || (effects.left_out & effect.bit))
            continue;
        variants.push_back(as_asked);
        variants.back().effect = effect.name;
        variants.back().options.effects.off |= effect.bit;
    }
    return variants;
}

/// f(a, b) of every round.
template <typename F>
LedgerValue compare(const std::vector<double>& a, const std::vector<double>& b, const F& f) {
    std::vector<double> values;
    for (size_t i = 0; i < a.size(); ++i)
        values.push_back(f(a[i], b[i]));
    return ledger_value(std::move(values));
}

double difference(double with, double without) {
    return with - without;
}

double share(double with, double without) {
    return with > 0 ? 1 - without / with : 0;
}

LedgerRow make_row(const Variant& picture, const Variant& without) {
    LedgerRow row;
    row.effect = without.effect;
    row.without = {without.compile_seconds, ledger_value(without.seconds)};
    row.seconds = compare(picture.seconds, without.seconds, difference);
    row.time_share = compare(picture.seconds, without.seconds, share);
    row.light_share = compare(picture.light, without.light, share);
    return row;
}

void set_break_even(const Variant& specialised, const Variant& full, double threads, Ledger& ledger) {
    if (specialised.mask == full.mask)
        return; // the same program: what differs is noise
    const LedgerValue extra = compare(full.seconds, specialised.seconds, difference);
    const auto samples = [&](double gain) {
        return gain > 0 ? std::optional<double>(specialised.compile_seconds * threads / gain) : std::nullopt;
    };
    ledger.break_even = samples(extra.median);
    ledger.break_even_low = samples(extra.high);
    ledger.break_even_high = samples(extra.low);
}

} // namespace

LedgerValue ledger_value(std::vector<double> values) {
    assert(values.size() == size_t(LEDGER_ROUNDS));
    std::sort(values.begin(), values.end());
    return {values[LEDGER_ROUNDS / 2], values[1], values[LEDGER_ROUNDS - 2]};
}

namespace {

/// Says what is to come before it takes its time.
void announce(const LedgerPlan& plan, const Options& options, size_t variants, double now,
              Progress& progress) {
    const double needed = plan.needed(variants, now);
    const size_t fitting = plan.fitting(variants, now);
    progress.finish();
    if (fitting == variants)
        spdlog::info("the ledger of {} effects takes {:.0f} s or more", variants - 2, needed);
    else
        spdlog::warn("the ledger of {} effects takes {:.0f} s or more, compiling included: about {} of them "
                     "fit --time "
                     "{:g}",
                     variants - 2, needed, fitting - 2, *options.sampling.time_seconds);
}

/// Compiles the variants that fit the time and gives back the effects of the others. The first program is
/// compiled twice: what the compiler does once is no program's.
std::vector<std::string> compile_fitting(const Bench& bench, const Options& options, Clock::time_point start,
                                         std::vector<Variant>& variants, LedgerPlan& plan,
                                         Progress& progress) {
    bench.compile(variants[0]);
    size_t done = 0;
    for (; done < variants.size(); ++done) {
        if (done == 2)
            announce(plan, options, variants.size(), seconds_since(start), progress);
        if (done >= 2 && plan.fitting(variants.size(), seconds_since(start)) <= done)
            break;
        progress.update({"compile", double(done) / double(variants.size()), 0, -1});
        plan.add(bench.compile(variants[done]));
    }
    std::vector<std::string> left;
    for (size_t i = done; i < variants.size(); ++i)
        left.push_back(variants[i].effect);
    variants.resize(done);
    return left;
}

/// Renders all variants in turn, round by round; gives back the fewest samples of a round.
std::uint32_t take_turns(const Bench& bench, Clock::time_point start, std::vector<Variant>& variants,
                         LedgerPlan& plan, Progress& progress) {
    std::uint32_t fewest = UINT32_MAX;
    for (int round = 0; round < LEDGER_ROUNDS; ++round) {
        fewest = std::min(fewest, plan.samples(variants.size(), LEDGER_ROUNDS - round, seconds_since(start)));
        for (size_t i = 0; i < variants.size(); ++i) {
            const double done = double(size_t(round) * variants.size() + i);
            progress.update({"ledger", done / double(size_t(LEDGER_ROUNDS) * variants.size()), 0, -1});
            bench.measure(variants[(i + size_t(round)) % variants.size()], round, fewest);
        }
    }
    return fewest;
}

} // namespace

Ledger make_ledger(const Device& device, const Scene& scene, const Options& options, Progress& progress) {
    const auto start = Clock::now();
    const Bench bench(device, scene, options);
    std::vector<Variant> variants = make_variants(scene, options);
    LedgerPlan plan(options.sampling.time_seconds, options.sampling.spp);
    Ledger ledger;
    ledger.not_measured = compile_fitting(bench, options, start, variants, plan, progress);
    ledger.compile_seconds = seconds_since(start);
    ledger.samples = take_turns(bench, start, variants, plan, progress);
    ledger.seconds = seconds_since(start);

    // Draw up the bill.
    const Variant &picture = variants[0], &full = variants[1];
    ledger.width = options.film.crop ? options.film.crop->x1 - options.film.crop->x0 : options.film.size.x;
    ledger.height = options.film.crop ? options.film.crop->y1 - options.film.crop->y0 : options.film.size.y;
    ledger.is_processor_time = bench.is_processor_time();
    ledger.bvh_quality = bench.tree().bvh.quality;
    ledger.bvh_reason = bench.tree().reason;
    ledger.specialised = {picture.compile_seconds, ledger_value(picture.seconds)};
    ledger.full = {full.compile_seconds, ledger_value(full.seconds)};
    ledger.full_extra_share =
        compare(full.seconds, picture.seconds, [](double all, double needed) { return all / needed - 1; });
    set_break_even(picture, full, bench.threads(), ledger);
    for (size_t i = 2; i < variants.size(); ++i)
        ledger.rows.push_back(make_row(picture, variants[i]));
    return ledger;
}

} // namespace clrt
