// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include "denoise/feature_filter.h"
#include "denoise/oidn.h"
#include "error.h"
#include "seconds.h"

#include <chrono>
#include <numeric>
#include <spdlog/spdlog.h>
#include <stdexcept>

namespace clrt {

namespace {

/// The library where it is asked for, or where nothing else is and it is there; else null.
std::unique_ptr<Oidn> open_oidn(const DenoiseOptions& options) {
    if (options.denoiser == Denoiser::FILTER)
        return nullptr;
    try {
        return std::make_unique<Oidn>(options.oidn_path);
    } catch (const std::runtime_error& error) {
        if (options.denoiser == Denoiser::OIDN)
            throw DeviceError(error.what());
        spdlog::debug("{}", error.what());
        return nullptr;
    }
}

/// Both halves, one after the other, as `candidates_of` smoothes them.
template <class Candidates>
std::array<DenoisedHalf, 2> denoise_halves(const Film& film, const HitSums& hits,
                                           Candidates&& candidates_of) {
    std::array<DenoisedHalf, 2> halves;
    for (size_t i = 0; i < 2; ++i) {
        const HalfPicture half = half_picture(film, hits, i);
        halves[i] = choose_candidates(half, candidates_of(half));
    }
    return halves;
}

} // namespace

Denoised denoise(const Device& device, const Film& film, const HitSums& hits, const DenoiseRequest& request) {
    const auto start = std::chrono::steady_clock::now();
    Denoised result;
    std::array<DenoisedHalf, 2> halves;
    if (const std::unique_ptr<Oidn> oidn = open_oidn(request.options)) {
        result.method = "oidn " + oidn->version();
        try {
            halves = denoise_halves(film, hits, [&](const HalfPicture& half) {
                return std::vector<DenoiseCandidate>{oidn->candidate(half)};
            });
        } catch (const std::runtime_error& error) {
            throw DeviceError(error.what());
        }
    } else {
        result.method = name_of(Denoiser::FILTER);
        FeatureFilter filter(device, request);
        halves = denoise_halves(film, hits, [&](const HalfPicture& half) { return filter.candidates(half); });
    }
    result.radiance.resize(film_plane(film));
    for (size_t i = 0; i < result.radiance.size(); ++i)
        result.radiance[i] = 0.5f * (halves[0].radiance[i] + halves[1].radiance[i]);
    for (const DenoisedHalf& half : halves)
        result.noisy_share +=
            std::accumulate(half.noisy.begin(), half.noisy.end(), 0.0) / double(2 * half.noisy.size());
    result.errors = denoised_errors(film, halves, request.measure);
    result.seconds = seconds_since(start);
    return result;
}

} // namespace clrt
