// SPDX-License-Identifier: Apache-2.0
#include "render/guiding.h"

#include "film/film_buffers.h"
#include "options/guide_refusal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Samples of each replicate before it is known whether to guide.
constexpr std::uint64_t PILOT_SAMPLES = 2;
/// Squared relative error of one sample from which on a guide is tried, the geometric mean of both measures.
/// Below it light is found without one (Cornell box: .5), and nothing is compiled. Rooms lit through windows
/// have 4 to 12, one behind a door ajar 80.
constexpr double WORTHWHILE_ERROR = 4;
/// What a guided ray costs beside one that is not: cells are looked up, and records written.
constexpr double GUIDED_RAY_WORK = 1.35;
/// The epoch after the pilot only teaches. At the end of each of the next ones squared error times work of
/// all guided samples, over that of the samples before, may be so much: guides become better, and one that
/// passes the last of these stays.
constexpr u32 LEARNING_EPOCH = 1;
constexpr std::array<double, 2> LARGEST_COSTS = {1.25, 1};

double rays_per_sample(const RenderCounts& counts) {
    return double(counts.rays()) / double(std::max<std::uint64_t>(counts.primary, 1));
}

/// Squared errors by both measures (film/error_measure.h); zeros where none can be told.
std::array<double, 2> squared_errors(const Film& film) {
    std::array<double, 2> squares{};
    for (const ErrorMeasure measure : {ErrorMeasure::MSE, ErrorMeasure::RELATIVE})
        if (const auto error = film_error(film, ErrorPixels::SCENE, measure))
            squares[size_t(measure)] = error->relative_rmse * error->relative_rmse;
    return squares;
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
        progress_.guide.emplace(double(params_.scene_extent));
    program_ = build_guided_program(prepared_);
    launcher_.emplace(prepared_.device, *program_,
                      integrator_kernel(prepared_.planned->options.transport.integrator), params_,
                      prepared_.buffers);
    film_.bind(launcher_->kernel());
    buffers_.emplace(prepared_.device);
    buffers_->bind(launcher_->kernel());
    buffers_->write(*progress_.guide, progress_.sums);
    launcher_->set_epoch(progress_.epoch);
}

std::uint64_t Guiding::end() const {
    return progress_.stage == GuideStage::OFF ? UINT64_MAX : progress_.end;
}

Launcher* Guiding::launcher() {
    return progress_.stage == GuideStage::ON ? &*launcher_ : nullptr;
}

void Guiding::end_pilot(std::uint64_t samples) {
    const std::array<double, 2> errors = squared_errors(render_.film);
    progress_.pilot_error = std::sqrt(errors[0] * errors[1]) * double(samples);
    progress_.stage = *progress_.pilot_error < WORTHWHILE_ERROR ? GuideStage::OFF : GuideStage::ON;
    if (progress_.stage == GuideStage::ON)
        switch_on();
}

/// Compares the guided samples with those before them, by the measure that gains more: where light is hard to
/// find, one of them rests on few bright samples.
void Guiding::judge(std::uint64_t samples, double rays) {
    // Of n times as many samples as there are plain ones, (1 + (n - 1) x) / n^2 is the factor of the squared
    // error, x being that of guided samples, and (1 + (n - 1) x) / n likewise that of the rays a sample.
    const double n = double(samples) / double(progress_.guided_from);
    const std::array<double, 2> errors = squared_errors(render_.film);
    const double factor =
        std::min(errors[0] / progress_.plain_errors[0], errors[1] / progress_.plain_errors[1]);
    progress_.error = std::max((n * n * factor - 1) / (n - 1), 0.0);
    progress_.work = GUIDED_RAY_WORK * (n * rays / progress_.plain_rays - 1) / (n - 1);
    const double largest = LARGEST_COSTS[progress_.epoch - LEARNING_EPOCH - 1];
    if (*progress_.error * *progress_.work > largest) {
        progress_.stage = GuideStage::OFF;
        progress_.guided_to = samples;
        progress_.guide.reset();
    }
}

/// Ends a guided epoch, or one that taught only.
void Guiding::end_epoch(std::uint64_t samples, const RenderCounts& counts) {
    const bool is_on_trial =
        progress_.pilot_error && progress_.epoch <= LEARNING_EPOCH + LARGEST_COSTS.size();
    if (is_on_trial && progress_.epoch == LEARNING_EPOCH) {
        progress_.plain_errors = squared_errors(render_.film);
        progress_.plain_rays = rays_per_sample(counts);
    } else if (is_on_trial)
        judge(samples, rays_per_sample(counts));
    if (progress_.stage == GuideStage::OFF)
        return;
    progress_.guide->learn(buffers_->read_sums(progress_.guide->lore().size()));
    buffers_->write(*progress_.guide);
    if (progress_.guided_from == 0)
        progress_.guided_from = samples;
}

void Guiding::advance(std::uint64_t samples, const RenderCounts& counts) {
    if (samples < end())
        return;
    film_.read_sums(render_);
    if (progress_.stage == GuideStage::PILOT) {
        end_pilot(samples);
        if (progress_.stage == GuideStage::OFF)
            return; // the picture is that of a render without a guide
    } else
        end_epoch(samples, counts);
    progress_.sums.clear();
    progress_.epoch += 1;
    progress_.end = 2 * samples;
    launcher_->set_epoch(progress_.epoch);
}

void Guiding::read_back() {
    if (progress_.stage == GuideStage::ON)
        progress_.sums = buffers_->read_sums(progress_.guide->lore().size());
    else
        progress_.sums.clear();
}

std::string guide_text(const Options& options, const GuideProgress& guide) {
    if (const auto refusal = guide_refusal(options); refusal && options.transport.guide == Toggle::AUTO)
        return refusal->option == std::string("--integrator")
                   ? ""
                   : fmt::format("off with {}: {}", refusal->option, refusal->reason);
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
