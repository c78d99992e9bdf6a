// SPDX-License-Identifier: Apache-2.0
#include "film/error_measure.h"

#include <algorithm>
#include <array>
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

} // namespace

ErrorWeights::ErrorWeights(const Film& film, const PixelChoice& choice, ErrorMeasure measure)
    : width_(size_t(film.width)), across_((width_ + ERROR_BLOCK_SIZE - 1) / ERROR_BLOCK_SIZE) {
    if (measure == ErrorMeasure::MSE)
        return;
    const BlockSums sums = block_sums(film, choice, across_);
    double total = 0, pixels = 0;
    for (const std::array<double, 4>& block : sums) {
        total += block[0] + block[1] + block[2];
        pixels += block[3];
    }
    const double mean = total / (3 * pixels);
    if (!(mean > 0))
        return;
    weights_.reserve(3 * sums.size());
    for (const std::array<double, 4>& block : sums)
        for (size_t c = 0; c < 3; ++c)
            weights_.push_back(relative_weight(block[c] / std::max(block[3], 1.0), mean));
}

} // namespace clrt
