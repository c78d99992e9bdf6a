// SPDX-License-Identifier: Apache-2.0
// Sums over the primary hits: the same bits however the film grows, right for a million samples, and stopped
// by a signal.
#include "render/hit_layers.h"

#include "console/signals.h"
#include "probes/kernel_probe.h"
#include "support/render_scene.h"

#include <algorithm>
#include <csignal>
#include <gtest/gtest.h>
#include <limits>
#include <optional>

namespace clrt {

namespace {

/// A leaf with holes before a floor of another colour, and the sums of layers over films of any samples: the
/// picture itself is not rendered.
class HitLayersTest : public testing::Test {
protected:
    static constexpr std::uint64_t EVERY = std::numeric_limits<std::uint64_t>::max();

    HitLayersTest() {
        test_.texture("leaf.exr", 2, 1, 4, {1, 1, 1, 0.25f, 1, 1, 1, 0.75f});
        test_.build.material("white", "Kd 0.7 0.3 0.1").material("leaf", "Kd 0.2 0.4 0.1\nmap_d leaf.exr");
        test_.build.use("white").floor(4);
        test_.build.use("leaf").textured_quad({{-1, 0.5, 0}, {1, 0.5, 0}, {1, 2, 0.3}, {-1, 2, 0.3}});
        test_.look({0, 1.5, 3}, {0, 0.6, 0}, 45);
        Options& options = test_.options;
        options.film.size = {27, 21}; // tiles at the edges are not whole
        options.sampling.replicates = 4;
        options.output.files = {"a.exr"};
        options.output.aovs = {{"albedo", "cryptoObject"}};
        prepared_.emplace(prepare_loaded(test_device(), test_.load(), options));
        params_ = launch_params(*prepared_->planned);
        film_.width = options.film.size.x;
        film_.height = options.film.size.y;
        film_.replicates = options.sampling.replicates;
    }

    /// Goes through films of these ranges, one after the other.
    HitSums sums(const std::vector<std::vector<SampleRange>>& films, std::uint64_t most_samples = EVERY) {
        HitSums sums;
        sums.most_samples = most_samples;
        FilmBuffers film_buffers(test_device(), params_, 0);
        HitLayers layers(test_device(), *prepared_->programs->layers, params_, false, prepared_->buffers,
                         film_buffers, sums, true);
        for (const std::vector<SampleRange>& ranges : films) {
            film_.ranges = ranges;
            layers.advance(film_, [](double) {});
        }
        return sums;
    }
    /// The same with tiles of these samples, those of the second half one more.
    HitSums tile_sums(const std::vector<u32>& samples, std::uint64_t most_samples = EVERY) {
        HitSums sums;
        sums.most_samples = most_samples;
        FilmBuffers film_buffers(test_device(), params_, 0);
        HitLayers layers(test_device(), *prepared_->programs->layers, params_, true, prepared_->buffers,
                         film_buffers, sums, true);
        film_.ranges = {{0, 1}};
        for (const u32 count : samples) {
            for (u32 half = 0; half < 2; ++half) {
                film_.tile_samples[half].assign(film_tiles(film_), count + half);
                film_.tile_samples[half][1] += 3;
            }
            layers.advance(film_, [](double) {});
        }
        return sums;
    }
    static bool same(const HitSums& a, const HitSums& b) {
        return a.values == b.values && a.words == b.words && a.mattes == b.mattes && a.samples == b.samples &&
               a.tile_samples == b.tile_samples;
    }

    /// Of all materials in a pixel.
    static double coverage(const HitSums& hits, const Film& film, size_t pixel) {
        double sum = 0;
        for (const IndexShare& share : matte_shares(hits, film, pixel, MATTE_MATERIALS))
            sum += share.coverage;
        return sum;
    }

    TestScene test_;
    std::optional<PreparedScene> prepared_;
    RenderParams params_{};
    Film film_;
};

} // namespace

TEST_F(HitLayersTest, GrowWithTheFilmToTheSameBits) {
    const HitSums at_once = sums({{{5, 45}, {60, 70}}});
    EXPECT_EQ(at_once.samples, 50u);
    EXPECT_TRUE(
        same(sums({{{5, 6}}, {{5, 9}}, {{5, 45}}, {{5, 45}, {60, 61}}, {{5, 45}, {60, 70}}}), at_once));
    EXPECT_FALSE(same(sums({{{5, 45}, {61, 71}}}), at_once)) << "other samples must show";
    const HitSums tiles = tile_sums({50});
    EXPECT_TRUE(same(tile_sums({2, 4, 18, 50}), tiles));
    EXPECT_FALSE(same(tile_sums({51}), tiles));
}

TEST_F(HitLayersTest, EndWithTheSamplesThatAreEnough) {
    EXPECT_TRUE(
        same(sums({{{5, 9}}, {{5, 15}, {60, 70}}, {{5, 15}, {60, 99}}}, 16), sums({{{5, 15}, {60, 66}}})));
    EXPECT_TRUE(has_all_samples(sums({{{5, 45}}}, 16), film_));
    const Film many_samples = film_;
    EXPECT_FALSE(has_all_samples(sums({{{5, 9}}}, 16), many_samples));
    const HitSums tiles = tile_sums({2, 5, 50}, 16);
    EXPECT_TRUE(has_all_samples(tiles, film_));
    for (const std::vector<u32>& half : tiles.tile_samples)
        EXPECT_TRUE(std::all_of(half.begin(), half.end(), [](u32 samples) { return samples == 8; }));
}

TEST_F(HitLayersTest, BothHalvesTogetherAreTheReplicatesOfAFilm) {
    // The halves hold replicates 0, 1 and 2, 3: 8 samples of each are samples 0 to 15.
    const HitSums whole = sums({{{0, 16}}});
    HitSums halves;
    FilmBuffers film_buffers(test_device(), params_, 0);
    HitLayers layers(test_device(), *prepared_->programs->layers, params_, true, prepared_->buffers,
                     film_buffers, halves, true);
    for (size_t half = 0; half < 2; ++half)
        film_.tile_samples[half].assign(film_tiles(film_), 8);
    layers.advance(film_, [](double) {});
    for (size_t i = 0; i < whole.values[0].size(); ++i)
        ASSERT_EQ(halves.values[0][i] + halves.values[1][i], whole.values[0][i]);
    film_.ranges = {{0, 16}};
    Film equal = film_;
    equal.tile_samples = {};
    int edges = 0;
    for (size_t pixel = 0; pixel < film_plane(film_) / 3; ++pixel) {
        const PixelHits a = pixel_hits(halves, film_, pixel), b = pixel_hits(whole, equal, pixel);
        ASSERT_NEAR(a.share, b.share, 1e-15);
        ASSERT_NEAR(a.mean(AOV_ALBEDO).x, b.mean(AOV_ALBEDO).x, 1e-14);
        ASSERT_NEAR(a.mean(AOV_POSITION).z, b.mean(AOV_POSITION).z, 1e-14);
        ASSERT_NEAR(coverage(halves, film_, pixel), a.share, 1e-15) << "all have slots";
        ASSERT_NEAR(coverage(whole, equal, pixel), b.share, 1e-15);
        edges += matte_shares(whole, equal, pixel, MATTE_MATERIALS).size() == 2;
    }
    EXPECT_GT(edges, 10) << "leaf and floor";
}

TEST_F(HitLayersTest, SumsOfManySamplesLoseNothing) {
    // All hit the floor at the picture's bottom: its albedo is a constant.
    const u32 samples = 100003;
    params_.crop_y = params_.crop_height - 1;
    params_.crop_height = 1;
    params_.tile_count = params_.tiles_x;
    params_.tile_stride = 1;
    film_.height = 1;
    const HitSums hits = sums({{{0, samples}}});
    const PixelHits middle = pixel_hits(hits, film_, 13);
    EXPECT_EQ(middle.share, 1);
    EXPECT_EQ(float(middle.mean(AOV_ALBEDO).x), 0.7f);
    EXPECT_EQ(float(middle.mean(AOV_ALBEDO).z), 0.1f);
    EXPECT_EQ(middle.mean(AOV_NORMAL), glm::dvec3(0, 1, 0));
}

TEST_F(HitLayersTest, ASignalEndsWhatTakesLong) {
    catch_stop_signals();
    std::raise(SIGINT);
    const std::uint64_t all = 1u << 30;
    std::vector<double> reported;
    HitSums hits;
    FilmBuffers film_buffers(test_device(), params_, 0);
    HitLayers layers(test_device(), *prepared_->programs->layers, params_, false, prepared_->buffers,
                     film_buffers, hits, true);
    film_.ranges = {{0, all}};
    layers.advance(film_, [&](double share) { reported.push_back(share); });
    EXPECT_GT(hits.samples, 0u) << "a whole pass at least";
    EXPECT_LT(hits.samples, all / 2);
    EXPECT_EQ(reported, std::vector<double>{double(hits.samples) / double(all)});
    EXPECT_EQ(pixel_hits(hits, film_, film_plane(film_) / 3 - 1).share, 1) << "of the samples that are there";
}

} // namespace clrt
