// SPDX-License-Identifier: Apache-2.0
#include "render/ledger_bench.h"

#include "console/signals.h"
#include "effects/take_out.h"
#include "error.h"
#include "seconds.h"

#include <algorithm>
#include <chrono>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

double mean_luminance(const Film& film) {
    const std::vector<float> mean = film_mean(film);
    double sum = 0;
    for (size_t i = 0; i + 2 < mean.size(); i += 3)
        sum += 0.2126 * double(mean[i]) + 0.7152 * double(mean[i + 1]) + 0.0722 * double(mean[i + 2]);
    return mean.empty() ? 0 : 3 * sum / double(mean.size());
}

/// The picture without one of its effects.
void leave_out(EffectMask bit, LedgerVariant& variant) {
    variant.options.effects.off |= bit;
}

/// The picture by the picture's program with the code of one more effect.
void add_code(EffectMask bit, const Effects& effects, LedgerVariant& variant) {
    EffectOptions& chosen = variant.options.effects;
    chosen.all = false;
    chosen.list = effects.mask | (effects.needed & ~effects.left_out) | bit;
    chosen.off = effects.left_out;
}

/// Whether the picture's program has no code of an effect, but of all that the effect implies: only then the
/// code has a price of its own.
bool can_be_added(const Effect& effect, const Effects& effects) {
    const EffectMask bit = effect.bit & EFFECT_ALL;
    const EffectMask implied = with_implied(bit) & ~bit;
    return bit && !effect.present && !(effects.mask & bit) && (effects.mask & implied) == implied;
}

} // namespace

std::vector<LedgerVariant> ledger_variants(const Scene& scene, Options options) {
    options.output.files.clear();
    options.sampling.time_seconds.reset();
    const Effects effects = find_effects(scene, options);
    LedgerVariant as_asked;
    as_asked.options = options;
    std::vector<LedgerVariant> variants(2, as_asked);
    variants[1].options.effects.list.reset();
    variants[1].options.effects.all = true;
    variants[1].options.effects.off = effects.left_out;
    const bool of_absent = options.run.ledger == LedgerOf::ABSENT;
    for (const Effect& effect : effects.list) {
        const bool is_shown = effect.present && !(effects.left_out & effect.bit);
        if (of_absent ? !can_be_added(effect, effects) : !is_shown)
            continue;
        variants.push_back(as_asked);
        variants.back().effect = effect.name;
        if (of_absent)
            add_code(effect.bit, effects, variants.back());
        else
            leave_out(effect.bit, variants.back());
    }
    return variants;
}

LedgerBench::LedgerBench(const Device& device, const Scene& scene, const Options& options)
    : device_(device), scene_(scene) {
    const auto picture = plan_scene(scene, options);
    options_ = picture->options;
    is_turned_ = turns_triangles(picture->effects.left_out);
    tree_ = plan_tree(device.info, *picture);
}

LedgerClock LedgerBench::clock() const {
    return device_.info.type == "CPU" ? LedgerClock::PROCESSOR : LedgerClock::DEVICE;
}

double LedgerBench::threads() const {
    return clock() == LedgerClock::PROCESSOR ? double(std::max(device_.info.compute_units, 1u)) : 1;
}

VariantSeconds LedgerBench::compile(LedgerVariant& variant) const {
    const auto begun = Clock::now();
    variant.options.sampling.spp = 1;
    variant.planned = plan_scene(scene_, variant.options);
    variant.mask = variant.planned->effects.mask;
    variant.parts.tree = tree_of(*variant.planned);
    const double start = processor_seconds();
    variant.parts.programs = plan_programs(device_, *variant.planned);
    const double built = processor_seconds() - start;
    const auto rendered = Clock::now();
    const Render render = render_once(variant);
    const double launched = render.first_launch_seconds;
    variant.compile_seconds =
        (clock() == LedgerClock::PROCESSOR ? built : variant.parts.programs->seconds) + launched;
    const double run_seconds = seconds_since(rendered) - launched - render.run_seconds;
    return {seconds_since(begun) - run_seconds - render.run_seconds, run_seconds, render.run_seconds};
}

LedgerRun LedgerBench::run(LedgerVariant& variant, std::uint32_t number, std::uint32_t samples) const {
    variant.planned->options.sampling.seed = variant.options.sampling.seed + number;
    variant.planned->options.sampling.spp = samples;
    const Render render = render_once(variant);
    // A driver's clock may stand still.
    const double seconds = render.device_seconds > 0 ? render.device_seconds : render.run_seconds;
    return {seconds / double(samples), mean_luminance(render.film)};
}

/// The tree of the picture, or another by the same rule where triangles are turned round.
std::shared_ptr<const SceneTree> LedgerBench::tree_of(const PlannedScene& planned) const {
    if (turns_triangles(planned.effects.left_out) == is_turned_)
        return tree_;
    return std::make_shared<SceneTree>(build_scene_tree(planned.scene, options_, tree_->bvh.layout));
}

/// The scene is uploaded for every run, so that only one variant is in the device's memory at a time, and all
/// of them at the same place: where buffers lie changes the time by 0.2 %.
Render LedgerBench::render_once(const LedgerVariant& variant) const {
    const PreparedScene prepared = prepare_render(device_, variant.planned, variant.parts);
    Progress silent(Toggle::OFF, true);
    Render result = render(prepared, silent);
    if (const int number = stop_signal())
        throw StoppedError(number, "the ledger was stopped by a signal; it needs all its pairs");
    return result;
}

} // namespace clrt
