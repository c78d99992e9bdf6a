// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include "denoise/feature_filter.h"
#include "denoise/oidn.h"
#include "error.h"
#include "seconds.h"

#include <chrono>
#include <numeric>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// The library where it is asked for, or where nothing else is and it is there; else null.
std::unique_ptr<Oidn> open_oidn(const DenoiseOptions& options) {
    if (options.denoiser == Denoiser::FILTER)
        return nullptr;
    try {
        return std::make_unique<Oidn>(options.oidn_path);
    } catch (const DeviceError& error) {
        if (options.denoiser == Denoiser::OIDN)
            throw;
        spdlog::debug("{}", error.what());
        return nullptr;
    }
}

} // namespace

FilmDenoiser::FilmDenoiser(const Device& device, const DenoiseRequest& request)
    : measure_(request.measure), oidn_(open_oidn(request.options)) {
    if (!oidn_)
        filter_ = std::make_unique<FeatureFilter>(device, request);
}

FilmDenoiser::~FilmDenoiser() = default;

/// Both halves, one after the other.
std::array<DenoisedHalf, 2> FilmDenoiser::halves(const Film& film, const HitSums& hits) {
    std::array<DenoisedHalf, 2> halves;
    for (size_t i = 0; i < 2; ++i) {
        const HalfPicture half = half_picture(film, hits, i);
        halves[i] = choose_candidates(half, oidn_ ? std::vector<DenoiseCandidate>{oidn_->candidate(half)}
                                                  : filter_->candidates(half));
    }
    return halves;
}

Denoised FilmDenoiser::denoise(const Film& film, const HitSums& hits) {
    const auto start = std::chrono::steady_clock::now();
    const std::array<DenoisedHalf, 2> halves = this->halves(film, hits);
    Denoised result;
    result.method = oidn_ ? "oidn " + oidn_->version() : name_of(Denoiser::FILTER);
    result.samples = film_samples(film);
    result.radiance.resize(film_plane(film));
    for (size_t i = 0; i < result.radiance.size(); ++i)
        result.radiance[i] = 0.5f * (halves[0].radiance[i] + halves[1].radiance[i]);
    for (const DenoisedHalf& half : halves)
        result.noisy_share +=
            std::accumulate(half.noisy.begin(), half.noisy.end(), 0.0) / double(2 * half.noisy.size());
    result.errors = denoised_errors(film, halves, measure_);
    result.seconds = seconds_since(start);
    return result;
}

} // namespace clrt
