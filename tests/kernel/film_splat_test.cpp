// SPDX-License-Identifier: Apache-2.0
// film/sum.h and film/splat.h: thousands of work-items add to few sums, by atomics of 64 bits and of two
// words; splats of the same samples are the gathered picture; windows; bad splats.
#include "film/film_buffers.h"
#include "kernels/shared/render_types.h"
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "support/test_device.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <numeric>

using namespace clrt;

namespace {

const char* const TEXT = R"(
/* Work-item i adds its number to sum i mod sums; `refused` counts what finds its sum full. */
kernel void probe_shared(global long* sums, const u32 sum_count, global const long* quanta, const u32 count,
                         global uint* refused)
{
    const uint i = (uint)get_global_id(0);
    if (i < count && !sum_add_shared(sums + i % sum_count, quanta[i]))
        atomic_inc(refused);
}

/* A sample of pixel (x, y): a position within it, in 1024ths of a pixel, and any radiance. */
typedef struct {
    Sampler sampler;
    real2 position;
    real3 radiance;
} Probe;

static inline Probe probe_sample(const RenderParams* params, uint x, uint y, uint s)
{
    Probe probe;
    probe.sampler = sampler_make(params->seed, y * params->width + x, s % params->replicates, s / params->replicates);
    const uint2 words = sampler_pair_words(&probe.sampler, 0u, SAMPLE_FILM);
    const real2 within = (real2)((real)(words.x >> 22), (real)(words.y >> 22)) / REAL(1024.0);
    probe.position = (real2)((real)x, (real)y) + within;
    probe.position -= (real2)((real)params->width, (real)params->height) / REAL(2.0);
    probe.radiance.x = sampler_number(&probe.sampler, 1u, SAMPLE_ROULETTE);
    probe.radiance.y = REAL(1e6) * sampler_number(&probe.sampler, 2u, SAMPLE_ROULETTE);
    probe.radiance.z = (words.x & 3u) == 0u ? REAL(3e4) : REAL(0.0);
    return probe;
}

/* Every pixel of the window adds its own samples. */
kernel void probe_gather(const RenderParams params, const u32 count, global long* film, const u32 samples)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const uint x = i % params.crop_width, y = i / params.crop_width;
    const uint tile = y / TILE_SIZE * params.tiles_x + x / TILE_SIZE;
    const uint slot = tile * TILE_PIXELS + y % TILE_SIZE * TILE_SIZE + x % TILE_SIZE;
    for (uint s = 0; s < samples; ++s) {
        const Probe probe = probe_sample(&params, params.crop_x + x, params.crop_y + y, s);
        film_add(&params, film_sums(&params, film, slot, s % params.replicates), &probe.sampler, probe.radiance);
    }
}

/* Work-item i splats one sample, of any pixel of the whole picture. */
kernel void probe_splat(const RenderParams params, const u32 count, global long* film, const u32 stride,
                        global uint* bad)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const uint address = (uint)(((ulong)i * stride) % count);
    const uint pixels = params.width * params.height;
    const uint pixel = address % pixels, s = address / pixels;
    const Probe probe = probe_sample(&params, pixel % params.width, pixel / params.width, s);
    if (film_splat(&params, film, s % params.replicates, &probe.sampler, 0u, probe.position, probe.radiance) != COUNT_WORDS)
        atomic_inc(bad);
}

/* One sample splats the same radiance to one pixel, each time under another number. */
kernel void probe_numbers(const RenderParams params, const u32 count, global long* film, const float value)
{
    const uint i = (uint)get_global_id(0);
    const Sampler sampler = sampler_make(7u, 0u, 0u, 0u);
    if (i < count)
        film_splat(&params, film, 0u, &sampler, i, (real2)(REAL(0.0)), (real3)(value));
}

kernel void probe_fault(const RenderParams params, const u32 count, global long* film, global const float4* splats,
                        global const float2* positions, global uint* faults)
{
    const uint i = (uint)get_global_id(0);
    const Sampler sampler = sampler_make(0u, 0u, 0u, i);
    if (i < count)
        faults[i] = film_splat(&params, film, 0u, &sampler, 1u, convert_real2(positions[i]), vector_from(splats[i]));
}

kernel void probe_slots(const RenderParams params, const u32 count, global const float2* positions, global uint* slots)
{
    const uint i = (uint)get_global_id(0);
    uint slot;
    if (i < count)
        slots[i] = tile_slot_at(&params, convert_real2(positions[i]), &slot) ? slot : UINT_MAX;
}
)";

/// The ways of adding that the device has: by two words everywhere.
std::vector<bool> atomics_of_device() {
    return test_device().info.int64_atomics ? std::vector<bool>{false, true} : std::vector<bool>{false};
}

/// The kernels for gathering only, or for splats by one of the two atomics.
KernelProbe& probe(bool splats, bool int64 = false) {
    static std::map<std::pair<bool, bool>, KernelProbe> probes;
    const auto found = probes.find({splats, int64});
    if (found != probes.end())
        return found->second;
    DeviceInfo info = test_device().info;
    info.int64_atomics = int64;
    ProbeOptions options;
    options.defines = film_defines(info, splats ? FilmAccess::SPLAT : FilmAccess::GATHER);
    options.defines.emplace_back("convert_real2=convert_float2");
    KernelProbe made(test_device(), {"film/splat.h"}, options);
    made.add_text(TEXT);
    return probes.emplace(std::pair(splats, int64), std::move(made)).first->second;
}

template <class T>
cl::Buffer zeros(size_t count) {
    return create_buffer(test_device(), "zeros", count * sizeof(T));
}

/// What a launch leaves: the sums' bits, and how many work-items were refused.
struct Added {
    std::vector<std::int64_t> sums;
    u32 refused = 0;
};

Added add_shared(const std::vector<std::int64_t>& quanta, u32 sums, bool int64, size_t local_size) {
    KernelProbe& p = probe(true, int64);
    const cl::Buffer buffer = zeros<std::int64_t>(sums), refused = zeros<u32>(1);
    Kernel kernel = p.kernel("probe_shared");
    kernel.set("sums", buffer);
    kernel.set("sum_count", sums);
    kernel.set("quanta", p.upload(quanta));
    kernel.set("count", u32(quanta.size()));
    kernel.set("refused", refused);
    p.launch(kernel, quanta.size(), local_size);
    return {p.read<std::int64_t>(buffer, sums), p.read<u32>(refused, 1)[0]};
}

/// A window of a picture, cut into tiles as the host does it; sums keep thousandths of 1.
RenderParams window_params(u32 width, u32 height, u32 x0, u32 y0, u32 x1, u32 y1) {
    RenderParams params{};
    params.width = width;
    params.height = height;
    params.crop_x = x0;
    params.crop_y = y0;
    params.crop_width = x1 - x0;
    params.crop_height = y1 - y0;
    params.tiles_x = (params.crop_width + TILE_SIZE - 1) / TILE_SIZE;
    params.tile_count = params.tiles_x * ((params.crop_height + TILE_SIZE - 1) / TILE_SIZE);
    params.replicates = params.film_replicates = params.dealt_replicates = 4;
    params.quantum = 1.0f / 1024;
    params.inverse_quantum = 1024;
    params.largest_contribution = 1e7f;
    return params;
}

/// The film of a window, empty.
RenderProgress empty_film(const RenderParams& params) {
    RenderProgress progress;
    progress.film.width = int(params.crop_width);
    progress.film.height = int(params.crop_height);
    progress.film.replicates = int(params.film_replicates);
    return progress;
}

/// The sums of a kernel's film, by way of the host's buffers, whose order is that of rows.
template <class Bind>
std::vector<std::int64_t> film_of(KernelProbe& p, const std::string& name, const RenderParams& params,
                                  u32 count, size_t local_size, Bind&& bind, int launches = 1) {
    const FilmBuffers buffers(test_device(), params, 0);
    Kernel kernel = p.kernel(name);
    buffers.bind_sums(kernel);
    kernel.set("params", params);
    kernel.set("count", count);
    bind(kernel);
    for (int launch = 0; launch < launches; ++launch)
        p.launch(kernel, count, local_size);
    RenderProgress progress = empty_film(params);
    buffers.read_sums(progress);
    return progress.film.sums;
}

std::vector<std::int64_t> gathered(const RenderParams& params, u32 samples) {
    return film_of(probe(false), "probe_gather", params, params.crop_width * params.crop_height, 64,
                   [&](Kernel& kernel) { kernel.set("samples", samples); });
}

std::vector<std::int64_t> splatted(const RenderParams& params, u32 samples, bool int64, size_t local_size,
                                   u32 stride) {
    const cl::Buffer bad = zeros<u32>(1);
    KernelProbe& p = probe(true, int64);
    std::vector<std::int64_t> sums = film_of(p, "probe_splat", params, params.width * params.height * samples,
                                             local_size, [&](Kernel& kernel) {
                                                 kernel.set("stride", stride);
                                                 kernel.set("bad", bad);
                                             });
    EXPECT_EQ(p.read<u32>(bad, 1)[0], 0u);
    return sums;
}

} // namespace

TEST(FilmSum, ThousandsOfWorkItemsAddExactlyInAnyOrder) {
    // Low words are near 2^32, so that nearly every addition carries; high words are few.
    constexpr u32 COUNT = 1u << 16, SUMS = 5;
    Random random(1);
    std::vector<std::int64_t> quanta(COUNT);
    for (std::int64_t& q : quanta)
        q = std::int64_t(random.word() % 1000) << 32 | (random.word() | 0xf0000000u);
    std::vector<std::int64_t> expected(SUMS), of_low_words(SUMS);
    for (u32 i = 0; i < COUNT; ++i) {
        expected[i % SUMS] += quanta[i];
        of_low_words[i % SUMS] += quanta[i] & 0xffffffff;
    }
    for (const std::int64_t sum : of_low_words)
        ASSERT_GT(sum >> 32, COUNT / SUMS * 9 / 10) << "carries";
    std::vector<std::int64_t> reversed = quanta; // whole groups of sums, so that each gets what it had
    reversed.resize(COUNT / SUMS * SUMS);
    std::vector<std::int64_t> of_whole(SUMS);
    for (u32 i = 0; i < reversed.size(); ++i)
        of_whole[i % SUMS] += reversed[i];
    for (size_t group = 0; 2 * group < reversed.size() / SUMS; ++group)
        for (u32 k = 0; k < SUMS; ++k)
            std::swap(reversed[group * SUMS + k], reversed[reversed.size() - (group + 1) * SUMS + k]);
    for (const bool int64 : atomics_of_device()) {
        for (const size_t local_size : {1, 32, 64, 256}) {
            const Added added = add_shared(quanta, SUMS, int64, local_size);
            EXPECT_EQ(added.sums, expected) << "int64 " << int64 << ", local size " << local_size;
            EXPECT_EQ(added.refused, 0u);
        }
        EXPECT_EQ(add_shared(reversed, SUMS, int64, 64).sums, of_whole) << "int64 " << int64;
    }
}

TEST(FilmSum, IsFullFromTwoToThe63OnAndSaysSo) {
    // 2^63 in steps of 2^51 or 2^60; the last 1 carries into the sign.
    for (const bool int64 : atomics_of_device())
        for (const auto& [step, steps] :
             {std::pair(std::int64_t(1) << 51, 4096u), {std::int64_t(1) << 60, 8u}}) {
            std::vector<std::int64_t> quanta(steps - 1, step);
            Added added = add_shared(quanta, 1, int64, 8);
            EXPECT_EQ(added.sums[0], INT64_MAX - step + 1);
            EXPECT_EQ(added.refused, 0u);
            quanta.push_back(step - 1);
            added = add_shared(quanta, 1, int64, 8);
            EXPECT_EQ(added.sums[0], INT64_MAX) << "as much as fits";
            EXPECT_EQ(added.refused, 0u);
            quanta.push_back(1);
            added = add_shared(quanta, 1, int64, 8);
            EXPECT_LT(added.sums[0], 0) << "full";
            EXPECT_GE(added.refused, 1u);
            quanta.assign(steps + steps / 2, step); // half as much again: no sum of them wraps
            added = add_shared(quanta, 1, int64, 8);
            EXPECT_LT(added.sums[0], 0) << "stays full";
            EXPECT_EQ(added.refused, steps / 2 + 1) << "whoever comes later";
        }
}

TEST(FilmSplat, SplatsOfTheSameSamplesAreTheGatheredFilmToTheBit) {
    constexpr u32 SAMPLES = 12;
    struct Window {
        u32 x0, y0, x1, y1;
    };
    for (const Window& w : {Window{0, 0, 45, 27}, Window{13, 5, 31, 26}, Window{44, 26, 45, 27}}) {
        const RenderParams params = window_params(45, 27, w.x0, w.y0, w.x1, w.y1);
        const std::vector<std::int64_t> expected = gathered(params, SAMPLES);
        EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 1 << 28);
        for (const bool int64 : atomics_of_device())
            for (const auto& [local_size, stride] : {std::pair<size_t, u32>{1, 1}, {64, 7919}, {256, 104729}})
                EXPECT_EQ(splatted(params, SAMPLES, int64, local_size, stride), expected)
                    << "int64 " << int64 << ", local size " << local_size;
    }
}

TEST(FilmSplat, FoldedReplicatesShareSums) {
    RenderParams params = window_params(45, 27, 0, 0, 45, 27);
    params.film_replicates = 1;
    const std::vector<std::int64_t> expected = gathered(params, 8);
    for (const bool int64 : atomics_of_device())
        EXPECT_EQ(splatted(params, 8, int64, 64, 7919), expected);
}

TEST(FilmSplat, FullSumsAreReadAsTheLargest) {
    RenderParams params = window_params(1, 1, 0, 0, 1, 1);
    params.inverse_quantum = 1;
    params.largest_contribution = 0x1p60f;
    // Five splats at a time: however many are full already, what is under way does not fill the sum again.
    for (const bool int64 : atomics_of_device())
        for (const int launches : {3, 4, 7, 20}) {
            const std::vector<std::int64_t> sums = film_of(
                probe(true, int64), "probe_numbers", params, 5, 1,
                [](Kernel& kernel) { kernel.set("value", 0x1p59f); }, launches);
            const std::int64_t expected = launches < 4 ? std::int64_t(15) << 59 : INT64_MAX;
            EXPECT_EQ(sums[0], expected) << launches << " launches, int64 " << int64;
        }
}

TEST(FilmSplat, EverySplatOfASampleIsRoundedByANumberOfItsOwn) {
    // Of 4096 splats of 0.3 quanta each, three of ten become 1: 1229 by a standard deviation of 29.
    const RenderParams params = window_params(1, 1, 0, 0, 1, 1);
    const std::vector<std::int64_t> sums = film_of(probe(true), "probe_numbers", params, 4096, 64,
                                                   [](Kernel& kernel) { kernel.set("value", 0.3f / 1024); });
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(double(sums[channel]), 0.3 * 4096, 6 * 29);
}

TEST(FilmSplat, PositionsFindTheirPixelAndNothingOutsideOfTheWindow) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (const RenderParams& params : {window_params(20, 9, 0, 0, 20, 9), window_params(21, 10, 3, 2, 20, 9),
                                       window_params(1, 1, 0, 0, 1, 1)}) {
        std::vector<float> positions; // pairs
        std::vector<u32> expected;
        for (int y = -3; y < int(params.height) + 3; ++y)
            for (int x = -3; x < int(params.width) + 3; ++x)
                for (const float within : {0.0f, 0.5f, 0.875f}) {
                    positions.push_back(float(x) + within - 0.5f * float(params.width));
                    positions.push_back(float(y) + within - 0.5f * float(params.height));
                    const u32 column = u32(x) - params.crop_x, row = u32(y) - params.crop_y;
                    const bool is_inside = column < params.crop_width && row < params.crop_height;
                    expected.push_back(is_inside ? (row / 8 * params.tiles_x + column / 8) * 64 +
                                                       row % 8 * 8 + column % 8
                                                 : UINT32_MAX);
                }
        for (const float far : {1e9f, -1e9f, 5e9f, 1e30f, inf, -inf, nan})
            for (const auto& [x, y] : {std::pair(far, 0.0f), {0.0f, far}, {far, far}}) {
                positions.insert(positions.end(), {x, y});
                expected.push_back(UINT32_MAX);
            }
        KernelProbe& p = probe(true);
        const cl::Buffer slots = zeros<u32>(expected.size());
        Kernel kernel = p.kernel("probe_slots");
        kernel.set("params", params);
        kernel.set("count", u32(expected.size()));
        kernel.set("positions", p.upload(positions));
        kernel.set("slots", slots);
        p.launch(kernel, expected.size());
        EXPECT_EQ(p.read<u32>(slots, expected.size()), expected);
    }
}

TEST(FilmSplat, BadSplatsAreToldByKindAndLeftOutAndThoseOutsideAreNobodysFault) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    struct Case {
        vec4 radiance;
        float x, y;
        u32 fault;
    };
    const std::vector<Case> cases = {
        {{1, 2, 3, 0}, 0, 0, COUNT_WORDS},       {{nan, 2, 3, 0}, 0, 0, COUNT_NAN},
        {{1, inf, 3, 0}, 0, 0, COUNT_INFINITE},  {{1, 2, -3, 0}, 0, 0, COUNT_NEGATIVE},
        {{1, 2, 3e7f, 0}, 0, 0, COUNT_OVERFLOW}, {{1, 2, 3, 0}, nan, 0, COUNT_NAN},
        {{1, 2, 3, 0}, 0, nan, COUNT_NAN},       {{1, 2, 3, 0}, inf, 0, COUNT_WORDS},
        {{nan, 2, 3, 0}, 100, 0, COUNT_WORDS},   {{1, 2, 3e7f, 0}, 0, -5, COUNT_WORDS}};
    std::vector<vec4> splats;
    std::vector<float> positions;
    std::vector<u32> expected;
    for (const Case& c : cases) {
        splats.push_back(c.radiance);
        positions.insert(positions.end(), {c.x, c.y});
        expected.push_back(c.fault);
    }
    const RenderParams params = window_params(9, 9, 0, 0, 9, 9);
    KernelProbe& p = probe(true);
    const cl::Buffer faults = zeros<u32>(cases.size());
    const std::vector<std::int64_t> sums =
        film_of(p, "probe_fault", params, u32(cases.size()), 1, [&](Kernel& kernel) {
            kernel.set("splats", p.upload(splats));
            kernel.set("positions", p.upload(positions));
            kernel.set("faults", faults);
        });
    EXPECT_EQ(p.read<u32>(faults, cases.size()), expected);
    std::vector<std::int64_t> only(sums.size());
    const size_t centre = 3 * (4 * 9 + 4);
    only[centre] = 1024;
    only[centre + 1] = 2048;
    only[centre + 2] = 3072;
    EXPECT_EQ(sums, only);
}
