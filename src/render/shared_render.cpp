// SPDX-License-Identifier: Apache-2.0
#include "render/shared_render.h"

#include "console/signals.h"
#include "error.h"
#include "film/film_capacity.h"
#include "film/sample_ranges.h"
#include "options/summed_layers.h"
#include "render/begin_film.h"
#include "render/beside.h"
#include "render/crew.h"
#include "render/denoised_target.h"
#include "render/film_worker.h"
#include "render/good_counts.h"
#include "render/hit_layers.h"
#include "render/outlook.h"
#include "render/pace.h"
#include "seconds.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <future>
#include <memory>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;
using Prepared = std::vector<const PreparedScene*>;
using Workers = std::vector<std::shared_ptr<FilmWorker>>;

/// One worker a device; their drivers compile side by side.
Workers make_workers(const Prepared& prepared, const RenderParams& params, RenderProgress& shared) {
    std::vector<std::future<std::shared_ptr<FilmWorker>>> begun;
    for (const PreparedScene* scene : prepared)
        begun.push_back(std::async(std::launch::async, [&params, &shared, scene] {
            return std::make_shared<FilmWorker>(*scene, params, shared);
        }));
    Workers workers;
    for (auto& worker : begun)
        workers.push_back(worker.get());
    return workers;
}

/// "32 to 47, 64 to 71"
std::string text_of(const std::vector<SampleRange>& ranges) {
    std::string text;
    for (const SampleRange& range : ranges)
        text += fmt::format("{}{} to {}", text.empty() ? "" : ", ", range.first, range.end - 1);
    return text;
}

/// Several devices at one render. Refers to the arguments of its constructor.
class SharedRender {
public:
    SharedRender(const Prepared& prepared, const RenderParams& params, Progress& progress,
                 const RenderHooks& hooks, Render& result);
    void run();

private:
    CrewHooks crew_hooks();
    StopRule run_until_stopped();
    RenderState measured_state();
    void render_to(std::uint64_t samples);
    bool watch(double samples);
    void say_failed(size_t member, const std::vector<SampleRange>& lost);
    void note_work();
    void advance_hits();
    std::string name(size_t member) const;
    double seconds() const { return seconds_since(start_); }
    double seconds_left() const;
    bool has_gaps() const;
    bool is_left(size_t member) const { return crew_->shares()[member].failure.empty(); }

    const Options& options_;
    const RenderParams params_;
    Progress& progress_;
    Render& result_;
    const RenderCounts earlier_counts_;
    const double earlier_seconds_;
    const std::uint64_t first_samples_, earlier_samples_; ///< of earlier runs, a pixel and of all pixels
    Workers workers_;
    const std::shared_ptr<Crew> crew_;
    StopRules rules_;
    Measurements measurements_;
    Beside beside_;
    std::optional<DenoisedTarget> denoised_target_;
    std::optional<HitLayers> hit_layers_;
    size_t hit_worker_ = 0;                   ///< whose device makes the layers of hits
    double hit_seconds_ = 0;                  ///< of making them
    std::atomic<double> reserved_seconds_{0}; ///< for those of the samples so far
    Clock::time_point start_ = Clock::now();
};

SharedRender::SharedRender(const Prepared& prepared, const RenderParams& params, Progress& progress,
                           const RenderHooks& hooks, Render& result)
    : options_(prepared[0]->planned->options), params_(params), progress_(progress), result_(result),
      earlier_counts_(result.counts), earlier_seconds_(result.seconds),
      first_samples_(film_samples(result.film)), earlier_samples_(film_all_samples(result.film)),
      workers_(make_workers(prepared, params, result)),
      crew_(std::make_shared<Crew>(std::vector<std::shared_ptr<CrewMember>>(workers_.begin(), workers_.end()),
                                   crew_hooks(), first_samples_ > 0)),
      rules_(options_.sampling, film_limit(result.film, options_)), beside_(options_, hooks) {
    if (options_.sampling.denoised_error)
        denoised_target_.emplace(options_);
    // What is read from devices is added up here.
    Film& film = result_.film;
    film.sums.resize(size_t(film.replicates) * film_plane(film));
    result_.path_layers.resize(summed_layers(options_).size(), film_layer(film));
    for (Film& layer : result_.path_layers)
        layer.sums.resize(film_plane(film));
}

CrewHooks SharedRender::crew_hooks() {
    return {
        [this] { return seconds_left(); },
        [this](double seconds) { return seconds_left() < 0 || (stop_signal() && seconds > LONGEST_WAIT); },
        [this](double samples) { return watch(samples); },
        [this](size_t member, const std::vector<SampleRange>& lost) { say_failed(member, lost); }};
}

double SharedRender::seconds_left() const {
    return options_.sampling.time_seconds ? *options_.sampling.time_seconds - seconds() - reserved_seconds_
                                          : HUGE_VAL;
}

/// Whether samples are missing between those of the film.
bool SharedRender::has_gaps() const {
    return result_.film.ranges.size() > 1;
}

std::string SharedRender::name(size_t member) const {
    const DeviceInfo& info = workers_[member]->prepared().device.info;
    return fmt::format("device {}:{} ({})", info.platform_index, info.device_index, info.name);
}

void SharedRender::say_failed(size_t member, const std::vector<SampleRange>& lost) {
    progress_.finish();
    spdlog::warn("{} has failed and is left out{}: {}", name(member),
                 lost.empty() ? "" : fmt::format("; the others render its samples {} again", text_of(lost)),
                 crew_->shares()[member].failure);
    // Who looks on asks a device as well.
    for (size_t i = 0; i < workers_.size(); ++i)
        if (is_left(i))
            return beside_.begin(workers_[i]->prepared());
}

/// Shows so many samples a pixel of the present work; true: the work is to end for a signal, a file or
/// whoever looks on.
bool SharedRender::watch(double samples) {
    const double all = double(film_samples(result_.film)) + samples, of_run = all - double(first_samples_);
    progress_.update({"render", rules_.fraction(all, seconds(), expected_samples(measurements_)),
                      std::uint64_t(all), measurements_.rays_per_second(result_.film, of_run, seconds()),
                      measurements_.error_at(all), false,
                      progress_target(measurements_, options_.sampling, all, of_run, seconds())});
    if (result_.hits.samples > 0)
        reserved_seconds_ =
            hit_seconds_ / double(result_.hits.samples) * std::max(all - double(result_.hits.samples), 0.0);
    beside_.between_launches();
    return stop_signal() || beside_.waits();
}

/// Where the render stands, with the error where it is time to measure it.
RenderState SharedRender::measured_state() {
    const std::uint64_t samples = film_samples(result_.film);
    if (samples > 0 && (rules_.is_check(samples, measurements_.error()) || result_.passes == 0)) {
        measurements_.judge_film(result_.counts, earlier_samples_, result_);
        note_error(measurements_, result_, options_.sampling, samples, seconds());
    }
    RenderState state;
    state.samples = samples;
    state.seconds = seconds();
    state.pass_seconds = crew_->fastest_pass();
    state.signal = stop_signal();
    if (const std::optional<SquaredError>& error = measurements_.error(); error && error->samples == samples)
        state.error = relative_error(*error);
    const bool is_resumed = samples > 0 && result_.passes == 0;
    if (denoised_target_ && hit_layers_ &&
        (is_resumed ||
         denoised_target_->is_due(result_.film, state.error, [&] { return result_.counts.rays(); }))) {
        denoised_target_->look(workers_[hit_worker_]->prepared().device, progress_, result_);
        state.is_denoised_enough = denoised_target_->reached(result_);
    }
    return state;
}

/// Takes the film to so many samples a pixel, or as far as time, signals and files let it.
void SharedRender::render_to(std::uint64_t samples) {
    Film& film = result_.film;
    const std::vector<SampleRange> work =
        next_ranges(film.ranges, options_.sampling.first_sample, samples - film_samples(film));
    for (const SampleRange& range : crew_->run(work))
        add_range(film.ranges, range);
    for (Film& layer : result_.path_layers)
        layer.ranges = film.ranges;
    note_work();
}

/// Brings counts and seconds of the result to those of the film.
void SharedRender::note_work() {
    result_.passes = film_samples(result_.film) - first_samples_;
    result_.counts = {};
    result_.device_seconds = 0;
    for (size_t i = 0; i < workers_.size(); ++i) {
        result_.counts.add(workers_[i]->counts());
        result_.shares[i].work = crew_->shares()[i];
        result_.device_seconds += crew_->shares()[i].seconds;
        if (is_left(i)) // else it may be at one
            result_.longest_launch_seconds =
                std::max(result_.longest_launch_seconds, workers_[i]->longest_launch_seconds());
    }
    result_.counts.primary = film_all_samples(result_.film) - earlier_samples_;
    result_.counts.add(earlier_counts_);
    result_.run_seconds = seconds();
    result_.seconds = earlier_seconds_ + result_.run_seconds;
}

/// Brings the layers of hits to the film's samples, by the first device that is left: anew where the one
/// before has failed. They go through the film from its start: gaps must have been filled before.
void SharedRender::advance_hits() {
    const auto start = Clock::now();
    while (hit_worker_ < workers_.size()) {
        FilmWorker& worker = *workers_[hit_worker_];
        if (!worker.prepared().programs->layers)
            return;
        try {
            if (is_left(hit_worker_)) {
                if (!hit_layers_)
                    hit_layers_.emplace(worker.prepared(), params_, worker.buffers(), result_.hits);
                hit_layers_->advance(result_.film, [](double) {});
                result_.hits_error.clear();
                hit_seconds_ += seconds_since(start);
                return;
            }
        } catch (const DeviceError& error) {
            result_.hits_error = error.what();
        }
        hit_layers_.reset();
        result_.hits = {};
        ++hit_worker_;
    }
}

StopRule SharedRender::run_until_stopped() {
    for (;;) {
        const RenderState state = measured_state();
        if (const std::optional<StopRule> rule = rules_.ended(state))
            return *rule;
        render_to(std::min(rules_.last_samples(), rules_.next_check(state.samples)));
        if (!has_gaps())
            advance_hits();
        const bool is_going_on = beside_.waits() || film_samples(result_.film) > state.samples;
        beside_.at_pass(result_, [] {});
        if (crew_->has_dropped() || !is_going_on)
            return stop_signal() ? StopRule::SIGNAL : StopRule::TIME;
    }
}

void SharedRender::run() {
    beside_.begin(workers_.front()->prepared());
    start_ = Clock::now();
    if (denoised_target_ && first_samples_ > 0 && !has_gaps())
        advance_hits(); // of the film that the render goes on from
    result_.stop = run_until_stopped();
    const double stop_seconds = seconds();
    const std::uint64_t samples = film_samples(result_.film);
    result_.stop_signal = result_.stop == StopRule::SIGNAL ? stop_signal() : 0;
    if (options_.sampling.time_seconds)
        result_.overrun_seconds = std::max(0.0, stop_seconds - *options_.sampling.time_seconds);
    advance_hits();
    note_work();
    result_.error = film_error(result_.film, ErrorPixels::SCENE, options_.sampling.measure());
    result_.stop_text = rules_.describe(
        result_.stop, {samples, stop_seconds, crew_->fastest_pass(), result_.passes <= workers_.size(), 0});
    if (has_gaps()) {
        progress_.finish();
        spdlog::warn("samples are missing between those of the film; --resume renders them");
    }
}

} // namespace

Render render_shared(const std::vector<const PreparedScene*>& prepared, Progress& progress,
                     const RenderHooks& hooks) {
    std::vector<const Device*> devices;
    for (const PreparedScene* scene : prepared)
        devices.push_back(&scene->device);
    Render result;
    const RenderParams params = begin_film(*prepared[0]->planned, devices, hooks.resume, result);
    for (const PreparedScene* scene : prepared)
        result.shares.push_back({scene->device.info, {}});
    progress.update({"compile", -1, 0, -1, -1});
    const auto start = Clock::now();
    SharedRender shared(prepared, params, progress, hooks, result);
    result.first_launch_seconds = seconds_since(start);
    shared.run();
    return result;
}

} // namespace clrt
