// SPDX-License-Identifier: Apache-2.0
#include "denoise/choice.h"

#include "denoise/smooth.h"

#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// Pixels around each one whose squared errors decide for it, and among which choices blend: of those that
/// are lit as it is, so that the rim of a lamp does not decide for the wall beside it.
constexpr int DECIDING_RADIUS = 24, BLENDING_RADIUS = 2;
/// The same of DenoisedHalf::expected: as few as tell the rim of a lamp from what is beside it.
constexpr int EXPECTING_RADIUS = 3;

/// An estimate of the squared error of (d1 + d2) / 2, summed over channels. With quarters c1 and c2 of equal
/// variance v, |d1 - c2|^2 - v is that of d1, where v is unbiased as |c1 - c2|^2 / 2, and the error of a mean
/// is the mean of the errors less |d1 - d2|^2 / 4.
Pixels squared_errors(const std::array<Pixels, 2>& d, const std::array<Pixels, 2>& c) {
    Pixels errors(d[0].size() / 3);
    tbb::parallel_for(size_t(0), errors.size(), [&](size_t pixel) {
        double sum = 0;
        for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            const double d1 = d[0][i], d2 = d[1][i], c1 = c[0][i], c2 = c[1][i];
            sum += 0.5 * ((d1 - c2) * (d1 - c2) + (d2 - c1) * (d2 - c1) - (c1 - c2) * (c1 - c2)) -
                   0.25 * (d1 - d2) * (d1 - d2);
        }
        errors[pixel] = float(sum);
    });
    return errors;
}

} // namespace

DenoisedHalf choose_candidates(const HalfPicture& half, const std::vector<DenoiseCandidate>& candidates) {
    const size_t pixels = half.mean.size() / 3, count = candidates.size() + 1;
    std::vector<Pixels> errors = {squared_errors(half.quarter, half.quarter)}, deciding;
    for (const DenoiseCandidate& candidate : candidates)
        errors.push_back(squared_errors(candidate.quarter, half.quarter));
    for (const Pixels& of_candidate : errors)
        deciding.push_back(smooth_alike(of_candidate, half.lit, half.width, half.height, 1, DECIDING_RADIUS));

    // Take the least error at every pixel.
    Pixels shares(count * pixels, 0.0f); // of every candidate in each pixel
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        size_t best = 0;
        for (size_t i = 1; i < count; ++i)
            if (deciding[i][pixel] < deciding[best][pixel])
                best = i;
        shares[count * pixel + best] = 1;
    }

    // Blend between the pixels.
    shares = smooth_alike(shares, half.lit, half.width, half.height, int(count), BLENDING_RADIUS);
    DenoisedHalf result;
    result.radiance.resize(half.mean.size());
    for (Pixels* values : {&result.expected, &result.noisy})
        values->resize(pixels);
    tbb::parallel_for(size_t(0), pixels, [&](size_t pixel) {
        const float* share = &shares[count * pixel];
        result.noisy[pixel] = share[0];
        double expected = 0;
        for (size_t k = 0; k < count; ++k)
            expected += double(share[k]) * double(errors[k][pixel]);
        result.expected[pixel] = float(expected);
        for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            double sum = double(share[0]) * double(half.mean[i]);
            for (size_t k = 1; k < count; ++k)
                sum += double(share[k]) * double(candidates[k - 1].half[i]);
            result.radiance[i] = float(sum);
        }
    });
    result.expected = smooth_binomial(result.expected, half.width, half.height, 1, EXPECTING_RADIUS);
    return result;
}

} // namespace clrt
