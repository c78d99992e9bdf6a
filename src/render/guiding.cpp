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
/// Squared relative error of one sample from which on a guide is tried, the geometric mean of both measures.
/// Below it light is found without one (Cornell box: .5), and nothing is compiled. Rooms lit through windows
/// have 4 to 12, one behind a door ajar 80.
constexpr double WORTHWHILE_ERROR = 4;
/// The part of the pilot in which a guide is learnt, again in which it is tried the first time, and the
/// second.
constexpr std::uint64_t TRIAL_PART = 16;
/// What a guided ray costs beside one that is not: cells are looked up, and records written. Seven rooms on
/// two cores with AVX-512: 1.43 to 1.69, median 1.49.
constexpr double GUIDED_RAY_WORK = 1.5;
/// The epoch after the pilot only teaches. At the end of each of the next ones the squared error of their
/// samples times their work, over that of samples without a guide, may be so much: what unguided paths have
/// taught is poor where light is hard to find, and what guided ones teach is better. One that passes the last
/// of these stays.
constexpr u32 LEARNING_EPOCH = 1;
constexpr std::array<double, 3> LARGEST_COSTS = {1.5, 1.1, 1};
/// Of the variance, at least so much is left by a guide, whatever its gain is said to be.
constexpr double SMALLEST_ERROR = 0.05;

double rays_per_sample(const RenderCounts& counts) {
    return double(counts.rays()) / double(std::max<std::uint64_t>(counts.primary, 1));
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
    if (prepared_.planned->options.transport.guide == Toggle::ON) {
        progress_.stage = GuideStage::ON;
        progress_.end = replicates;
        switch_on();
    } else {
        progress_.stage = GuideStage::PILOT;
        progress_.end = PILOT_SAMPLES * replicates;
    }
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
    const Film& film = render_.film;
    progress_.pilot_error =
        std::sqrt(sample_error(film, ErrorMeasure::MSE) * sample_error(film, ErrorMeasure::RELATIVE));
    progress_.stage = *progress_.pilot_error < WORTHWHILE_ERROR ? GuideStage::OFF : GuideStage::ON;
    if (progress_.stage == GuideStage::ON)
        switch_on();
}

/// Whether the guide is on trial in this epoch.
bool Guiding::is_trial() const {
    return progress_.stage == GuideStage::ON && progress_.pilot_error && progress_.epoch > LEARNING_EPOCH &&
           progress_.epoch <= LEARNING_EPOCH + LARGEST_COSTS.size();
}

/// Compares the samples of a guided epoch with those that there would be without the guide.
void Guiding::judge(std::uint64_t samples, double rays) {
    // The film's samples scatter by what unguided ones would less the mean gain.
    const double in_epoch = double(samples - progress_.begin), all = double(samples);
    const double pixels = error_pixels(render_.film);
    const double gain = progress_.gain / (pixels * in_epoch);
    progress_.earlier_gain += progress_.gain;
    const double plain =
        sample_error(render_.film, ErrorMeasure::RELATIVE) + progress_.earlier_gain / (pixels * all);
    progress_.error = plain > 0 ? std::max(1 - gain / plain, SMALLEST_ERROR) : 1;
    // Of n times as many samples as there are plain ones, (1 + (n - 1) x) / n is the factor of the rays a
    // sample, x being that of guided samples.
    const double n = all / double(progress_.guided_from);
    progress_.work = GUIDED_RAY_WORK * (n * rays / progress_.plain_rays - 1) / (n - 1);
    if (*progress_.error * *progress_.work > LARGEST_COSTS[progress_.epoch - LEARNING_EPOCH - 1]) {
        progress_.stage = GuideStage::OFF;
        progress_.guided_to = samples;
        progress_.guide.reset();
        progress_.weights.clear();
    }
}

/// Ends a guided epoch, or one that taught only.
void Guiding::end_epoch(std::uint64_t samples, const RenderCounts& counts) {
    read_back();
    if (progress_.pilot_error && progress_.epoch == LEARNING_EPOCH)
        progress_.plain_rays = rays_per_sample(counts);
    if (is_trial())
        judge(samples, rays_per_sample(counts));
    if (progress_.stage == GuideStage::OFF)
        return;
    progress_.guide->learn(progress_.sums);
    buffers_->write(*progress_.guide);
    if (progress_.guided_from == 0)
        progress_.guided_from = samples;
}

/// Where the epoch ends that begins here.
std::uint64_t Guiding::epoch_end(std::uint64_t samples) const {
    if (!progress_.pilot_error || progress_.epoch > LEARNING_EPOCH + 2)
        return 2 * samples;
    const auto replicates = std::uint64_t(prepared_.planned->options.sampling.replicates);
    return samples + (progress_.pilot_end / replicates + TRIAL_PART - 1) / TRIAL_PART * replicates;
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
    progress_.weights = is_trial() ? tile_weights(render_.film) : std::vector<float>();
    launcher_->set_epoch(progress_.epoch);
    if (progress_.stage == GuideStage::ON) {
        start_gains();
        if (progress_.guided_from > 0)
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

std::string guide_text(const GuideProgress& guide) {
    if (guide.guided_from == 0)
        return guide.pilot_error && guide.stage == GuideStage::OFF
                   ? fmt::format(
                         "off: light is found without it (squared error of a sample {:.2g}, tried from {:g})",
                         *guide.pilot_error, WORTHWHILE_ERROR)
                   : "";
    std::string text = fmt::format("from {} spp", guide.guided_from);
    if (guide.stage == GuideStage::OFF)
        text += fmt::format(" to {}", guide.guided_to);
    if (guide.error)
        text += fmt::format(", squared error of a sample {:.2f} times and work {:.2f} times that before",
                            *guide.error, *guide.work);
    if (guide.guide)
        text += fmt::format("; {} cells, {:.0f} MB", guide.guide->lore().size(),
                            double(guide_device_bytes()) * 1e-6);
    return text;
}

} // namespace clrt
