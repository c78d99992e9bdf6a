// SPDX-License-Identifier: Apache-2.0
#include "stability/film_bench.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace clrt {

namespace {

/// A way to add up, as statements on the sample's `value` or `radiance` and the pixel's memory.
struct SumText {
    SumKind kind;
    const char* name;
    const char* words; ///< type of the memory's words
    u32 per_pixel;     ///< words a pixel
    const char* code;
};

const SumText SUM_TEXTS[] = {
    {SumKind::FILM, "film", "long", 3,
     "const uint fault = film_fault(&params, radiance);"
     "if (fault == COUNT_WORDS) film_add(&params, film_sums(&params, film, i, replicate), &sampler, "
     "radiance);"
     "else film_report_fault(counters, fault, i, s);"},
    {SumKind::UNGUARDED, "unguarded", "long", 3,
     "film_add(&params, film_sums(&params, film, i, replicate), &sampler, radiance);"},
    {SumKind::PLAIN, "plain", "real", 3,
     "global real* sums = film + 3u * i;"
     "sums[0] += radiance.x; sums[1] += radiance.y; sums[2] += radiance.z;"},
    {SumKind::SQUARES, "squares", "real", 3,
     "global real* sums = film + 3u * i; sums[0] += radiance.x; sums[1] += radiance.y * radiance.y;"},
    {SumKind::BLOCKS, "blocks", "float", 9,
     "global float* block = film + 9u * i;"
     "block[0] += (float)radiance.x; block[1] += (float)radiance.y; block[2] += (float)radiance.z;"
     "if ((s & 1023u) == 1023u || s + 1u == samples)"
     "    for (uint k = 0; k < 3u; ++k) bench_join(block + k);"},
    {SumKind::DOUBLE, "wide", "BENCH_DOUBLE", 3,
     "global BENCH_DOUBLE* sums = film + 3u * i;"
     "sums[0] += radiance.x; sums[1] += radiance.y; sums[2] += radiance.z;"}};

const SumText& text_of(SumKind kind) {
    return *std::find_if(std::begin(SUM_TEXTS), std::end(SUM_TEXTS),
                         [&](const SumText& t) { return t.kind == kind; });
}

/// Two-sum of a block into the pair behind it (Knuth 1969), and sums of 64 bits where the device has them.
const char* const HELPERS = R"(
#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#define BENCH_DOUBLE double
#else
#define BENCH_DOUBLE float
#endif
static inline void bench_join(global float* block)
{
    const float high = block[3], sum = high + block[0];
    const float part = sum - high;
    block[6] += (high - (sum - part)) + (block[0] - part);
    block[3] = sum;
    block[0] = 0.0f;
}
)";

std::string kernel_text(const SumText& sum) {
    return fmt::format("kernel void bench_{}(const RenderParams params, const u32 count, const u32 samples, "
                       "const u32 end, const u32 stride,\n"
                       "                     global const float* restrict series, global {}* restrict film, "
                       "global volatile uint* counters)\n"
                       "{{\n"
                       "    const uint i = (uint)get_global_id(0);\n"
                       "    if (i >= count) return;\n"
                       "    Sampler sampler = sampler_make(params.seed, i, 0u, 0u);\n"
                       "    const uint first = sampler.word_key;\n"
                       "    uint place = i * stride, replicate = 0u;\n"
                       "    for (uint s = 0; s < samples; ++s) {{\n"
                       "        const real value = (real)series[place];\n"
                       "        const real3 radiance = vector_make(value, value, value);\n"
                       "        sampler.word_key = first + s;\n"
                       "        {}\n"
                       "        place = place + 1u == end ? 0u : place + 1u;\n"
                       "        replicate = replicate + 1u == params.replicates ? 0u : replicate + 1u;\n"
                       "    }}\n"
                       "}}\n",
                       sum.name, sum.words, sum.code);
}

FilmScale scale_of_mean(double mean_radiance) {
    Scene scene;
    scene.extent = 1;
    scene.environment.radiance = glm::dvec3(mean_radiance);
    return film_scale(scene);
}

template <class T>
std::vector<double> widened(const std::vector<T>& values) {
    return std::vector<double>(values.begin(), values.end());
}

} // namespace

KernelProbe& film_bench_probe(const ProbeDevice& device, Build build) {
    const Precision precision = precision_of(build);
    return device.once<KernelProbe>(fmt::format("film bench: {}", int(precision)), [&] {
        KernelProbe made(device, {"film/film.h"}, ProbeOptions{precision, {}});
        made.add_text(HELPERS);
        for (const SumText& sum : SUM_TEXTS)
            made.add_text(kernel_text(sum));
        return made;
    });
}

FilmBench::FilmBench(const ProbeDevice& device, std::vector<float> series, double mean_radiance)
    : device_(device), series_(std::move(series)), series_buffer_(upload_buffer(device, "series", series_)),
      scale_(scale_of_mean(mean_radiance)) {
    if (series_.empty() || series_.size() % (PIXELS * REPLICATES) != 0)
        throw std::logic_error("the series of a FilmBench needs a multiple of 512 values");
}

RenderParams FilmBench::params() const {
    RenderParams params{};
    params.replicates = params.film_replicates = REPLICATES;
    params.tile_count = PIXELS / TILE_PIXELS;
    params.quantum = float(scale_.quantum);
    params.inverse_quantum = float(1 / scale_.quantum);
    params.largest_contribution = float(scale_.largest);
    return params;
}

FilmBench::Bound FilmBench::bind(Build build, SumKind kind, u32 samples) const {
    const SumText& text = text_of(kind);
    const bool is_film = kind == SumKind::FILM || kind == SumKind::UNGUARDED;
    const size_t words = size_t(PIXELS) * text.per_pixel * (is_film ? REPLICATES : 1);
    Bound bound{film_bench_probe(device_, build).kernel(std::string("bench_") + text.name),
                create_buffer(device_, "film", words * sizeof(std::int64_t)),
                create_buffer(device_, "counters", (COUNT_WORDS + 2 * REPLAY_CAPACITY) * sizeof(u32))};
    bound.kernel.set("params", params());
    bound.kernel.set("count", PIXELS);
    bound.kernel.set("samples", samples);
    bound.kernel.set("end", u32(series_.size()));
    bound.kernel.set("stride", u32(series_.size() / PIXELS));
    bound.kernel.set("series", series_buffer_);
    bound.kernel.set("film", bound.film);
    bound.kernel.set("counters", bound.counters);
    return bound;
}

Film FilmBench::film(Build build) {
    KernelProbe& p = film_bench_probe(device_, build);
    const Bound bound = bind(build, SumKind::FILM, u32(series_.size()));
    p.launch(bound.kernel, PIXELS, 1);
    Film film;
    film.width = PIXELS;
    film.height = 1;
    film.replicates = REPLICATES;
    film.scale = scale_;
    film.ranges = {{0, series_.size()}};
    film.sums = p.read<std::int64_t>(bound.film, size_t(PIXELS) * REPLICATES * 3);
    const std::vector<u32> words = p.read<u32>(bound.counters, COUNT_WORDS);
    counts_ = {};
    counts_.nan = words[COUNT_NAN];
    counts_.infinite = words[COUNT_INFINITE];
    counts_.negative = words[COUNT_NEGATIVE];
    counts_.overflow = words[COUNT_OVERFLOW];
    return film;
}

std::vector<double> FilmBench::sums(SumKind kind) {
    KernelProbe& p = film_bench_probe(device_, Build::SINGLE);
    const Bound bound = bind(Build::SINGLE, kind, u32(series_.size()));
    p.launch(bound.kernel, PIXELS, 1);
    const size_t plane = size_t(PIXELS) * 3;
    if (kind == SumKind::DOUBLE && device_.info.fp64)
        return p.read<double>(bound.film, plane);
    if (kind != SumKind::BLOCKS)
        return widened(p.read<float>(bound.film, plane));
    const std::vector<float> words = p.read<float>(bound.film, 3 * plane);
    std::vector<double> sums;
    for (size_t i = 0; i < plane; ++i)
        sums.push_back(double(words[i / 3 * 9 + 3 + i % 3]) + double(words[i / 3 * 9 + 6 + i % 3]));
    return sums;
}

ProbeTime FilmBench::time_film_against(SumKind naive, int rounds) {
    KernelProbe& p = film_bench_probe(device_, Build::SINGLE);
    const auto timed = [&](SumKind kind) {
        const Bound bound = bind(Build::SINGLE, kind, u32(series_.size()));
        return [&p, bound] { p.launch(bound.kernel, PIXELS, 1); };
    };
    return time_in_turns(device_, timed(naive), timed(SumKind::FILM), series_.size() * PIXELS, rounds);
}

std::vector<long double> FilmBench::replicate_means() const {
    std::vector<long double> means(REPLICATES, 0);
    for (size_t s = 0; s < series_.size(); ++s)
        means[s % REPLICATES] += series_[s];
    for (long double& mean : means)
        mean /= (long double)(series_.size() / REPLICATES);
    return means;
}

long double FilmBench::mean() const {
    long double sum = 0;
    for (const long double mean : replicate_means())
        sum += mean / REPLICATES;
    return sum;
}

} // namespace clrt
