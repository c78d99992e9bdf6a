// SPDX-License-Identifier: Apache-2.0
#include "film/error_map.h"

#include <cmath>
#include <tbb/parallel_for.h>

namespace clrt {

std::vector<float> error_map(const Film& film, ErrorMeasure measure) {
    const ReplicateMeans replicates(film);
    const size_t n = replicates.count(), width = size_t(film.width), height = size_t(film.height);
    if (n < 2)
        return {};
    const PixelChoice choice(film, ErrorPixels::SCENE);
    const ErrorWeights weights(film, choice, measure);
    std::vector<float> map(width * height);
    std::vector<double> sums(height), pixels(height); // of the rows
    tbb::parallel_for(size_t(0), height, [&](size_t y) {
        std::vector<double> deviations(n);
        for (size_t pixel = y * width; pixel < (y + 1) * width; ++pixel) {
            if (!choice.has(pixel))
                continue;
            double squared = 0, squares = 0;
            for (size_t value = 3 * pixel; value < 3 * pixel + 3; ++value) {
                sums[y] += replicates.read_deviations(value, deviations.data(), squares) / 3;
                squared += weights.of(value) * squares / (3 * double(n) * double(n - 1));
            }
            pixels[y] += 1;
            map[pixel] = float(std::sqrt(squared));
        }
    });
    double sum = 0, count = 0;
    for (size_t y = 0; y < height; ++y) {
        sum += sums[y];
        count += pixels[y];
    }
    if (!(sum > 0))
        return {};
    for (float& error : map)
        error = float(double(error) * count / sum);
    return map;
}

} // namespace clrt
