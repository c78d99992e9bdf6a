// SPDX-License-Identifier: Apache-2.0
#include "film/adaptive.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// Of the mean number of samples, what every tile has at least: light that nobody has seen yet is found there
/// too, and where its noise misleads, the squared error is at most doubled. A quarter gained nothing more on
/// any scene measured.
constexpr double SMALLEST_SHARE = 0.5;
/// A tile's samples grow by this factor a round at most, so that rounds end at every power of two.
constexpr std::uint32_t LARGEST_GROWTH = 2;
/// Of samples in a replicate before the first decision.
constexpr std::uint64_t PILOT_OF_A_REPLICATE = 2;

/// A tile that could have its samples doubled.
struct Candidate {
    double gain; ///< squared error that a sample more takes away
    std::uint32_t samples;
    size_t tile;
    /// Where gains are equal, those come first that have less, in order of the tiles.
    bool operator<(const Candidate& other) const {
        if (gain != other.gain)
            return gain < other.gain;
        return samples != other.samples ? samples > other.samples : tile > other.tile;
    }
};

/// Doubles samples where that takes most away from the squared error, as long as the sum over all pixels
/// allows.
class Allocation {
public:
    Allocation(const Film& film, const std::vector<double>& noise, std::vector<std::uint32_t> samples,
               double mean)
        : noise_(noise), start_(samples), samples_(std::move(samples)), pixels_(tile_pixel_counts(film)) {
        most_ = std::uint32_t(FILM_SAMPLES_PER_REPLICATE * std::uint64_t(film.replicates / 2));
        left_ = 0;
        for (size_t tile = 0; tile < samples_.size(); ++tile)
            left_ += (mean - double(samples_[tile])) * double(pixels_[tile]);
        for (size_t tile = 0; tile < samples_.size(); ++tile)
            while (double(samples_[tile]) < SMALLEST_SHARE * mean && can_double(tile))
                double_samples(tile);
    }

    std::vector<std::uint32_t> run() {
        std::priority_queue<Candidate> queue;
        for (size_t tile = 0; tile < samples_.size(); ++tile)
            push(tile, queue);
        while (!queue.empty()) {
            const size_t tile = queue.top().tile;
            queue.pop();
            if (double(samples_[tile]) * double(pixels_[tile]) > left_)
                continue; // a tile with fewer samples may still fit
            double_samples(tile);
            push(tile, queue);
        }
        return std::move(samples_);
    }

private:
    bool can_double(size_t tile) const {
        return samples_[tile] <= most_ / 2 && samples_[tile] < start_[tile] * LARGEST_GROWTH;
    }
    void double_samples(size_t tile) {
        left_ -= double(samples_[tile]) * double(pixels_[tile]);
        samples_[tile] *= 2;
    }
    /// Half of the squared error noise / n for n samples more.
    void push(size_t tile, std::priority_queue<Candidate>& queue) const {
        const double n = double(samples_[tile]);
        if (can_double(tile))
            queue.push({noise_[tile] / (2 * n * n), samples_[tile], tile});
    }

    const std::vector<double>& noise_;
    const std::vector<std::uint32_t> start_;
    std::vector<std::uint32_t> samples_;
    const std::vector<std::uint32_t> pixels_;
    std::uint32_t most_;
    double left_; ///< samples of pixels that may still be given
};

/// Samples of a half that every tile has when the mean of both halves is `mean`: those of the first round
/// times 2^level.
size_t common_level(std::uint64_t mean, std::uint64_t pilot) {
    size_t level = 0;
    while (double(pilot << level) < SMALLEST_SHARE * double(mean))
        ++level;
    return level;
}

/// Notes the noise of the tiles at the number of samples that they have come to.
void note_noise(const Film& film, std::uint64_t pilot, ErrorMeasure measure, std::vector<TileNoise>& noise) {
    for (size_t half = 0; half < 2; ++half) {
        const std::vector<double> now = tile_noise(film, int(half), measure);
        for (size_t tile = 0; tile < now.size(); ++tile) {
            size_t level = 0;
            while ((pilot / 2) << level < film.tile_samples[half][tile])
                ++level;
            if ((pilot / 2) << level != film.tile_samples[half][tile])
                continue; // between two levels, where all tiles are equal
            while (noise.size() <= level) {
                const std::vector<double> none(now.size(), -1.0);
                noise.push_back({none, none});
            }
            if (noise[level][half][tile] < 0)
                noise[level][half][tile] = now[tile];
        }
    }
}

/// Whether a round that ends here ends an octave: p, 2 p, 4 p, ...
bool ends_octave(std::uint64_t end, std::uint64_t pilot) {
    const std::uint64_t octave = end / pilot;
    return (octave & (octave - 1)) == 0 && octave * pilot == end;
}

/// Two rounds an octave: p, 3/2 p, 2 p, 3 p, 4 p, ...
std::uint64_t next_end(std::uint64_t end, std::uint64_t pilot) {
    return ends_octave(end, pilot) ? end / 2 * 3 : end / 3 * 4;
}

bool is_uniform(const std::vector<std::uint32_t>& samples) {
    return std::all_of(samples.begin(), samples.end(), [&](std::uint32_t n) { return n == samples.front(); });
}

/// The samples that the tiles of a half have after a round, by the noise of the other half. Where they are
/// the same everywhere at 3/2 of a power of two they stay it up to the next one, to which no doubling leads.
std::vector<std::uint32_t> half_target(const Film& film, const AdaptiveRound& round, size_t half,
                                       const std::vector<double>& noise, std::uint64_t pilot) {
    const std::vector<std::uint32_t>& start = round.start[half];
    const bool pays = round.gain[1 - half] >= WORTHWHILE_GAIN;
    if (is_uniform(start) && (!pays || !ends_octave(round.first, pilot)))
        return std::vector<std::uint32_t>(start.size(), std::uint32_t(round.end / 2));
    const std::vector<double> alike(noise.size(), 1.0);
    return Allocation(film, pays ? noise : alike, start, 0.5 * double(round.end)).run();
}

/// Means of the replicates of one half.
class HalfMeans {
public:
    HalfMeans(const Film& film, int half)
        : film_(film), count_(size_t(film.replicates / 2)), first_(size_t(half) * count_ * film_plane(film)),
          samples_(film.tile_samples[size_t(half)]) {}

    /// Samples of a replicate in a tile.
    double samples(size_t tile) const { return double(samples_[tile]) / double(count_); }
    /// The mean of value `i` of a plane, and the variance of a replicate's.
    double read(size_t i, double& variance) const {
        const std::int64_t* sums = &film_.sums[first_ + i];
        const size_t plane = film_plane(film_);
        double mean = 0, squares = 0;
        for (size_t k = 0; k < count_; ++k)
            mean += double(sums[k * plane]) / double(count_);
        for (size_t k = 0; k < count_; ++k)
            squares += (double(sums[k * plane]) - mean) * (double(sums[k * plane]) - mean);
        const double factor = film_.scale.quantum / samples(film_tile(film_, i / 3));
        variance = factor * factor * squares / double(count_ - 1);
        return factor * mean;
    }

private:
    const Film& film_;
    size_t count_, first_;
    const std::vector<std::uint32_t>& samples_;
};

/// Mean radiance of a half's picture.
double picture_mean(const Film& film, const HalfMeans& means) {
    double sum = 0, unused = 0;
    for (size_t i = 0; i < film_plane(film); ++i)
        sum += means.read(i, unused);
    return sum / double(film_plane(film));
}

} // namespace

std::uint64_t pilot_samples(int replicates) {
    return PILOT_OF_A_REPLICATE * std::uint64_t(replicates);
}

AdaptiveRound first_round(const Film& film, ErrorMeasure measure) {
    AdaptiveRound round;
    round.measure = measure;
    round.end = pilot_samples(film.replicates);
    for (size_t half = 0; half < 2; ++half) {
        round.start[half].assign(film_tiles(film), 0);
        round.target[half].assign(film_tiles(film), std::uint32_t(round.end / 2));
    }
    return round;
}

AdaptiveRound next_round(const Film& film, const AdaptiveRound& last) {
    AdaptiveRound round;
    round.measure = last.measure;
    round.first = last.end;
    const std::uint64_t pilot = pilot_samples(film.replicates);
    round.end = next_end(last.end, pilot);
    round.start = last.target;
    round.noise = last.noise;
    note_noise(film, pilot, round.measure, round.noise);
    const TileNoise& common = round.noise[std::min(common_level(last.end, pilot), round.noise.size() - 1)];
    for (size_t half = 0; half < 2; ++half)
        round.gain[half] = expected_gain(common[half], tile_pixel_counts(film));
    for (size_t half = 0; half < 2; ++half)
        round.target[half] = half_target(film, round, half, common[1 - half], pilot);
    return round;
}

double expected_gain(const std::vector<double>& noise, const std::vector<std::uint32_t>& pixels) {
    double mean = 0, root = 0, count = 0;
    for (size_t tile = 0; tile < noise.size(); ++tile) {
        mean += noise[tile] * pixels[tile];
        root += std::sqrt(noise[tile]) * pixels[tile];
        count += pixels[tile];
    }
    return root > 0 ? mean * count / (root * root) : 1;
}

TileSamples samples_within(const AdaptiveRound& round, std::uint64_t samples, int replicates) {
    const std::uint64_t step = std::uint64_t(replicates / 2), way = round.end - round.first;
    const std::uint64_t gone = std::min(std::max(samples, round.first), round.end) - round.first;
    TileSamples result = round.start;
    for (size_t half = 0; half < 2; ++half)
        for (size_t tile = 0; tile < result[half].size(); ++tile) {
            const std::uint64_t steps = (round.target[half][tile] - round.start[half][tile]) / step;
            result[half][tile] += std::uint32_t(step * ((2 * steps * gone + way) / (2 * way)));
        }
    return result;
}

std::vector<double> tile_noise(const Film& film, int half, ErrorMeasure measure) {
    const std::vector<std::uint32_t> pixels = tile_pixel_counts(film);
    std::vector<double> noise(film_tiles(film), 0.0);
    const HalfMeans means(film, half);
    const double picture = measure == ErrorMeasure::RELATIVE ? picture_mean(film, means) : 0;
    const size_t width = size_t(film.width), across = film_tiles_across(film);
    // Rows of tiles are independent of each other, and within a tile the order of summation is fixed.
    tbb::parallel_for(size_t(0), noise.size() / across, [&](size_t tile_row) {
        const size_t rows = std::min<size_t>(size_t(film.height), (tile_row + 1) * ADAPTIVE_TILE_SIZE);
        for (size_t value = 3 * tile_row * ADAPTIVE_TILE_SIZE * width; value < 3 * rows * width; ++value) {
            double variance = 0;
            const double mean = means.read(value, variance);
            noise[film_tile(film, value / 3)] +=
                picture > 0 ? variance * relative_weight(mean, picture) : variance;
        }
    });
    // A replicate's mean has the variance of one sample over its samples.
    for (size_t tile = 0; tile < noise.size(); ++tile)
        noise[tile] *= means.samples(tile) / (3.0 * double(pixels[tile]));
    return noise;
}

} // namespace clrt
