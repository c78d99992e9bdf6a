// SPDX-License-Identifier: Apache-2.0
#include "film/error_measure.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// Sums of channels over the chosen pixels of each block, with their number as a fourth.
using BlockSums = std::vector<std::array<double, 4>>;

/// Rows of blocks are independent of each other, and within a block the order of summation is fixed.
BlockSums block_sums(const Film& film, const PixelChoice& choice, size_t across) {
    const ReplicateMeans replicates(film);
    const size_t width = size_t(film.width), height = size_t(film.height);
    const size_t rows = (height + ERROR_BLOCK_SIZE - 1) / ERROR_BLOCK_SIZE;
    BlockSums sums(across * rows);
    tbb::parallel_for(size_t(0), rows, [&](size_t row) {
        std::vector<double> means(replicates.count());
        const size_t end = std::min(height, (row + 1) * ERROR_BLOCK_SIZE) * width;
        for (size_t pixel = row * ERROR_BLOCK_SIZE * width; pixel < end; ++pixel) {
            if (!choice.has(pixel))
                continue;
            std::array<double, 4>& block = sums[row * across + pixel % width / ERROR_BLOCK_SIZE];
            block[3] += 1;
            for (size_t c = 0; c < 3; ++c) {
                replicates.read(3 * pixel + c, means.data());
                for (const double mean : means)
                    block[c] += mean / double(means.size());
            }
        }
    });
    return sums;
}

/// The mean of a value over its replicates without the one in which it is brightest; 0 of one alone.
double mean_without_brightest(const ReplicateMeans& replicates, size_t i) {
    thread_local std::vector<double> means;
    means.resize(replicates.count());
    if (means.size() < 2)
        return 0;
    replicates.read(i, means.data());
    const double brightest = *std::max_element(means.begin(), means.end());
    const double sum = std::accumulate(means.begin(), means.end(), 0.0);
    return (sum - brightest) / double(means.size() - 1);
}

} // namespace

ErrorWeights::ErrorWeights(const Film& film, const PixelChoice& choice, ErrorMeasure measure)
    : replicates_(film), width_(size_t(film.width)),
      across_((width_ + ERROR_BLOCK_SIZE - 1) / ERROR_BLOCK_SIZE) {
    if (measure == ErrorMeasure::MSE)
        return;
    const BlockSums sums = block_sums(film, choice, across_);
    double total = 0, pixels = 0;
    for (const std::array<double, 4>& block : sums) {
        total += block[0] + block[1] + block[2];
        pixels += block[3];
    }
    mean_ = total / (3 * pixels);
    if (!(mean_ > 0))
        return;
    radiances_.reserve(3 * sums.size());
    for (const std::array<double, 4>& block : sums)
        for (size_t c = 0; c < 3; ++c)
            radiances_.push_back(block[c] / std::max(block[3], 1.0));
}

double ErrorWeights::of(size_t i) const {
    if (radiances_.empty())
        return 1;
    const double around = radiances_[3 * block(i / 3) + i % 3];
    const double own = mean_without_brightest(replicates_, i);
    return relative_weight(own > STANDS_OUT * around ? own : around, mean_);
}

} // namespace clrt
