// SPDX-License-Identifier: Apache-2.0
#include "render/film.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

constexpr double PI = 3.14159265358979323846;
constexpr int QUANTUM_BITS = 20;       ///< the quantum is 2^-20 levels
constexpr int LARGEST_BITS = 24;       ///< a contribution is at most 2^24 levels
constexpr int BRIGHTEST_BITS = 20;     ///< the brightest light is at most 2^20 levels: room for path weights above 1

double luminance(double r, double g, double b) {
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/// Largest radiance component of anything that shines.
double brightest_light(const Scene& scene) {
    double brightest = 0;
    for (const Emitter& emitter : scene.emitters) {
        const vec4& e = scene.materials[scene.triangles[emitter.triangle].material].emission;
        brightest = std::max({brightest, double(e.x), double(e.y), double(e.z)});
    }
    for (const Light& light : scene.lights)
        if (light.kind == LIGHT_SUN)
            brightest = std::max({brightest, double(light.emission.x), double(light.emission.y),
                                  double(light.emission.z)});
    const glm::dvec3& sky = scene.environment.radiance;
    double texel = scene.environment.texels.empty() ? 1 : 0;
    for (const EnvironmentTexel& t : scene.environment.texels)
        texel = std::max({texel, double(t.radiance.x), double(t.radiance.y), double(t.radiance.z)});
    return std::max(brightest, texel * std::max({sky.x, sky.y, sky.z}));
}

/// Means of the replicates that have samples, for one pixel and channel.
struct ReplicateMeans {
    std::vector<int> used;       ///< replicates that have samples
    std::vector<double> factor;  ///< quantum / samples of each
    explicit ReplicateMeans(const Film& film) {
        for (int r = 0; r < film.replicates; ++r) {
            const std::uint64_t n = film_replicate_samples(film, r);
            if (n == 0)
                continue;
            used.push_back(r);
            factor.push_back(film.scale.quantum / double(n));
        }
    }
    /// Fills `means` for value `i` of a replicate's plane.
    void read(const Film& film, size_t i, std::vector<double>& means) const {
        const size_t plane = size_t(film.width) * film.height * 3;
        means.resize(used.size());
        for (size_t k = 0; k < used.size(); ++k)
            means[k] = double(film.sums[size_t(used[k]) * plane + i]) * factor[k];
    }
};

/// Unbiased variance of `values`, leaving out index `without` (none: values.size()), over their number: the variance of
/// their mean.
double variance_of_mean(const std::vector<double>& values, size_t without) {
    const double n = double(values.size() - (without < values.size() ? 1 : 0));
    double sum = 0;
    for (size_t k = 0; k < values.size(); ++k)
        sum += k == without ? 0 : values[k];
    double squares = 0;
    for (size_t k = 0; k < values.size(); ++k)
        squares += k == without ? 0 : (values[k] - sum / n) * (values[k] - sum / n);
    return squares / ((n - 1) * n);
}

/// 97.5 % quantile of Student's t for 1 to 30 degrees of freedom (Abramowitz and Stegun, table 26.10, by their expansion
/// 26.7.5 beyond 7).
double student_quantile(size_t degrees) {
    static const double SMALL[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365};
    if (degrees <= 7)
        return SMALL[degrees - 1];
    const double z = 1.959964, n = double(degrees);
    return z + (z * z * z + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

} // namespace

FilmScale film_scale(const Scene& scene) {
    const double radius = std::sqrt(3.0) * std::max(double(scene.extent), 1e-30);
    const glm::dvec3& sky = scene.environment.radiance;
    const double sky_mean =
        scene.environment.texels.empty() ? luminance(sky.x, sky.y, sky.z) : scene.environment.mean_radiance;
    const double mean = scene.emitted_power / (4 * PI * radius * radius * PI) + sky_mean;
    const double level = std::max(mean, std::ldexp(brightest_light(scene), -BRIGHTEST_BITS));
    const int exponent = level > 0 ? int(std::lround(std::log2(level))) : 0;
    return {std::ldexp(1.0, exponent - QUANTUM_BITS), std::ldexp(1.0, exponent + LARGEST_BITS)};
}

std::uint64_t film_replicate_samples(const Film& film, int replicate) {
    const std::uint64_t count = std::uint64_t(film.replicates);
    const auto below = [&](std::uint64_t end) { return (end + count - 1 - std::uint64_t(replicate)) / count; };
    return below(film.first_sample + film.samples) - below(film.first_sample);
}

std::vector<float> film_mean(const Film& film) {
    const size_t plane = size_t(film.width) * film.height * 3;
    std::vector<float> mean(plane, 0.0f);
    if (film.samples == 0)
        return mean;
    for (size_t i = 0; i < plane; ++i) {
        std::int64_t sum = 0;
        for (int r = 0; r < film.replicates; ++r)
            sum += film.sums[size_t(r) * plane + i];
        mean[i] = float(double(sum) * film.scale.quantum / double(film.samples));
    }
    return mean;
}

std::vector<float> film_variance(const Film& film) {
    const ReplicateMeans replicates(film);
    if (replicates.used.size() < 2)
        return {};
    std::vector<float> variance(size_t(film.width) * film.height * 3);
    std::vector<double> means;
    for (size_t i = 0; i < variance.size(); ++i) {
        replicates.read(film, i, means);
        variance[i] = float(variance_of_mean(means, means.size()));
    }
    return variance;
}

std::optional<FilmError> film_error(const Film& film) {
    const ReplicateMeans replicates(film);
    const size_t count = replicates.used.size();
    if (count < 2)
        return std::nullopt;
    // Mean squared error of the picture, and of the pictures that leave out one replicate.
    double mse = 0, sum = 0;
    std::vector<double> without(count, 0.0), means;
    const size_t plane = size_t(film.width) * film.height * 3;
    for (size_t i = 0; i < plane; ++i) {
        replicates.read(film, i, means);
        mse += variance_of_mean(means, count);
        for (double m : means)
            sum += m / double(count);
        for (size_t k = 0; count >= 4 && k < count; ++k)
            without[k] += variance_of_mean(means, k);
    }
    if (!(sum > 0))
        return std::nullopt;
    FilmError error;
    error.relative_rmse = std::sqrt(mse / double(plane)) / (sum / double(plane));
    if (count < 4 || !(mse > 0))
        return error;
    // Jackknife on log MSE; half of it is the log of the error.
    double mean_log = 0, spread = 0;
    for (double value : without)
        mean_log += std::log(value) / double(count);
    for (double value : without)
        spread += (std::log(value) - mean_log) * (std::log(value) - mean_log);
    const double deviation = std::sqrt(spread * double(count - 1) / double(count));
    const double reach = std::exp(0.5 * student_quantile(count - 1) * deviation);
    error.low = error.relative_rmse / reach;
    error.high = error.relative_rmse * reach;
    return error;
}

} // namespace clrt
