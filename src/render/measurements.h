// SPDX-License-Identifier: Apache-2.0
// What is known of a render while it goes on: its error and its rays, as last measured.
#pragma once

#include "film/film_buffers.h"
#include "render/error_price.h"
#include "render/render.h"

#include <optional>

namespace clrt {

/// The last measurements of one run.
class Measurements {
public:
    /// Reads the film into `render` and measures its error and its rays; `earlier_samples`, of all pixels,
    /// were there before this run.
    void measure_film(const FilmBuffers& buffers, std::uint64_t earlier_samples, Render& render);
    /// The same of a film that is in `render` already, with these counts of this run.
    void judge_film(const RenderCounts& counts, std::uint64_t earlier_samples, Render& render);
    /// Measures the rays alone, now and then; this run has taken `samples` a pixel in `seconds`.
    void measure_rays(const FilmBuffers& buffers, const Film& film, double samples, double seconds);

    /// Forecasts from the errors at doublings what `target` takes, where it is not reached.
    void forecast(const std::vector<SquaredError>& doublings, int replicates,
                  const std::optional<double>& target);

    /// The last measured error; none yet, or none to be measured.
    const std::optional<SquaredError>& error() const { return error_; }
    /// What the target takes beyond the last measured error, in samples instead of seconds; none: not known,
    /// or no target.
    const std::optional<ErrorPrice>& price() const { return price_; }
    /// The error after so many samples a pixel, as it falls by the forecast; -1: not known.
    double error_at(double samples) const;
    /// Rays a second of a run that took so many samples a pixel in `seconds`, if each took as many as those
    /// that were measured; -1: not known.
    double rays_per_second(const Film& film, double samples, double seconds) const;

private:
    std::optional<SquaredError> error_;
    std::optional<ErrorForecast> forecast_;
    std::optional<ErrorPrice> price_;
    double rays_per_sample_ = -1;
    double next_rays_seconds_ = 0.2; ///< of the run: a progress line has not been shown before
};

} // namespace clrt
