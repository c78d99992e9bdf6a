// SPDX-License-Identifier: Apache-2.0
// The film: long sums, their variance, full films, the last sample numbers, and runs that are cut in parts.
#include "stability/catalogue.h"
#include "stability/choices.h"
#include "stability/film_bench.h"

#include "probes/effect_masks.h"
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"
#include "probes/statistics.h"

#include <cmath>
#include <fmt/format.h>
#include <set>
#include <stdexcept>

namespace clrt {

namespace {

/// Samples of a pixel: multiples of 512 near a million, and what the film can hold.
constexpr double MILLION = 1 << 20, FULL = double(FilmBench::REPLICATES) * FILM_SAMPLES_PER_REPLICATE;

std::vector<float> noisy_series(size_t count, double mean) {
    Random random(41);
    std::vector<float> series(count);
    for (float& value : series)
        value = float(mean + random.unit());
    return series;
}

std::string describe_pixel(size_t value) {
    return fmt::format("pixel {}, channel {}", value / 3, value % 3);
}

void constant_sum(CaseRun& run) {
    Figure& ulps = run.figure("ULP of the mean", 1);
    for (const float constant : {0.1f, 1e-6f, 0.7e9f}) {
        FilmBench bench(run.device, std::vector<float>(run.count(MILLION, MILLION, FULL), constant),
                        double(constant));
        const auto see = [&](Build build, double mean, size_t i) {
            ulps[build].see(ulp_distance(float(mean), double(constant)),
                            [&] { return fmt::format("{:a}, {}", constant, describe_pixel(i)); });
        };
        for (const Build build : run.builds()) {
            const bool naive = build == Build::NAIVE;
            const std::vector<double> sums = naive ? bench.sums(SumKind::PLAIN) : std::vector<double>();
            const std::vector<float> means = naive ? std::vector<float>() : film_mean(bench.film(build));
            for (size_t i = 0; i < size_t(FilmBench::PIXELS) * 3; ++i)
                see(build, naive ? sums[i] / double(bench.series().size()) : double(means[i]), i);
        }
    }
}

void noisy_mean(CaseRun& run) {
    FilmBench bench(run.device, noisy_series(run.count(MILLION, MILLION, FULL), 100), 100.5);
    const double exact = double(bench.mean()), samples = double(bench.series().size());
    Figure& error = run.figure("relative error (naive: a float)", 1.2e-7);
    Figure& blocks = run.figure("relative error (naive: blocks, two-sum)", 1.2e-7);
    Figure& wide = run.figure("relative error (naive: a double)", 1.2e-7);
    const auto see = [&](Figure& figure, Build build, double mean, size_t i) {
        figure[build].see(std::abs(double(float(mean)) - exact) / exact, [&] { return describe_pixel(i); });
    };
    for (const Build build : run.builds())
        if (build != Build::NAIVE) {
            const std::vector<float> means = film_mean(bench.film(build));
            for (size_t i = 0; i < means.size(); ++i)
                see(error, build, double(means[i]), i);
            blocks[build] = wide[build] = error[build];
        }
    for (const auto& [figure, kind] :
         {std::pair{&error, SumKind::PLAIN}, {&blocks, SumKind::BLOCKS}, {&wide, SumKind::DOUBLE}}) {
        const std::vector<double> sums = bench.sums(kind);
        for (size_t i = 0; i < sums.size(); ++i)
            see(*figure, Build::NAIVE, sums[i] / samples, i);
    }
}

/// Variance of the mean of the replicates' means.
double variance_of_mean(const std::vector<long double>& means) {
    long double mean = 0, squares = 0;
    for (const long double m : means)
        mean += m / (long double)(means.size());
    for (const long double m : means)
        squares += (m - mean) * (m - mean);
    return double(squares / (long double)(means.size() * (means.size() - 1)));
}

void noisy_variance(CaseRun& run) {
    Figure& error = run.figure("relative error of the variance", 1e-3);
    FilmBench bench(run.device, noisy_series(run.count(MILLION, MILLION, FULL), 100), 100.5);
    const double exact = variance_of_mean(bench.replicate_means());
    for (const Build build : run.builds())
        if (build != Build::NAIVE) {
            const std::vector<float> variance = film_variance(bench.film(build));
            for (size_t i = 0; i < variance.size(); ++i)
                error[build].see(std::abs(double(variance[i]) / exact - 1),
                                 [&] { return describe_pixel(i); });
        }
    // The textbook: a sum and a sum of squares, whose difference is the variance of one sample.
    const double n = double(bench.series().size());
    std::vector<double> values(bench.series().begin(), bench.series().end());
    const double of_a_sample = moments_of(values).variance;
    const std::vector<double> sums = bench.sums(SumKind::SQUARES);
    for (size_t i = 0; i < sums.size(); i += 3) {
        const double mean = sums[i] / n, variance = sums[i + 1] / n - mean * mean;
        error[Build::NAIVE].see(std::abs(variance / of_a_sample - 1), [&] { return describe_pixel(i); });
    }
}

/// Counts the sums that differ.
void compare_films(Worst& worst, const Film& whole, const Film& parts, const std::string& how) {
    if (whole.sums.size() != parts.sums.size())
        throw std::runtime_error("films of different sizes");
    for (size_t i = 0; i < whole.sums.size(); ++i)
        worst.count(whole.sums[i] != parts.sums[i], [&] { return fmt::format("{}: sum {}", how, i); });
}

/// The film of a render that is cut: by `windows` and by ranges of samples.
Film render_in_parts(const ProbeDevice& device, const Scene& scene, Options options,
                     const std::vector<Crop>& windows, const std::vector<u32>& range_lengths) {
    Film whole;
    whole.width = options.film.size.x;
    whole.height = options.film.size.y;
    whole.replicates = options.sampling.replicates;
    whole.sums.resize(size_t(options.sampling.replicates) * film_plane(whole));
    u32 first = options.sampling.first_sample;
    for (const u32 length : range_lengths) {
        options.sampling.first_sample = first;
        options.sampling.spp = length;
        first += length;
        for (const Crop& window : windows) {
            options.film.crop = window;
            const Film part = render_loaded(device, scene, options).film;
            const size_t row = size_t(part.width) * 3;
            for (size_t i = 0; i < part.sums.size(); ++i) {
                const size_t line = i / row, replicate = line / size_t(part.height),
                             y = line % size_t(part.height);
                const size_t whole_line = replicate * size_t(whole.height) + y + size_t(window.y0);
                whole.sums[(whole_line * size_t(whole.width) + size_t(window.x0)) * 3 + i % row] +=
                    part.sums[i];
            }
        }
    }
    return whole;
}

void partition(CaseRun& run) {
    Figure& differing = run.figure("sums that differ", 0);
    SceneOfEffects subject(EVERY_EFFECT);
    subject.options.film.size = {37, 29};
    subject.options.sampling.spp = run.count(24, 240, 2400);
    subject.options.sampling.replicates = 8;
    const u32 spp = u32(*subject.options.sampling.spp);
    const Scene scene = subject.load();
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        Options options = subject.options;
        options.device.precision = precision_of(build);
        const Film whole = render_loaded(run.device, scene, options).film;
        const Crop all{0, 0, 37, 29};
        compare_films(differing[build], whole,
                      render_in_parts(run.device, scene, options, {all}, {1, 5, 1, 10, spp - 17}),
                      "five ranges");
        compare_films(differing[build], whole,
                      render_in_parts(run.device, scene, options,
                                      {{0, 0, 13, 29}, {13, 0, 37, 1}, {13, 1, 37, 29}}, {spp}),
                      "three windows");
    }
}

void full_film(CaseRun& run) {
    // All samples at the brightest that a full film holds.
    Figure& error = run.figure("relative error of the mean", 1.2e-7);
    Figure& lost = run.figure("samples that count as overflow", 0);
    FilmBench scale(run.device, std::vector<float>(512, 1.0f), 1);
    const float largest = std::nextafter(float(scale.scale().sustained), 0.0f);
    FilmBench bench(run.device, std::vector<float>(size_t(FULL), largest), 1);
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        const std::vector<float> means = film_mean(bench.film(build));
        for (size_t i = 0; i < means.size(); ++i)
            error[build].see(std::abs(double(means[i]) / double(largest) - 1),
                             [&] { return describe_pixel(i); });
        lost[build].see(double(bench.counts().overflow), [] { return std::string("all pixels"); });
    }
}

/// Addresses of random numbers around the first and the last sample number.
void count_repeated_numbers(Figure& figure, CaseRun& run) {
    KernelProbe probe(run.device, {"numerics/sampler.h"});
    const auto add = [&](const char* name, const char* component) {
        probe.add<u32(u32)>(name, fmt::format("Sampler s = sampler_make(0u, 7u, a % 8u, a / 8u);"
                                              "out = sampler_pair_words(&s, 0u, SAMPLE_FILM).{};",
                                              component));
    };
    add("x", "x");
    add("y", "y");
    std::vector<u32> numbers;
    for (u32 i = 0; i < u32(run.count(1 << 16, 1 << 20, 1 << 24)); ++i) {
        numbers.push_back(i);
        numbers.push_back(UINT32_MAX - 1 - i);
    }
    const std::vector<u32> x = probe.run<u32>("x", numbers), y = probe.run<u32>("y", numbers);
    std::set<std::pair<u32, u32>> met;
    for (size_t i = 0; i < numbers.size(); ++i)
        figure[Build::SINGLE].count(!met.emplace(x[i], y[i]).second,
                                    [&] { return fmt::format("sample {}", numbers[i]); });
}

void last_samples(CaseRun& run) {
    Figure& repeated = run.figure("pairs of random numbers met twice", 0);
    Figure& differing = run.figure("sums that differ in parts", 0);
    Figure& beyond = run.figure("samples beyond the last number", 0);
    count_repeated_numbers(repeated, run);
    SceneOfEffects subject(EVERY_EFFECT);
    Options options = subject.options;
    options.film.size = {16, 8};
    options.sampling.replicates = 8;
    options.sampling.first_sample = UINT32_MAX - 40;
    options.sampling.spp = 40;
    const Scene scene = subject.load();
    const Film whole = render_loaded(run.device, scene, options).film;
    compare_films(differing[Build::SINGLE], whole,
                  render_in_parts(run.device, scene, options, {{0, 0, 16, 8}}, {7, 1, 32}), "ranges");
    options.sampling.spp = 1000;
    const Render refused = render_loaded(run.device, scene, options);
    const std::uint64_t end = refused.film.ranges.back().end;
    beyond[Build::SINGLE].see(end > UINT32_MAX ? double(end - UINT32_MAX) : 0,
                              [&] { return fmt::format("ends at {}", end); });
    compare_films(differing[Build::SINGLE], whole, refused.film, "run that the last number ends");
}

} // namespace

namespace {

ProbeTime time_against(const ProbeDevice& device, SumKind naive, int rounds) {
    return FilmBench(device, noisy_series(1 << 13, 100), 100.5).time_film_against(naive, rounds);
}

} // namespace

ProbeTime time_film_plain(const ProbeDevice& device, int rounds) {
    return time_against(device, SumKind::PLAIN, rounds);
}
ProbeTime time_film_blocks(const ProbeDevice& device, int rounds) {
    return time_against(device, SumKind::BLOCKS, rounds);
}
ProbeTime time_film_double(const ProbeDevice& device, int rounds) {
    return time_against(device, SumKind::DOUBLE, rounds);
}
ProbeTime time_film_guard(const ProbeDevice& device, int rounds) {
    return time_against(device, SumKind::UNGUARDED, rounds);
}

const std::vector<StabilityCase>& film_cases() {
    static const std::vector<StabilityCase> cases = {
        {"A01", "ConstantSum", "a million samples of one value, from 1e-6 to 1e9, in 64 pixels", "the value",
         "rounding a sample to the film's quantum at random leaves a hundredth of an ULP; the picture's "
         "float half an ULP",
         constant_sum},
        {"A02", "NoisyMean", "a million samples of 100 + u, u in (0, 1)", "the same sum in long double",
         "two roundings: the quantum's, 4 standard errors of which are 1e-9, and that of the picture's float",
         noisy_mean},
        {"A03", "NoisyVariance", "the same samples in 8 replicates",
         "variance of the replicates' means in long double",
         "random rounding by a quantum of 1/8192 scatters replicates' means by 4e-4 of what the samples do; "
         "naive is the "
         "variance of one sample from sums of values and squares",
         noisy_variance},
        {"A04", "Partition", "a scene of all effects in five ranges of samples and in three windows",
         "the same render in one run", "sums are integers: no order of samples, windows or launches may show",
         partition},
        {"A06", "LastSamples", "sample numbers up to 2^32 - 2 and runs that would go on",
         "one run; pairs of 64 bits never repeat",
         "numbers of samples have 32 bits; what is beyond is refused, not wrapped", last_samples},
        {"A07", "FullFilm", "as many samples as a replicate holds, all of the largest contribution",
         "the contribution",
         "2^19 contributions below 2^44 quanta stay below 2^63; one rounding to the picture's float",
         full_film},
    };
    return cases;
}

} // namespace clrt
