// SPDX-License-Identifier: Apache-2.0
#include "render/guiding.h"

#include "film/film_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace clrt {

namespace {

/// Samples of each replicate before it is known whether to guide, at least.
constexpr std::uint64_t PILOT_SAMPLES = 2;
/// What a guided ray costs beside one that is not: cells are looked up, and records written. Seven rooms on
/// two cores with AVX-512: 1.43 to 1.69, median 1.49.
constexpr double GUIDED_RAY_WORK = 1.5;
/// The same of bdpt, most of whose rays no guide is asked for. A pool seen from above: 1.08 to 1.17.
constexpr double GUIDED_BDPT_RAY_WORK = 1.15;
/// At the end of the first epochs whose guide has learnt enough, the squared error of its samples times their
/// work, over that of samples without a guide, may be so much: what unguided paths have taught is poor where
/// light is hard to find, and what guided ones teach is better. One that passes the last of these stays.
constexpr std::array<double, 2> LARGEST_COSTS = {1.1, 1};
/// Light paths of the first epoch that teach bdpt at most: bins are large then, and sums would overflow.
constexpr double MOST_FIRST_LIGHT_PATHS = 1 << 19;
/// What guide_error allows the error to be over that of most pixels.
constexpr double MOST_OVER_TRIMMED = 4;
/// Of the variance, at least so much is left by a guide, whatever its gain is said to be.
constexpr double SMALLEST_ERROR = 0.05;

double rays_per_sample(const RenderCounts& counts) {
    return double(counts.rays()) / double(std::max<std::uint64_t>(counts.primary, 1));
}

/// guide_error of a sample of a film.
double film_guide_error(const Film& film) {
    return guide_error(sample_error(film, ErrorMeasure::MSE), sample_error(film, ErrorMeasure::RELATIVE),
                       trimmed_sample_error(film));
}

/// Pixels that errors are stated over.
double error_pixels(const Film& film) {
    return has_backdrop(film) ? double(*film_shown_pixels(film)) : double(film_plane(film) / 3);
}

/// What squared sums of channels weigh, tile by tile, by the relative measure (film/error_measure.h).
std::vector<float> tile_weights(const Film& film) {
    const std::vector<float> picture = film_mean(film);
    const std::vector<std::uint32_t> pixels = tile_pixel_counts(film);
    std::vector<double> sums(pixels.size());
    for (size_t i = 0; i < picture.size(); ++i)
        sums[film_tile(film, i / 3)] += double(picture[i]);
    const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / double(film_plane(film) / 3);
    std::vector<float> weights(pixels.size());
    for (size_t tile = 0; mean > 0 && tile < weights.size(); ++tile)
        weights[tile] = float(relative_weight(sums[tile] / pixels[tile], mean) / (mean * mean));
    return weights;
}

} // namespace

double worthwhile_guide_error(const Options& options) {
    return options.transport.path_reuse == Toggle::ON ? WORTHWHILE_SHARED_GUIDE_ERROR
                                                      : WORTHWHILE_GUIDE_ERROR;
}

double guide_error(double mse, double relative, double trimmed) {
    return std::min(std::sqrt(mse * relative), MOST_OVER_TRIMMED * trimmed);
}

Guiding::Guiding(const PreparedScene& prepared, const RenderParams& params, const FilmBuffers& film,
                 Render& render)
    : prepared_(prepared), params_(params), film_(film), render_(render), progress_(render.guide) {
    if (film_samples(render.film) == 0)
        start();
    else if (progress_.stage == GuideStage::ON)
        switch_on();
}

/// The first epoch.
void Guiding::start() {
    const std::uint64_t replicates = std::uint64_t(prepared_.planned->options.sampling.replicates);
    progress_ = {};
    if (guides_hits_alone())
        for (double paths = double(replicates) * double(params_.light_path_count);
             paths > MOST_FIRST_LIGHT_PATHS; paths /= 2)
            progress_.teachers >>= 1;
    if (prepared_.planned->options.transport.guide == Toggle::ON) {
        progress_.stage = GuideStage::ON;
        progress_.end = replicates;
        switch_on();
    } else if (prepared_.guide) {
        progress_ = *prepared_.guide;
        if (progress_.stage == GuideStage::ON)
            switch_on();
    } else if (!guides_hits_alone()) {
        progress_.stage = GuideStage::PILOT;
        progress_.end = PILOT_SAMPLES * replicates;
    }
}

/// What bdpt guides paths to is met too seldom to tell by the film whether it is there.
bool Guiding::guides_hits_alone() const {
    return prepared_.planned->options.transport.integrator == Integrator::BDPT;
}

/// Compiles what guides, and takes its memory.
void Guiding::switch_on() {
    if (!progress_.guide)
        progress_.guide.emplace();
    program_ = build_guided_program(prepared_);
    launcher_.emplace(prepared_.device, *program_,
                      integrator_kernel(prepared_.planned->options.transport.integrator), params_,
                      prepared_.buffers);
    film_.bind(launcher_->kernel());
    buffers_.emplace(prepared_.device, film_tiles(render_.film));
    buffers_->bind(launcher_->kernel());
    buffers_->write(*progress_.guide, progress_.sums);
    start_gains();
    launcher_->set_epoch(progress_.epoch);
    launcher_->set_teachers(progress_.teachers);
}

/// Sums of gains start at zero on the device; they weigh nothing where nobody asks for them.
void Guiding::start_gains() {
    earlier_gain_ = progress_.gain;
    buffers_->write_weights(progress_.weights.empty() ? std::vector<float>(film_tiles(render_.film))
                                                      : progress_.weights);
}

std::uint64_t Guiding::end() const {
    return progress_.stage == GuideStage::OFF ? UINT64_MAX : progress_.end;
}

Launcher* Guiding::launcher() {
    return progress_.stage == GuideStage::ON ? &*launcher_ : nullptr;
}

void Guiding::end_pilot(std::uint64_t samples) {
    progress_.pilot_end = samples;
    progress_.pilot_error = film_guide_error(render_.film);
    progress_.stage = *progress_.pilot_error < worthwhile_guide_error(prepared_.planned->options)
                          ? GuideStage::OFF
                          : GuideStage::ON;
    if (progress_.stage == GuideStage::ON)
        switch_on();
}

/// Whether the guide is on trial in this epoch.
bool Guiding::is_trial() const {
    return progress_.stage == GuideStage::ON && progress_.pilot_error && progress_.guided_from &&
           progress_.judgements < LARGEST_COSTS.size();
}

/// Whether this epoch's guide tells what a guide is worth: it was learnt from enough rays, guided ones too.
bool Guiding::has_learnt_enough(std::uint64_t samples, const RenderCounts& counts) const {
    const double part = double(progress_.begin - progress_.pilot_end) / double(samples);
    const double rays = progress_.taught_rays + part * double(counts.rays());
    return progress_.begin > *progress_.guided_from &&
           (guides_hits_alone() || rays >= prepared_.planned->options.transport.guide_after_rays);
}

/// Squared error of the samples of a guided epoch over that of unguided ones, as their gains tell.
double Guiding::told_error(std::uint64_t samples) const {
    // The film's samples scatter by what unguided ones would less the mean gain of the guided ones, the first
    // of which after a pilot are not asked.
    const double pixels = error_pixels(render_.film), all = double(samples);
    const double guided_samples = all - double(*progress_.guided_from);
    const double gain = progress_.gain / (pixels * double(samples - progress_.begin));
    const double mean_gain = progress_.earlier_gain / (pixels * (all - double(progress_.asked_from)));
    const double plain =
        sample_error(render_.film, ErrorMeasure::RELATIVE) + mean_gain * guided_samples / all;
    return plain > 0 ? 1 - gain / plain : 1;
}

/// The same of paths that serve several pixels: their gains tell of a single path, so it is measured.
double Guiding::measured_error(std::uint64_t samples) const {
    const double begin = double(progress_.begin), all = double(samples);
    const double error =
        (all * film_guide_error(render_.film) - begin * progress_.begin_error) / (all - begin);
    return progress_.plain_error > 0 ? error / progress_.plain_error : 1;
}

/// Compares the samples of a guided epoch with those that there would be without the guide.
void Guiding::judge(std::uint64_t samples, const RenderCounts& counts) {
    progress_.earlier_gain += progress_.gain;
    if (!has_learnt_enough(samples, counts))
        return;
    const bool shares = prepared_.planned->options.transport.path_reuse == Toggle::ON;
    progress_.error = std::max(shares ? measured_error(samples) : told_error(samples), SMALLEST_ERROR);
    const double plain_samples = double(*progress_.guided_from), all = double(samples);
    const double guided_samples = all - plain_samples;
    const double guided_rays = all * rays_per_sample(counts) - plain_samples * progress_.plain_rays;
    progress_.work = (guides_hits_alone() ? GUIDED_BDPT_RAY_WORK : GUIDED_RAY_WORK) * guided_rays /
                     (guided_samples * progress_.plain_rays);
    if (*progress_.error * *progress_.work > LARGEST_COSTS[progress_.judgements++]) {
        progress_.stage = GuideStage::OFF;
        progress_.guided_to = samples;
        progress_.guide.reset();
        progress_.weights.clear();
    }
}

/// Ends a guided epoch, or one that taught only.
void Guiding::end_epoch(std::uint64_t samples, const RenderCounts& counts) {
    read_back();
    if (!progress_.guided_from) {
        progress_.plain_rays = rays_per_sample(counts);
        progress_.plain_error = film_guide_error(render_.film);
    }
    if (!progress_.weights.empty())
        judge(samples, counts);
    if (progress_.stage == GuideStage::OFF)
        return;
    progress_.guide->learn(progress_.sums);
    buffers_->write(*progress_.guide);
    if (!progress_.guided_from)
        progress_.guided_from = samples;
}

/// Where the epoch ends that begins here: it is as long as all before it that taught.
std::uint64_t Guiding::epoch_end(std::uint64_t samples) const {
    if (samples > progress_.pilot_end)
        return 2 * samples - progress_.pilot_end;
    const auto replicates = std::uint64_t(prepared_.planned->options.sampling.replicates);
    return samples + (progress_.pilot_end / replicates + 1) / 2 * replicates;
}

/// Of the next samples, those that leave records enough where each has as many as in the last epoch, which
/// was so long.
u32 Guiding::next_teachers(std::uint64_t length) const {
    const double taught = std::ldexp(double(progress_.teachers) + 1, -32);
    const double a_sample = Guide::records(progress_.sums) / (taught * double(length));
    const double expected = a_sample * double(progress_.end - progress_.begin);
    u32 teachers = NO_INDEX;
    for (double records = expected; records > Guide::most_records(); records *= 0.5)
        teachers >>= 1;
    return teachers;
}

/// Begins the next epoch.
void Guiding::begin_epoch(std::uint64_t samples) {
    const std::uint64_t length = samples - progress_.begin;
    progress_.epoch += 1;
    progress_.begin = samples;
    progress_.end = epoch_end(samples);
    progress_.gain = 0;
    progress_.begin_error = is_trial() ? film_guide_error(render_.film) : 0;
    progress_.weights = is_trial() ? tile_weights(render_.film) : std::vector<float>();
    if (is_trial() && progress_.asked_from == 0)
        progress_.asked_from = samples;
    launcher_->set_epoch(progress_.epoch);
    if (progress_.stage == GuideStage::ON) {
        start_gains();
        if (progress_.guided_from)
            progress_.teachers = next_teachers(length);
        launcher_->set_teachers(progress_.teachers);
    }
    progress_.sums.clear();
}

void Guiding::advance(std::uint64_t samples, const RenderCounts& counts) {
    if (samples < end())
        return;
    if (progress_.stage == GuideStage::PILOT &&
        double(counts.rays()) < prepared_.planned->options.transport.guide_after_rays) {
        progress_.end = 2 * samples;
        return;
    }
    film_.read_sums(render_);
    if (progress_.stage == GuideStage::PILOT) {
        end_pilot(samples);
        if (progress_.stage == GuideStage::OFF)
            return; // the picture is that of a render without a guide
    } else
        end_epoch(samples, counts);
    begin_epoch(samples);
}

void Guiding::read_back() {
    if (progress_.stage != GuideStage::ON)
        return;
    progress_.sums = buffers_->read_sums(progress_.guide->lore().size());
    progress_.gain = earlier_gain_ + buffers_->read_gain();
}

GuideProgress untaught_guide(int replicates, double error) {
    GuideProgress guide;
    guide.stage = GuideStage::ON;
    guide.end = std::uint64_t(replicates);
    guide.pilot_error = error;
    return guide;
}

GuideProgress taught_guide(const GuideProgress& pilot, int replicates, double rays) {
    GuideProgress guide = untaught_guide(replicates, *pilot.pilot_error);
    guide.stage = pilot.stage;
    guide.error = pilot.error;
    guide.work = pilot.work;
    if (guide.stage == GuideStage::OFF)
        return guide;
    guide.guided_from = 0;
    guide.judgements = pilot.judgements;
    guide.plain_error = pilot.plain_error;
    guide.plain_rays = pilot.plain_rays;
    guide.taught_rays = rays;
    guide.guide = pilot.guide;
    return guide;
}

std::string guide_text(const GuideProgress& guide, const Options& options) {
    const std::string worth =
        guide.error ? fmt::format("squared error of a sample {:.2f} times and work {:.2f} times that before",
                                  *guide.error, *guide.work)
                    : "";
    if (!guide.guided_from) {
        if (guide.stage != GuideStage::OFF || !guide.pilot_error)
            return "";
        return guide.error ? fmt::format("off: a pilot had {}", worth)
                           : fmt::format("off: light is found without it (squared error of a sample {:.2g}, "
                                         "tried from {:g})",
                                         *guide.pilot_error, worthwhile_guide_error(options));
    }
    std::string text = *guide.guided_from > 0 ? fmt::format("from {} spp", *guide.guided_from)
                                              : "from the first sample, after a pilot";
    if (guide.stage == GuideStage::OFF)
        text += fmt::format(" to {}", guide.guided_to);
    if (guide.error)
        text += ", " + worth;
    if (guide.guide)
        text += fmt::format("; {} cells, {:.0f} MB", guide.guide->lore().size(),
                            double(guide_device_bytes()) * 1e-6);
    return text;
}

} // namespace clrt
