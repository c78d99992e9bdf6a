// SPDX-License-Identifier: Apache-2.0
#include "render/denoised_target.h"

#include "denoise/half_picture.h"
#include "error.h"
#include "film/error_spread.h"
#include "render/good_counts.h"

#include <new>
#include <spdlog/spdlog.h>

namespace clrt {

DenoiseRequest denoise_request(const Options& options) {
    return {options.denoise,
            options.sampling.measure(),
            options.device.kernels_folder,
            options.device.dump_folder,
            {options.device.cache, options.device.cache_folder}};
}

bool denoised_error_reached(const Film& film, const std::optional<Denoised>& denoised, ErrorMeasure measure,
                            double target) {
    if (!denoised || !denoised->errors || denoised->samples != film_samples(film) ||
        denoised->errors->all.high > target)
        return false;
    const std::optional<ErrorSpread> spread = film_error_spread(film, measure);
    return !spread || spread->usable();
}

bool DenoisedTarget::is_due(const Film& film, const std::optional<FilmError>& error,
                            const std::function<std::uint64_t()>& rays) {
    const std::uint64_t samples = film_samples(film), pixels = film_plane(film) / 3;
    const int replicates = options_.sampling.replicates;
    if (has_failed_ || !is_good_count(samples, replicates) ||
        samples < FEWEST_OF_A_REPLICATE * std::uint64_t(replicates))
        return false;
    const bool is_filter = options_.denoise.denoiser == Denoiser::FILTER;
    const std::uint64_t before = is_filter ? RAYS_BEFORE_LOOKS : RAYS_BEFORE_OIDN;
    const double target = *options_.sampling.denoised_error;
    const double high = last_high_ * double(last_samples_) / double(samples); // no error falls faster
    const bool is_due = (is_first_due_ && error && error->high && *error->high <= target) ||
                        ((is_doubling(samples, replicates) || high <= target) && rays() >= before * pixels);
    is_first_due_ = is_first_due_ && !is_due;
    return is_due;
}

void DenoisedTarget::look(const Device& device, Progress& progress, Render& render) {
    if (has_failed_ || denoise_obstacle(render.film, render.hits))
        return;
    try {
        if (device_ != &device)
            denoiser_.emplace(device, denoise_request(options_));
        device_ = &device;
        render.denoised = denoiser_->denoise(render.film, render.hits);
    } catch (const std::exception& error) { // DeviceError, bad_alloc
        has_failed_ = true;
        progress.finish();
        spdlog::warn("--denoised-error is not looked at any more: {}", error.what());
        return;
    }
    last_samples_ = render.denoised->samples;
    last_high_ = 0;
    render.check_seconds += render.denoised->seconds;
    if (!render.denoised->errors)
        return;
    last_high_ = render.denoised->errors->all.high;
    render.looks.push_back({last_samples_, render.denoised->seconds, render.denoised->errors->all});
}

bool DenoisedTarget::reached(const Render& render) const {
    return denoised_error_reached(render.film, render.denoised, options_.sampling.measure(),
                                  *options_.sampling.denoised_error);
}

} // namespace clrt
