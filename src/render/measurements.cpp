// SPDX-License-Identifier: Apache-2.0
#include "render/measurements.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

/// Between two measurements of rays, seconds: scenes change little from one part to the next.
constexpr double RAYS_INTERVAL = 5;
/// Reading the counts of a picture of a hundred million pixels takes seconds: at most this part of the
/// render.
constexpr double LARGEST_RAYS_SHARE = 0.01;

/// Rays of a sample, its primary ray included.
double rays_per_sample(const RenderCounts& counts, double samples) {
    return 1 + double(counts.secondary + counts.shadow) / samples;
}

double pixel_count(const Film& film) {
    return double(film.width) * double(film.height);
}

} // namespace

void Measurements::measure_film(const FilmBuffers& buffers, std::uint64_t earlier_samples, Render& render) {
    const auto start = Clock::now();
    buffers.read_sums(render);
    buffers.read_shown(render.film);
    // Beside the sums of all replicates, a few words a pixel are read in no time.
    const RenderCounts counts = buffers.read_counts();
    render.check_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    judge_film(counts, earlier_samples, render);
}

void Measurements::judge_film(const RenderCounts& counts, std::uint64_t earlier_samples, Render& render) {
    const auto start = Clock::now();
    error_ = film_squared_error(render.film, ErrorPixels::SCENE, 1, render.round.measure);
    if (const std::uint64_t samples = film_all_samples(render.film) - earlier_samples; samples > 0)
        rays_per_sample_ = rays_per_sample(counts, double(samples));
    render.check_seconds += std::chrono::duration<double>(Clock::now() - start).count();
}

void Measurements::forecast(const std::vector<SquaredError>& doublings, int replicates,
                            const std::optional<double>& target) {
    forecast_ = forecast_error(doublings, *error_);
    const std::optional<FilmError> error = relative_error(*error_);
    price_.reset();
    const bool is_first = error_->samples < FEWEST_OF_A_REPLICATE * std::uint64_t(replicates);
    if (target && error && error->relative_rmse > *target && !is_first)
        price_ = price_of_error(*target, doublings, *error_, replicates, double(error_->samples));
}

void Measurements::measure_rays(const FilmBuffers& buffers, const Film& film, double samples,
                                double seconds) {
    if (seconds < next_rays_seconds_ || !(samples > 0))
        return;
    const auto start = Clock::now();
    rays_per_sample_ = rays_per_sample(buffers.read_counts(), samples * pixel_count(film));
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    next_rays_seconds_ = seconds + took + std::max(RAYS_INTERVAL, took / LARGEST_RAYS_SHARE);
}

double Measurements::error_at(double samples) const {
    const std::optional<FilmError> error = error_ ? relative_error(*error_) : std::nullopt;
    if (!error || !forecast_)
        return -1;
    return error->relative_rmse * std::pow(samples / double(error_->samples), forecast_->slope);
}

double Measurements::rays_per_second(const Film& film, double samples, double seconds) const {
    return rays_per_sample_ < 0 ? -1 : rays_per_sample_ * pixel_count(film) * samples / seconds;
}

} // namespace clrt
