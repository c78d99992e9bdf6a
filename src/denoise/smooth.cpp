// SPDX-License-Identifier: Apache-2.0
#include "denoise/smooth.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// Binomial coefficients over their sum.
std::vector<double> binomial_weights(int radius) {
    std::vector<double> weights{1};
    for (int i = 0; i < 2 * radius; ++i) {
        weights.push_back(0);
        for (size_t k = weights.size() - 1; k > 0; --k)
            weights[k] = 0.5 * (weights[k] + weights[k - 1]);
        weights[0] *= 0.5;
    }
    return weights;
}

/// Smooths along lines of `length` pixels that are `step` values apart; line `i` starts at first(i).
template <class First>
void smooth_lines(const Pixels& from, Pixels& to, int lines, First&& first, int length, size_t step,
                  int channels, const std::vector<double>& weights) {
    const int radius = int(weights.size()) / 2;
    tbb::parallel_for(0, lines, [&](int line) {
        const size_t start = first(line);
        for (int x = 0; x < length; ++x)
            for (int c = 0; c < channels; ++c) {
                double sum = 0, weight = 0;
                for (int u = std::max(x - radius, 0); u <= std::min(x + radius, length - 1); ++u) {
                    const double w = weights[size_t(u - x + radius)];
                    sum += w * double(from[start + size_t(u) * step + size_t(c)]);
                    weight += w;
                }
                to[start + size_t(x) * step + size_t(c)] = float(sum / weight);
            }
    });
}

} // namespace

Pixels smooth_binomial(const Pixels& values, int width, int height, int channels, int radius) {
    const std::vector<double> weights = binomial_weights(radius);
    const size_t across = size_t(channels), down = across * size_t(width);
    Pixels once(values.size()), twice(values.size());
    smooth_lines(
        values, once, height, [&](int y) { return size_t(y) * down; }, width, across, channels, weights);
    smooth_lines(
        once, twice, width, [&](int x) { return size_t(x) * across; }, height, down, channels, weights);
    return twice;
}

Pixels smooth_alike(const Pixels& values, const std::vector<char>& kinds, int width, int height, int channels,
                    int radius) {
    if (std::find(kinds.begin(), kinds.end(), 1) == kinds.end())
        return smooth_binomial(values, width, height, channels, radius);
    const size_t across = size_t(channels);
    Pixels result(values.size());
    for (const char kind : {0, 1}) {
        Pixels of_kind(values.size(), 0.0f), counted(kinds.size(), 0.0f);
        for (size_t i = 0; i < values.size(); ++i)
            if (kinds[i / across] == kind)
                of_kind[i] = values[i], counted[i / across] = 1;
        of_kind = smooth_binomial(of_kind, width, height, channels, radius);
        counted = smooth_binomial(counted, width, height, 1, radius);
        for (size_t i = 0; i < values.size(); ++i)
            if (kinds[i / across] == kind)
                result[i] = of_kind[i] / counted[i / across];
    }
    return result;
}

double binomial_variance(int radius) {
    double sum = 0;
    for (const double weight : binomial_weights(radius))
        sum += weight * weight;
    return sum * sum;
}

} // namespace clrt
