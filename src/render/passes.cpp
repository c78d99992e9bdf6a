// SPDX-License-Identifier: Apache-2.0
#include "render/passes.h"

#include "console/signals.h"
#include "device/opencl_error.h"
#include "film/film_capacity.h"
#include "film/sample_ranges.h"
#include "options/path_refusals.h"
#include "options/summed_layers.h"
#include "render/error_text.h"
#include "render/good_counts.h"
#include "render/light_outlines.h"
#include "render/outlook.h"
#include "render/pace.h"
#include "seconds.h"

#include <algorithm>
#include <cmath>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// Without --error, measuring errors may take this part of the render; the slope is worth no more.
constexpr double LARGEST_CHECK_SHARE = 0.05;
/// So much is always worth it, seconds.
constexpr double SMALL_CHECK_SECONDS = 0.2;

} // namespace

Passes::Passes(const PreparedScene& prepared, const RenderParams& params, Progress& progress,
               const RenderHooks& hooks, Render& result)
    : prepared_(prepared), options_(prepared.planned->options), params_(params), progress_(progress),
      result_(result), film_buffers_(prepared.device, params, summed_layers(options_).size()),
      launcher_(prepared.device, prepared.programs->picture, integrator_kernel(options_.transport.integrator),
                params, prepared.buffers),
      rules_(options_.sampling, film_limit(result.film, options_)), beside_(options_, hooks),
      launch_size_(prepared.device.info.compute_units) {
    film_buffers_.write_emission(find_light_outlines(prepared.planned->scene, params));
    film_buffers_.bind(launcher_.kernel());
    take_host_memory();
    if (!result.film.ranges.empty()) {
        film_buffers_.write_sums(result);
        samples_ = film_samples(result.film);
        earlier_samples_ = film_all_samples(result.film);
    }
    result.round.measure = options_.sampling.measure();
    go_to_next_sample();
    earlier_counts_ = result.counts;
    earlier_seconds_ = result.seconds;
    if (may_guide(options_)) {
        guiding_.emplace(prepared, params_, film_buffers_, result);
        launcher_.set_epoch(guiding_->epoch());
    }

    if (options_.sampling.denoised_error)
        denoised_target_.emplace(options_);
    if (walks_chains(options_.transport.integrator))
        metropolis_.emplace(prepared, params_, film_buffers_, result_);

    // A launch without samples makes the driver finish its compilation.
    const auto start = Clock::now();
    launcher_.run(0, 0, 0, 0);
    first_device_seconds_ = launcher_.device_seconds();
    begin_hits();
    result.first_launch_seconds = seconds_between(start, Clock::now());
}

/// Whether samples are missing between those of the film. The layers of hits go through them in order, and
/// wait until they are there.
bool Passes::has_gaps() const {
    return result_.film.ranges.size() > 1;
}

/// The next sample that the film lacks: between its ranges, else behind them.
void Passes::go_to_next_sample() {
    const SampleRange lacking =
        next_ranges(result_.film.ranges, options_.sampling.first_sample, rules_.last_samples()).front();
    first_ = lacking.first;
    lacking_end_ = lacking.end;
}

/// Takes what reading the film at the end needs, once the device is known to hold it.
void Passes::take_host_memory() {
    Film& film = result_.film;
    film.sums.resize(size_t(film.replicates) * film_plane(film));
    result_.path_layers.resize(summed_layers(options_).size());
    for (Film& layer : result_.path_layers)
        layer.sums.resize(film_plane(film));
}

/// Takes the memory of the layers of hits. Without them the picture is rendered all the same.
void Passes::begin_hits() {
    if (!prepared_.programs->layers)
        return;
    try {
        hit_layers_.emplace(prepared_, params_, film_buffers_, result_.hits);
    } catch (const DeviceError& error) {
        give_up_hits(error);
    }
}

/// Brings the layers of hits to the film's samples; what takes longer than a launch shows as `phase`.
void Passes::advance_hits(const char* phase) {
    if (!hit_layers_)
        return;
    const auto start = Clock::now();
    try {
        hit_layers_->advance(result_.film, [&](double fraction) {
            if (phase)
                progress_.update({phase, fraction, 0, -1, -1});
        });
    } catch (const DeviceError& error) {
        give_up_hits(error);
    }
    const double seconds = seconds_between(start, Clock::now());
    hit_seconds_ += seconds;
    launch_seconds_ += seconds;
}

void Passes::give_up_hits(const DeviceError& error) {
    result_.hits_error = error.what();
    result_.hits = {};
    hit_layers_.reset();
    progress_.finish();
    spdlog::warn("the picture will be without the layers of hits: {}", error.what());
}

/// Samples of the next launch on all tiles: what fits the aimed time, up to the next measurement, decision or
/// the end.
std::uint32_t Passes::next_samples(const RenderState& state) const {
    std::uint64_t end = std::min(rules_.last_samples(), rules_.next_check(samples_));
    end = std::min(end, samples_ + (lacking_end_ - first_));
    if (is_adaptive(options_))
        end = std::min(end, result_.round.end);
    if (guiding_)
        end = std::min(end, guiding_->end());
    if (metropolis_)
        end = std::min(end, std::max(metropolis_->end(), samples_ + 1));
    double samples = 1;
    if (result_.passes > 0) {
        const double pass = std::max(state.pass_seconds, 1e-6);
        const double fitting = LAUNCH_SECONDS / pass;
        samples = fitting <= 1 ? 1 : std::ceil(fitting / SAMPLE_GROUP) * SAMPLE_GROUP;
        // Grow slowly: the first passes may be unlike the later ones.
        samples = std::min(samples, 2.0 * double(result_.passes));
        if (options_.sampling.time_seconds)
            samples =
                std::min(samples, std::max(1.0, (*options_.sampling.time_seconds - state.seconds) / pass));
    }
    // Adaptive tiles advance by whole samples of every replicate.
    if (is_adaptive(options_))
        samples = std::ceil(samples / options_.sampling.replicates) * options_.sampling.replicates;
    return std::uint32_t(std::min(double(end - samples_), samples));
}

/// Before the next launches: keeps the film in the result where they may have to be dropped.
void Passes::keep_film(const RenderState& state, std::uint32_t samples) {
    if (result_.passes == 0) {
        is_kept_ = samples_ > 0; // a resumed film is there already
        return;
    }
    is_kept_ = may_be_interrupted(state, samples);
    if (is_kept_)
        read_back();
}

/// Whether so many passes may have to be dropped: a signal does not wait for them, or the time may be over
/// before they end. What is a single launch is never interrupted.
bool Passes::may_be_interrupted(const RenderState& state, std::uint32_t samples) const {
    const double seconds = state.pass_seconds * samples;
    const bool is_one_launch =
        !is_adaptive(options_) && launch_size_.tiles(samples, params_.tile_count) == params_.tile_count;
    const bool may_be_late = options_.sampling.time_seconds &&
                             state.seconds + LARGEST_SLOWDOWN * seconds > *options_.sampling.time_seconds;
    return seconds > LONGEST_WAIT || (may_be_late && !is_one_launch);
}

/// What ends launches here although they would take so much longer; none: they go on. All samples before them
/// are kept.
std::optional<StopRule> Passes::interruption(double seconds_left) const {
    if (stop_signal() && seconds_left > LONGEST_WAIT && (is_kept_ || samples_ == 0))
        return StopRule::SIGNAL;
    // A pass is not finished before the layers of hits have it too.
    const double hit_seconds = result_.passes > 0 ? hit_seconds_ / double(result_.passes) : 0;
    if (is_kept_ && options_.sampling.time_seconds &&
        seconds() + hit_seconds > *options_.sampling.time_seconds)
        return StopRule::TIME;
    return std::nullopt;
}

/// Calls launch(first tile, end of tiles) until all tiles have their `samples`, in several launches where
/// they take long; `done` samples a pixel are there already. False where it is interrupted.
template <class Launch>
bool Passes::run_tiles(double samples, double done, Launch&& launch) {
    const auto begun = Clock::now();
    for (u32 tile = 0; tile < params_.tile_count;) {
        const u32 end = tile + launch_size_.tiles(samples, params_.tile_count - tile);
        const auto start = Clock::now();
        launch(tile, end);
        const auto now = Clock::now();
        const double seconds = seconds_between(start, now);
        launch_seconds_ += seconds;
        result_.longest_launch_seconds = std::max(result_.longest_launch_seconds, seconds);
        launch_size_.took(end - tile, samples, seconds);
        tile = end;
        show(done + samples * tile / params_.tile_count);
        start_ += beside_.between_launches(); // its time is not the render's
        if (tile < params_.tile_count)
            interrupted_ = interruption(seconds_between(begun, now) * (params_.tile_count - tile) / tile);
        if (interrupted_)
            return false;
    }
    return true;
}

/// Shows that so many samples a pixel are done.
void Passes::show(double samples) {
    const double of_run = samples_of_run(samples);
    measurements_.measure_rays(film_buffers_, result_.film, of_run, seconds());
    progress_.update({"render", rules_.fraction(samples, seconds(), expected_samples(measurements_)),
                      std::uint64_t(samples), measurements_.rays_per_second(result_.film, of_run, seconds()),
                      measurements_.error_at(samples), false,
                      progress_target(measurements_, options_.sampling, samples, of_run, seconds())});
}

/// Shows what the render has come to.
void Passes::show_end() {
    const double rays = double(result_.counts.rays() - earlier_counts_.rays());
    const double seconds = result_.run_seconds - result_.dropped_seconds;
    ProgressState state{"render",
                        1,
                        samples_,
                        seconds > 0 ? rays / seconds : -1,
                        result_.error ? result_.error->relative_rmse : -1,
                        true};
    if (result_.stop == StopRule::SIGNAL)
        state.fraction = rules_.fraction(double(samples_), seconds, expected_samples(measurements_));
    progress_.update(state);
}

/// Decides where the next samples of an adaptive render go, when it has come to the end of a round.
void Passes::begin_round() {
    AdaptiveRound& round = result_.round;
    if (round.end == 0) {
        round = first_round(result_.film, *options_.sampling.adaptive);
    } else if (samples_ == round.end) {
        const auto start = Clock::now();
        film_buffers_.read_sums(result_);
        const bool is_first = expected_gain(round) == 0;
        round = next_round(result_.film, round);
        result_.check_seconds += seconds_between(start, Clock::now());
        if (is_first) {
            progress_.finish();
            spdlog::info("adaptive sampling: {}", gain_text(round));
        }
    }
}

/// Decides at the end of an epoch whether the next one is guided, and by what.
void Passes::begin_epoch() {
    if (samples_ < guiding_->end())
        return;
    const auto start = Clock::now();
    guiding_->advance(samples_, counts());
    launcher_.set_epoch(guiding_->epoch());
    result_.check_seconds += seconds_between(start, Clock::now());
}

/// Brings the chains to the samples that pixels have.
void Passes::walk_chains(std::uint32_t samples) {
    const auto start = Clock::now();
    metropolis_->walk(first_, samples);
    const double seconds = seconds_between(start, Clock::now());
    launch_seconds_ += seconds;
    result_.longest_launch_seconds = std::max(result_.longest_launch_seconds, seconds);
}

/// Of the program that the next samples are taken by.
Launcher& Passes::launcher() {
    Launcher* const guided = guiding_ ? guiding_->launcher() : nullptr;
    return guided ? *guided : launcher_;
}

/// Of the whole film.
RenderCounts Passes::counts() const {
    RenderCounts counts = film_buffers_.read_counts();
    counts.primary = film_all_samples(result_.film) - earlier_samples_;
    counts.add(earlier_counts_);
    return counts;
}

/// Takes the tiles of both halves to where they are when the mean is `end` samples a pixel.
bool Passes::run_adaptive(std::uint64_t end) {
    const int replicates = options_.sampling.replicates;
    const TileSamples from = samples_within(result_.round, samples_, replicates);
    const TileSamples to = samples_within(result_.round, end, replicates);
    const double samples = 0.5 * double(end - samples_);
    const auto begun = Clock::now();
    for (int half = 0; half < 2; ++half) {
        if (half == 1)
            interrupted_ = interruption(seconds_between(begun, Clock::now())); // as long as the first half
        if (interrupted_)
            return false;
        film_buffers_.write_tile_ranges(from[size_t(half)], to[size_t(half)]);
        if (!run_tiles(samples, double(samples_) + half * samples,
                       [&](u32 tile, u32 tiles_end) { launcher_.run_half(half, tile, tiles_end); }))
            return false;
    }
    result_.film.tile_samples = to;
    return true;
}

/// Runs whole passes; false where they are interrupted.
bool Passes::run_launches(std::uint32_t samples) {
    const bool done = is_adaptive(options_)
                          ? run_adaptive(samples_ + samples)
                          : run_tiles(samples, double(samples_), [&](u32 tile, u32 end) {
                                launcher().run(std::uint32_t(first_), samples, tile, end);
                            });
    if (!done)
        return false;
    if (metropolis_)
        walk_chains(samples);
    samples_ += samples;
    result_.passes += samples;
    add_range(result_.film.ranges, {first_, first_ + samples});
    go_to_next_sample();
    return true;
}

/// Whether the error is measured now: where it may end the render, and where it tells how the error falls, if
/// that does not take long.
bool Passes::is_worth_measuring() const {
    if (options_.sampling.has_target()) {
        const bool is_resumed = samples_ > 0 && result_.passes == 0;
        return is_resumed || rules_.is_check(samples_, measurements_.error());
    }
    const double affordable = std::max(SMALL_CHECK_SECONDS, LARGEST_CHECK_SHARE * seconds());
    return is_doubling(samples_, options_.sampling.replicates) && result_.check_seconds <= affordable;
}

/// Denoises the picture so far for --denoised-error, where it is time to: at any number of samples of the
/// film that the render goes on from.
void Passes::look_at_denoised(RenderState& state) {
    const bool is_resumed = samples_ > 0 && result_.passes == 0;
    if (!is_resumed && !denoised_target_->is_due(result_.film, state.error, [&] { return counts().rays(); }))
        return;
    read_back();
    denoised_target_->look(prepared_.device, progress_, result_);
    state.is_denoised_enough = denoised_target_->reached(result_);
}

/// Where the render stands, with the error where it is time to measure it.
RenderState Passes::measured_state() {
    if (is_worth_measuring()) {
        measurements_.measure_film(film_buffers_, earlier_samples_, result_);
        note_error(measurements_, result_, options_.sampling, samples_, seconds());
    }
    RenderState state;
    state.samples = samples_;
    state.seconds = seconds();
    state.pass_seconds = result_.passes > 0 ? launch_seconds_ / double(result_.passes) : 0;
    state.signal = stop_signal();
    if (const std::optional<SquaredError>& error = measurements_.error(); error && error->samples == samples_)
        state.error = relative_error(*error);
    if (denoised_target_)
        look_at_denoised(state);
    return state;
}

double Passes::seconds() const {
    return seconds_between(start_, Clock::now());
}

/// Of so many samples a pixel, those of this run.
double Passes::samples_of_run(double samples) const {
    return samples - (double(samples_) - double(result_.passes));
}

void Passes::read_back() {
    film_buffers_.read_sums(result_);
    film_buffers_.read_shown(result_.film);
    result_.counts = counts();
    if (guiding_)
        guiding_->read_back();
    if (metropolis_)
        metropolis_->read_back();
    result_.run_seconds = seconds();
    result_.device_seconds = launcher_.device_seconds() - first_device_seconds_;
    if (guiding_)
        result_.device_seconds += guiding_->device_seconds();
    if (metropolis_)
        result_.device_seconds += metropolis_->device_seconds();
    result_.seconds = earlier_seconds_ + result_.run_seconds;
}

StopRule Passes::run_until_stopped() {
    for (;;) {
        const RenderState state = measured_state();
        if (const std::optional<StopRule> rule = rules_.ended(state))
            return *rule;
        if (is_adaptive(options_))
            begin_round();
        if (guiding_)
            begin_epoch();
        if (metropolis_)
            metropolis_->advance(samples_, first_);
        const std::uint32_t samples = next_samples(state);
        keep_film(state, samples);
        if (!run_launches(samples))
            return *interrupted_;
        if (!has_gaps())
            advance_hits();
        beside_.at_pass(result_, [&] { read_back(); });
    }
}

/// Takes leave of the device: the result is what it holds, or what was kept where a pass was interrupted.
void Passes::finish() {
    if (interrupted_) {
        result_.dropped_seconds = seconds() - result_.run_seconds;
        result_.run_seconds = seconds();
    } else {
        read_back();
    }
    result_.error = film_error(result_.film, ErrorPixels::SCENE, options_.sampling.measure());
}

void Passes::run() {
    beside_.begin(prepared_);
    start_ = Clock::now();
    if (samples_ > 0 && !has_gaps()) {
        advance_hits("layers");             // of the film that the render goes on from
        launch_seconds_ = hit_seconds_ = 0; // no pass of this run
    }
    result_.stop = run_until_stopped();
    const double stop_seconds = seconds();
    result_.stop_signal = result_.stop == StopRule::SIGNAL ? stop_signal() : 0;
    if (options_.sampling.time_seconds)
        result_.overrun_seconds = std::max(0.0, stop_seconds - *options_.sampling.time_seconds);
    if (has_gaps())
        advance_hits("layers");
    finish();
    const std::uint64_t fewest = is_adaptive(options_) ? std::uint64_t(options_.sampling.replicates) : 1;
    const bool is_first_pass = samples_ == fewest && result_.passes == fewest;
    result_.stop_text =
        rules_.describe(result_.stop, {samples_, stop_seconds,
                                       launch_seconds_ / double(std::max<std::uint64_t>(result_.passes, 1)),
                                       is_first_pass, result_.dropped_seconds});
    if (samples_ == 0)
        return;
    show_end();
    if (!result_.hits.empty() && !has_all_samples(result_.hits, result_.film)) {
        progress_.finish();
        spdlog::warn("the layers of hits lack samples of the film that the render went on from");
    }
}

} // namespace clrt
