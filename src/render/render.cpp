// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include "app/signals.h"
#include "device/opencl_error.h"
#include "error.h"
#include "render/film_buffers.h"
#include "render/film_capacity.h"
#include "render/hit_layers.h"
#include "render/launch_size.h"
#include "render/launcher.h"
#include "render/reminder.h"
#include "render/render_params.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

/// A signal does not wait longer for a pass to end, seconds: it is dropped.
constexpr double LONGEST_WAIT = 3;
/// Launches take multiples of this many samples where they can: kernels simulate up to four at once.
constexpr double SAMPLE_GROUP = 4;
/// Without --error, measuring errors may take this part of the render; the slope is worth no more.
constexpr double LARGEST_CHECK_SHARE = 0.05;
/// So much is always worth it, seconds.
constexpr double SMALL_CHECK_SECONDS = 0.2;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The passes of one render.
class Passes {
public:
    Passes(const Device& device, const RenderPrograms& programs, const SceneBuffers& buffers,
           const Options& options, const RenderParams& params, Progress& progress, const RenderHooks& hooks,
           Render& result);

    /// Runs passes until a rule ends them, then reads everything back.
    void run();

private:
    StopRule run_until_stopped();
    bool run_launches(std::uint32_t samples);
    std::uint32_t next_samples(const RenderState& state) const;
    template <class Launch>
    bool run_tiles(double samples, double done, Launch&& launch);
    void keep_film(double seconds);
    bool gives_up(double seconds_left) const;
    void begin_round();
    bool run_adaptive(std::uint64_t end);
    RenderState measured_state();
    /// The error after so many samples, from the last one measured as for independent samples; -1: none was
    /// measured.
    double error_now(double samples) const;
    /// Rays a second of this run after so many samples, if a sample takes as many as at the last measurement;
    /// -1: none was made.
    double rays_per_second_now(double samples) const;
    void measure();
    void read_back();
    void take_host_memory();
    void begin_hits();
    void advance_hits(const char* phase = nullptr);
    void give_up_hits(const DeviceError& error);
    void save_when_due();

    const Device& device_;
    const RenderPrograms& programs_;
    const SceneBuffers& scene_buffers_;
    const Options& options_;
    const RenderParams params_;
    Progress& progress_;
    const RenderHooks& hooks_;
    Render& result_;
    FilmBuffers film_buffers_;
    Launcher launcher_;
    std::optional<HitLayers> hit_layers_;
    StopRules rules_;
    Reminder picture_reminder_, film_reminder_;
    Clock::time_point start_;
    RenderCounts earlier_counts_;
    double earlier_seconds_ = 0;
    std::uint64_t first_ = 0, samples_ = 0;  ///< the next sample's number; samples of the whole film
    std::uint64_t earlier_samples_ = 0;      ///< of all pixels, from earlier runs
    std::optional<SquaredError> last_error_; ///< as last measured
    double rays_per_sample_ = -1;            ///< as last measured
    double launch_seconds_ = 0;              ///< of all launches of this run
    LaunchSize launch_size_;
    bool is_kept_ = false; ///< the result holds the film as of samples_
    bool gave_up_ = false; ///< a signal ended a pass
};

Passes::Passes(const Device& device, const RenderPrograms& programs, const SceneBuffers& buffers,
               const Options& options, const RenderParams& params, Progress& progress,
               const RenderHooks& hooks, Render& result)
    : device_(device), programs_(programs), scene_buffers_(buffers), options_(options), params_(params),
      progress_(progress), hooks_(hooks), result_(result),
      film_buffers_(device, params, programs.paths.layers.size()),
      launcher_(device, programs.picture, std::string("render_") + integrator_name(options.integrator),
                params, buffers),
      rules_(options, film_limit(result.film, options)), picture_reminder_(options.save_every_seconds),
      film_reminder_(options.checkpoint_path.empty() ? std::nullopt
                                                     : std::optional(options.checkpoint_seconds)),
      launch_size_(device.info.compute_units) {
    film_buffers_.bind(launcher_.kernel());
    take_host_memory();
    first_ = options.first_sample;
    if (!result.film.ranges.empty()) {
        film_buffers_.write_sums(result);
        first_ = result.film.ranges.back().end;
        samples_ = film_samples(result.film);
        earlier_samples_ = film_all_samples(result.film);
    }
    earlier_counts_ = result.counts;
    earlier_seconds_ = result.seconds;

    // A launch without samples makes the driver finish its compilation.
    const auto start = Clock::now();
    launcher_.run(0, 0, 0, 0);
    begin_hits();
    result.first_launch_seconds = seconds_since(start);
}

/// Takes what reading the film at the end needs, once the device is known to hold it.
void Passes::take_host_memory() {
    Film& film = result_.film;
    film.sums.resize(size_t(film.replicates) * film_plane(film));
    result_.path_layers.resize(programs_.paths.layers.size());
    for (Film& layer : result_.path_layers)
        layer.sums.resize(film_plane(film));
}

/// Takes the memory of the layers of hits. Without them the picture is rendered all the same.
void Passes::begin_hits() {
    if (!programs_.layers)
        return;
    try {
        hit_layers_.emplace(device_, *programs_.layers, params_, options_.adaptive, scene_buffers_,
                            film_buffers_, result_.hits);
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
    launch_seconds_ += seconds_since(start);
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
    if (options_.adaptive)
        end = std::min(end, result_.round.end);
    double samples = 1;
    if (result_.passes > 0) {
        const double pass = std::max(state.pass_seconds, 1e-6);
        const double fitting = LAUNCH_SECONDS / pass;
        samples = fitting <= 1 ? 1 : std::ceil(fitting / SAMPLE_GROUP) * SAMPLE_GROUP;
        // Grow slowly: the first passes may be unlike the later ones.
        samples = std::min(samples, 2.0 * double(result_.passes));
        if (options_.time_seconds)
            samples = std::min(samples, std::max(1.0, (*options_.time_seconds - state.seconds) / pass));
    }
    // Adaptive tiles advance by whole samples of every replicate.
    if (options_.adaptive)
        samples = std::ceil(samples / options_.replicates) * options_.replicates;
    return std::uint32_t(std::min(double(end - samples_), samples));
}

/// Before launches that take about so long: keeps the film in the result where a signal could not wait for
/// their end.
void Passes::keep_film(double seconds) {
    is_kept_ = result_.passes > 0 ? seconds > LONGEST_WAIT : samples_ > 0; // a resumed film is there already
    if (is_kept_ && result_.passes > 0)
        read_back();
}

/// Whether a signal ends a pass that would take so much longer: all samples before it are kept.
bool Passes::gives_up(double seconds_left) const {
    return stop_signal() && seconds_left > LONGEST_WAIT && (is_kept_ || samples_ == 0);
}

/// Calls launch(first tile, end of tiles) until all tiles have their `samples`, in several launches where
/// they take long; `done` samples a pixel are there already. False where it gives up.
template <class Launch>
bool Passes::run_tiles(double samples, double done, Launch&& launch) {
    const auto begun = Clock::now();
    for (u32 tile = 0; tile < params_.tile_count;) {
        const u32 end = tile + launch_size_.tiles(samples, params_.tile_count - tile);
        const auto start = Clock::now();
        launch(tile, end);
        const double seconds = seconds_since(start);
        launch_seconds_ += seconds;
        launch_size_.took(end - tile, samples, seconds);
        tile = end;
        const double now = done + samples * tile / params_.tile_count;
        progress_.update({"render", rules_.fraction(now, seconds_since(start_), last_error_),
                          std::uint64_t(now), rays_per_second_now(now), error_now(now)});
        if (gives_up(seconds_since(begun) * (params_.tile_count - tile) / tile))
            return false;
    }
    return true;
}

double Passes::error_now(double samples) const {
    const std::optional<FilmError> error = last_error_ ? relative_error(*last_error_) : std::nullopt;
    return error ? error->relative_rmse * std::sqrt(double(last_error_->samples) / samples) : -1;
}

double Passes::rays_per_second_now(double samples) const {
    if (rays_per_sample_ < 0)
        return -1;
    const double pixels = double(result_.film.width) * double(result_.film.height);
    const double earlier = double(samples_) - double(result_.passes); // of earlier runs
    return rays_per_sample_ * pixels * (samples - earlier) / seconds_since(start_);
}

/// Decides where the next samples of an adaptive render go, when it has come to the end of a round.
void Passes::begin_round() {
    AdaptiveRound& round = result_.round;
    if (round.end == 0) {
        round = first_round(result_.film);
    } else if (samples_ == round.end) {
        const auto start = Clock::now();
        film_buffers_.read_sums(result_);
        round = next_round(result_.film, round);
        result_.check_seconds += seconds_since(start);
    }
}

/// Takes the tiles of both halves to where they are when the mean is `end` samples a pixel.
bool Passes::run_adaptive(std::uint64_t end) {
    const int replicates = options_.replicates;
    const TileSamples from = samples_within(result_.round, samples_, replicates);
    const TileSamples to = samples_within(result_.round, end, replicates);
    const double samples = 0.5 * double(end - samples_);
    for (int half = 0; half < 2; ++half) {
        film_buffers_.write_tile_ranges(from[size_t(half)], to[size_t(half)]);
        if (!run_tiles(samples, double(samples_) + half * samples,
                       [&](u32 tile, u32 tiles_end) { launcher_.run_half(half, tile, tiles_end); }))
            return false;
    }
    result_.film.tile_samples = to;
    return true;
}

/// Runs whole passes; false where it gives them up.
bool Passes::run_launches(std::uint32_t samples) {
    const bool done = options_.adaptive ? run_adaptive(samples_ + samples)
                                        : run_tiles(samples, double(samples_), [&](u32 tile, u32 end) {
                                              launcher_.run(std::uint32_t(first_), samples, tile, end);
                                          });
    if (!done)
        return false;
    samples_ += samples;
    first_ += samples;
    result_.passes += samples;
    std::vector<SampleRange>& ranges = result_.film.ranges;
    if (ranges.empty())
        ranges.push_back({first_ - samples, first_});
    ranges.back().end = first_;
    return true;
}

/// Reads the film and measures its error, for the history where the samples have doubled.
void Passes::measure() {
    const auto start = Clock::now();
    film_buffers_.read_sums(result_);
    film_buffers_.read_shown(result_.film);
    last_error_ = film_squared_error(result_.film);
    // Beside the sums of all replicates, a few words a pixel are read in no time.
    const RenderCounts counts = film_buffers_.read_counts();
    const std::uint64_t samples = film_all_samples(result_.film) - earlier_samples_;
    if (samples > 0)
        rays_per_sample_ = 1 + double(counts.secondary + counts.shadow) / double(samples);
    const bool is_new = result_.history.empty() || result_.history.back().samples < samples_;
    if (last_error_ && is_new && rules_.is_check(samples_))
        result_.history.push_back(*last_error_);
    result_.check_seconds += seconds_since(start);
}

/// Where the render stands, with the error where it is time to measure it.
RenderState Passes::measured_state() {
    const double affordable = std::max(SMALL_CHECK_SECONDS, LARGEST_CHECK_SHARE * seconds_since(start_));
    const bool worth_it = options_.error || result_.check_seconds <= affordable;
    const bool resumed = samples_ > 0 && result_.passes == 0;
    if ((rules_.is_check(samples_) && worth_it) || (resumed && options_.error))
        measure();
    RenderState state;
    state.samples = samples_;
    state.seconds = seconds_since(start_);
    state.pass_seconds = result_.passes > 0 ? launch_seconds_ / double(result_.passes) : 0;
    state.signal = stop_signal();
    if (last_error_ && last_error_->samples == samples_)
        state.error = relative_error(*last_error_);
    return state;
}

void Passes::read_back() {
    film_buffers_.read_sums(result_);
    film_buffers_.read_shown(result_.film);
    result_.counts = film_buffers_.read_counts();
    result_.counts.primary = film_all_samples(result_.film) - earlier_samples_;
    result_.counts.add(earlier_counts_);
    result_.run_seconds = seconds_since(start_);
    result_.seconds = earlier_seconds_ + result_.run_seconds;
}

/// Saves film and picture so far when it is time to.
void Passes::save_when_due() {
    if (film_reminder_.due() && hooks_.save_film) {
        read_back();
        hooks_.save_film(result_);
    }
    if (picture_reminder_.due() && hooks_.save_picture) {
        read_back();
        result_.error = film_error(result_.film);
        hooks_.save_picture(result_);
    }
}

StopRule Passes::run_until_stopped() {
    for (;;) {
        const RenderState state = measured_state();
        if (const std::optional<StopRule> rule = rules_.ended(state))
            return *rule;
        if (options_.adaptive)
            begin_round();
        const std::uint32_t samples = next_samples(state);
        keep_film(state.pass_seconds * samples);
        if (!run_launches(samples)) {
            gave_up_ = true;
            return StopRule::SIGNAL;
        }
        advance_hits();
        save_when_due();
    }
}

void Passes::run() {
    start_ = Clock::now();
    if (samples_ > 0) {
        advance_hits("layers"); // of the film that the render goes on from
        launch_seconds_ = 0;    // no pass of this run
    }
    result_.stop = run_until_stopped();
    result_.stop_text = rules_.describe(result_.stop, samples_);
    result_.stop_signal = result_.stop == StopRule::SIGNAL ? stop_signal() : 0;
    if (!gave_up_)
        read_back();
    if (samples_ == 0)
        return;
    result_.error = film_error(result_.film);
    if (!result_.hits.empty() && !has_all_samples(result_.hits, result_.film)) {
        progress_.finish();
        spdlog::warn("the layers of hits lack samples of the film that the render went on from");
    }
}

} // namespace

void RenderCounts::add(const RenderCounts& other) {
    primary += other.primary;
    secondary += other.secondary;
    shadow += other.shadow;
    cut_paths += other.cut_paths;
    cut_weight += other.cut_weight;
    nan += other.nan;
    infinite += other.infinite;
    negative += other.negative;
    overflow += other.overflow;
    for (const auto& [pixel, count] : other.bad_pixels)
        bad_pixels[pixel] += count;
    bad_samples.insert(bad_samples.end(), other.bad_samples.begin(), other.bad_samples.end());
    std::sort(bad_samples.begin(), bad_samples.end(), [](const auto& a, const auto& b) {
        return std::pair(a.second, a.first) < std::pair(b.second, b.first);
    });
    bad_samples.resize(std::min<size_t>(bad_samples.size(), REPLAY_CAPACITY));
}

Render render(const Device& device, const RenderPrograms& programs, const SceneBuffers& buffers,
              const Scene& scene, const Options& options, Progress& progress, const RenderHooks& hooks) {
    Render result;
    if (hooks.resume)
        static_cast<RenderProgress&>(result) = *hooks.resume;
    Film& film = result.film;
    film.scale = film_scale(scene);
    RenderParams params = make_render_params(scene, options, film.scale);
    restrict_lights(programs.paths, params);
    film.width = int(params.crop_width);
    film.height = int(params.crop_height);
    const int fitting = fitting_replicates(device, params, programs.paths.layers.size());
    if (!hooks.resume) {
        film.replicates = fitting;
        film.shown.assign(film_plane(film) / 3, 0);
    } else
        fold_replicates(film, std::min(fitting, film.replicates));
    params.film_replicates = u32(film.replicates);
    check_film_capacity(options, film);
    if (options.adaptive && film.replicates != options.replicates)
        throw DeviceError(
            fmt::format("--adaptive compares {} replicates, but the film of only {} fits the device; take "
                        "a smaller --size or fewer --replicates",
                        options.replicates, film.replicates));

    progress.update({"compile", -1, 0, -1, -1});
    Passes passes(device, programs, buffers, options, params, progress, hooks, result);
    passes.run();
    return result;
}

Render render_nothing(const Scene& scene, const Options& options) {
    const Crop window = render_window(options);
    Render result;
    Film& film = result.film;
    film.scale = film_scale(scene);
    film.width = window.x1 - window.x0;
    film.height = window.y1 - window.y0;
    film.sums.resize(film_plane(film));
    result.path_layers.assign(options.path_layers.size(), film);
    result.stop_text = "no path of the scene is asked for";
    return result;
}

} // namespace clrt
