// SPDX-License-Identifier: Apache-2.0
// film/film.h and film/tile.h: unbiased rounding, faults by kind, replay list, and pixels of tiles.
#include "kernels/shared/render_types.h"
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "support/test_device.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <set>

using namespace clrt;

namespace {

const char* const TEXT = R"(
kernel void probe_report(const u32 count, global volatile uint* counters, global const u32* faults)
{
    const uint i = (uint)get_global_id(0);
    if (i < count)
        film_report_fault(counters, faults[i], 1000u + i, 5000u + i);
}

kernel void probe_sums(const RenderParams params, const u32 count, global long* film, const u32 replicates)
{
    const uint i = (uint)get_global_id(0);
    if (i < count)
        film_sums(&params, film, i / replicates, i % replicates)[1] += 1;
}

/* Work-item i is pixel i; every channel gets its share of the value. */
kernel void probe_add(const RenderParams params, const u32 count, global long* sums, const u32 samples,
                      const float value)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    for (uint s = 0; s < samples; ++s) {
        const Sampler sampler = sampler_make(0u, i, 0u, s);
        film_add(&params, sums + 3 * i, &sampler, vector_make(value, REAL(0.25) * value, REAL(3.0) * value));
    }
}

kernel void probe_ranges(const RenderParams params, const u32 count, global const u32* pixel_rays, global u32* out)
{
    const uint slot = (uint)get_global_id(0);
    if (slot >= count)
        return;
    const SampleRange range = tile_samples(&params, pixel_rays, slot);
    out[2 * slot] = range.first;
    out[2 * slot + 1] = range.count;
}

kernel void probe_tiles(const RenderParams params, const u32 width, global u32* visits, global u32* slots)
{
    TilePixel pixel;
    if (!tile_pixel(&params, &pixel))
        return;
    atomic_inc(visits + pixel.y * width + pixel.x);
    slots[pixel.y * width + pixel.x] = pixel.slot;
}
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"film/film.h", "film/tile.h"});
        made.add_text(TEXT);
        made.add<u32(vec4, float)>("fault", "RenderParams params; params.largest_contribution = b;"
                                            "out = film_fault(&params, vector_from(a));");
        // The rounded value less the value's floor: 0 or 1.
        made.add<i32(float, u32)>("round", "(i32)(film_round((real)a, b) - convert_long(floor(a)))");
        made.add<u32(u32, u32)>("index_low", "(uint)tile_index(a, b)");
        made.add<u32(u32, u32)>("index_high", "(uint)(tile_index(a, b) >> 32)");
        return made;
    }();
    return instance;
}

template <class T>
cl::Buffer zeros(size_t count) {
    return create_buffer(test_device(), "zeros", count * sizeof(T));
}

/// A window cut into tiles as the host does it.
RenderParams window_params(u32 width, u32 height) {
    RenderParams params{};
    params.crop_width = width;
    params.crop_height = height;
    params.tiles_x = (width + TILE_SIZE - 1) / TILE_SIZE;
    params.tile_count = params.tiles_x * ((height + TILE_SIZE - 1) / TILE_SIZE);
    params.tile_stride = u32(0.618 * params.tile_count) | 1u;
    while (std::gcd(params.tile_stride, params.tile_count) != 1)
        ++params.tile_stride;
    return params;
}

/// Visits the tiles from first to end in rows of `row` work-groups.
void launch_tiles(Kernel& kernel, RenderParams params, u32 first, u32 end, u32 row) {
    params.first_tile = first;
    params.end_tile = end;
    kernel.set("params", params);
    const u32 rows = (end - first + row - 1) / row;
    test_device().queue.enqueueNDRangeKernel(kernel.handle(), cl::NullRange,
                                             cl::NDRange(row * TILE_SIZE, rows * TILE_SIZE),
                                             cl::NDRange(TILE_SIZE, TILE_SIZE));
    test_device().queue.finish();
}

} // namespace

TEST(Film, RoundingIsUnbiased) {
    // 2^16 words that are evenly spread: the mean is the value to half of 2^-16, the lattice to half of
    // 2^-23.
    constexpr size_t WORDS = 65536;
    std::vector<u32> words(WORDS);
    for (size_t i = 0; i < WORDS; ++i)
        words[i] = u32(i << 16) + 0x8000u;
    for (const float quanta :
         {0.0f, 1e-3f, 0.25f, 0.5f, 0.999f, 1.0f, 7.0f, 5.5f, 1000.75f, 65536.25f, 1048576.0f, 1048576.5f,
          4194304.0f, 4194304.5f, 8388607.0f, 16777216.0f, 1e9f}) {
        double above = 0;
        for (const i32 step : probe().run<i32>("round", std::vector<float>(WORDS, quanta), words)) {
            ASSERT_TRUE(step == 0 || step == 1) << quanta;
            above += step;
        }
        EXPECT_NEAR(above / WORDS, double(quanta) - std::floor(double(quanta)), 1.0 / WORDS) << quanta;
    }
}

TEST(Tile, SamplesAreThoseOfTheLaunchOrOfTheTile) {
    RenderParams params = window_params(24, 8); // 3 tiles
    params.first_sample = 40;
    params.sample_count = 5;
    params.replicates = 8;
    const u32 slots = params.tile_count * TILE_PIXELS;
    std::vector<u32> words(slots * PIXEL_RAYS_WORDS, 999);
    words.insert(words.end(), {0, 4, 8, 0, 16, 32});
    const cl::Buffer buffer = upload_buffer(test_device(), "pixel_rays", words);
    for (const bool by_tile : {false, true}) {
        params.dealt_replicates = by_tile ? 4 : 8;
        const cl::Buffer out = zeros<u32>(2 * slots);
        Kernel kernel = probe().kernel("probe_ranges");
        kernel.set("params", params);
        kernel.set("count", slots);
        kernel.set("pixel_rays", buffer);
        kernel.set("out", out);
        probe().launch(kernel, slots);
        const std::vector<u32> got = probe().read<u32>(out, size_t{2} * slots);
        for (u32 slot = 0; slot < slots; ++slot) {
            const u32 expected[3][2] = {{0, 4}, {8, 0}, {16, 32}};
            EXPECT_EQ(got[2 * slot], by_tile ? expected[slot / TILE_PIXELS][0] : 40u);
            EXPECT_EQ(got[2 * slot + 1], by_tile ? expected[slot / TILE_PIXELS][1] : 5u);
        }
    }
}

TEST(Film, SumsOfManySamplesKeepTheValue) {
    // 64 pixels of 4096 samples of a fraction of a quantum, a few quanta and a million: fixed point loses
    // nothing, so the mean is off only by what rounding scatters, at most half a quantum a sample.
    constexpr u32 PIXELS = 64, SAMPLES = 4096;
    RenderParams params{};
    params.inverse_quantum = 1024;
    for (const float value : {0.1f / 1024, 3.3f / 1024, 1000.1f}) {
        Kernel kernel = probe().kernel("probe_add");
        const cl::Buffer sums = zeros<int64_t>(3 * PIXELS);
        kernel.set("params", params);
        kernel.set("count", PIXELS);
        kernel.set("sums", sums);
        kernel.set("samples", SAMPLES);
        kernel.set("value", value);
        probe().launch(kernel, PIXELS);
        double mean[3] = {};
        const std::vector<int64_t> got = probe().read<int64_t>(sums, size_t{3} * PIXELS);
        for (size_t i = 0; i < got.size(); ++i)
            mean[i % 3] += double(got[i]) / 1024 / PIXELS / SAMPLES;
        const double scatter = 6 * 0.5 / 1024 / std::sqrt(double(PIXELS) * SAMPLES);
        EXPECT_NEAR(mean[0], value, scatter);
        EXPECT_NEAR(mean[1], 0.25 * value, scatter);
        EXPECT_NEAR(mean[2], 3 * double(value), scatter + 3 * double(value) * FLOAT_U);
    }
}

TEST(Film, FullSumsStayFull) {
    // 2^59 quanta a sample in red, a quarter of that in green, three times in blue.
    constexpr u32 SAMPLES = 17;
    RenderParams params{};
    params.inverse_quantum = 1;
    Kernel kernel = probe().kernel("probe_add");
    const cl::Buffer sums = zeros<int64_t>(3);
    kernel.set("params", params);
    kernel.set("count", 1u);
    kernel.set("sums", sums);
    kernel.set("samples", SAMPLES);
    kernel.set("value", 0x1p59f);
    probe().launch(kernel, 1);
    const std::vector<int64_t> got = probe().read<int64_t>(sums, 3);
    EXPECT_EQ(got, (std::vector<int64_t>{INT64_MAX, SAMPLES * (int64_t(1) << 57), INT64_MAX}));
}

TEST(Tile, ArraysOfTheLargestPictureAreAddressedInSixtyFourBits) {
    // 65536 x 65536 pixels have 2^32 slots.
    const std::vector<u32> slots = {0, 1, 1431655766, UINT32_MAX};
    for (const u32 words : {u32(PIXEL_RAYS_WORDS), 21u}) {
        const std::vector<u32> many(slots.size(), words);
        const std::vector<u32> low = probe().run<u32>("index_low", slots, many),
                               high = probe().run<u32>("index_high", slots, many);
        for (size_t i = 0; i < slots.size(); ++i)
            EXPECT_EQ(std::uint64_t(high[i]) << 32 | low[i], std::uint64_t(words) * slots[i]);
    }
}

TEST(Film, FaultsAreTheWorstOfAColoursComponents) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    struct Case {
        vec4 radiance;
        u32 fault;
    };
    std::vector<vec4> radiances;
    std::vector<u32> expected;
    for (const Case& c :
         {Case{{0, 0, 0, 0}, COUNT_WORDS}, Case{{1, 100, 5, 0}, COUNT_WORDS},
          Case{{-0.0f, 0, 0, 0}, COUNT_WORDS}, Case{{nan, 1, 1, 0}, COUNT_NAN},
          Case{{1, nan, 1, 0}, COUNT_NAN}, Case{{1, inf, nan, 0}, COUNT_NAN},
          Case{{bits_to_float(0xffc00001u), 0, 0, 0}, COUNT_NAN}, Case{{inf, 1, 1, 0}, COUNT_INFINITE},
          Case{{1, 1, -inf, 0}, COUNT_INFINITE}, Case{{-1, inf, 0, 0}, COUNT_INFINITE},
          Case{{1, -1e-30f, 1, 0}, COUNT_NEGATIVE}, Case{{200, -1, 1, 0}, COUNT_NEGATIVE},
          Case{{1, 1, 100.001f, 0}, COUNT_OVERFLOW}, Case{{3e38f, 1, 1, 0}, COUNT_OVERFLOW}}) {
        radiances.push_back(c.radiance);
        expected.push_back(c.fault);
    }
    EXPECT_EQ(probe().run<u32>("fault", radiances, std::vector<float>(radiances.size(), 100)), expected);
}

TEST(Film, FaultsAreCountedByKindAndTheFirstAreListedForReplay) {
    for (const u32 count : {10u, 1000u}) {
        std::vector<u32> faults(count);
        for (u32 i = 0; i < count; ++i)
            faults[i] = i % 4; // COUNT_NAN .. COUNT_OVERFLOW
        constexpr size_t WORDS = COUNT_WORDS + 2 * REPLAY_CAPACITY + 16;
        const cl::Buffer counters = zeros<u32>(WORDS);
        Kernel kernel = probe().kernel("probe_report");
        kernel.set("count", count);
        kernel.set("counters", counters);
        kernel.set("faults", probe().upload(faults));
        probe().launch(kernel, count);
        const std::vector<u32> got = probe().read<u32>(counters, WORDS);
        for (u32 fault = 0; fault < 4; ++fault)
            EXPECT_EQ(got[fault], u32(std::count(faults.begin(), faults.end(), fault)));
        EXPECT_EQ(got[COUNT_BAD_SAMPLES], count);
        std::set<u32> listed;
        for (size_t slot = 0; slot < std::min<size_t>(count, REPLAY_CAPACITY); ++slot) {
            const u32 pixel = got[COUNT_WORDS + 2 * slot], sample = got[COUNT_WORDS + 2 * slot + 1];
            EXPECT_EQ(sample, pixel + 4000);
            EXPECT_TRUE(pixel >= 1000 && pixel < 1000 + count && listed.insert(pixel).second);
        }
        // Nothing is written behind the list.
        for (size_t i = COUNT_WORDS + 2 * std::min<size_t>(count, REPLAY_CAPACITY); i < WORDS; ++i)
            EXPECT_EQ(got[i], 0u);
    }
}

TEST(Film, EveryPixelAndReplicateHasSumsOfItsOwnAndTheRestAreFolded) {
    RenderParams params = window_params(20, 9);
    params.replicates = 8;
    const u32 slots = params.tile_count * TILE_PIXELS;
    for (const u32 kept : {8u, 4u, 1u}) {
        params.film_replicates = kept;
        const cl::Buffer film = zeros<int64_t>(size_t{3} * slots * kept);
        Kernel kernel = probe().kernel("probe_sums");
        kernel.set("params", params);
        kernel.set("count", slots * 8);
        kernel.set("film", film);
        kernel.set("replicates", 8u);
        // One after the other: folded replicates share sums.
        probe().launch(kernel, slots * 8, kept == 8 ? 64 : 1);
        const std::vector<int64_t> got = probe().read<int64_t>(film, size_t{3} * slots * kept);
        int64_t visits = 0;
        for (size_t i = 0; i < got.size(); ++i) {
            ASSERT_TRUE(got[i] == 0 || i % 3 == 1);
            visits += got[i];
            ASSERT_TRUE(kept != 8 || i % 3 != 1 || got[i] == 1);
        }
        EXPECT_TRUE(kept != 8 || visits == int64_t(slots) * 8);
    }
}

TEST(Tile, EveryPixelOfTheWindowIsVisitedOnceInAnyShapeOfLaunch) {
    struct Window {
        u32 width, height;
    };
    for (const Window& w :
         {Window{1, 1}, Window{8, 8}, Window{9, 7}, Window{100, 75}, Window{17, 129}, Window{640, 3}}) {
        const RenderParams params = window_params(w.width, w.height);
        const size_t pixels = size_t{w.width} * w.height;
        const cl::Buffer visits = zeros<u32>(pixels), slots = zeros<u32>(pixels);
        Kernel kernel = probe().kernel("probe_tiles");
        kernel.set("width", w.width);
        kernel.set("visits", visits);
        kernel.set("slots", slots);
        // In three launches of different rows.
        const u32 third = params.tile_count / 3;
        launch_tiles(kernel, params, 0, third + 1, 1);
        if (third + 1 < params.tile_count)
            launch_tiles(kernel, params, third + 1, params.tile_count - third, 5);
        if (third > 0)
            launch_tiles(kernel, params, params.tile_count - third, params.tile_count, params.tiles_x);
        EXPECT_EQ(probe().read<u32>(visits, pixels), std::vector<u32>(pixels, 1))
            << w.width << " " << w.height;

        const std::vector<u32> places = probe().read<u32>(slots, pixels);
        EXPECT_EQ(std::set<u32>(places.begin(), places.end()).size(), pixels);
        for (u32 y = 0; y < w.height; ++y)
            for (u32 x = 0; x < w.width; ++x) // tile by tile, rows within a tile
                ASSERT_EQ(places[size_t{y} * w.width + x],
                          (y / 8 * params.tiles_x + x / 8) * 64 + y % 8 * 8 + x % 8);
    }
}
