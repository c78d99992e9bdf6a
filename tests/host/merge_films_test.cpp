// SPDX-License-Identifier: Apache-2.0
// Merged films: any order, folded replicates, gaps, and what is refused.
#include "film/merge_films.h"

#include "error.h"
#include "render/film_picture.h"
#include "support/noise_film.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace clrt {

namespace {

FilmFile part(std::uint32_t first, std::uint64_t samples, int kept = 8, unsigned seed = 0) {
    FilmFile file;
    std::mt19937 random(first + 1);
    file.render.film = empty_film(4, 3, 8, first, samples);
    fill_with_noise(file.render.film, 2, 1, random);
    fold_replicates(file.render.film, kept);
    file.identity = {{"scene", "abc"}, {"seed", seed}, {"window", {0, 0, 4, 3}}, {"size", {4, 3}}};
    file.origin.folder = std::to_string(first);
    file.render.counts.shadow = samples;
    file.render.counts.bad_samples = {{1, first}};
    file.render.seconds = double(samples);
    file.render.history = {{samples, 1, 1, {}}};
    return file;
}

std::string refusal(FilmFile sum, const FilmFile& other) {
    try {
        merge_film(sum, "a.film", other, "b.film");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST(MergeFilms, AnyOrderGivesTheSameFilm) {
    const std::vector<FilmFile> parts = {part(0, 5), part(5, 1), part(6, 10)};
    std::vector<size_t> order = {0, 1, 2};
    std::vector<std::int64_t> expected(film_plane(parts[0].render.film) * 8, 0);
    for (const FilmFile& film : parts)
        std::transform(expected.begin(), expected.end(), film.render.film.sums.begin(), expected.begin(),
                       std::plus<>());
    do {
        FilmFile sum = parts[order[0]];
        for (size_t i = 1; i < 3; ++i)
            merge_film(sum, "a", parts[order[i]], "b");
        EXPECT_EQ(sum.render.film.sums, expected);
        EXPECT_EQ(sum.render.film.ranges, (std::vector<SampleRange>{{0, 16}}));
        EXPECT_EQ(sum.render.counts.shadow, 16u);
        EXPECT_EQ(sum.render.counts.bad_samples,
                  (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, 0}, {1, 5}, {1, 6}}));
        EXPECT_EQ(sum.render.seconds, 16);
        EXPECT_EQ(sum.origin.folder, "0") << "of the first samples";
        EXPECT_TRUE(sum.render.history.empty()) << "parts tell nothing about the whole's slope";
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(MergeFilms, TheSceneIsWhereEitherShowsIt) {
    FilmFile a = part(0, 8), b = part(8, 8);
    a.render.film.shown = {0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
    b.render.film.shown = {0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1};
    FilmFile sum = a;
    merge_film(sum, "a", b, "b");
    EXPECT_EQ(sum.render.film.shown, (std::vector<std::uint8_t>{0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1}));
    b.render.film.shown.clear();
    merge_film(a, "a", b, "b");
    EXPECT_TRUE(a.render.film.shown.empty()) << "one does not know";
}

TEST(MergeFilms, WhatWasCutAddsUp) {
    FilmFile sum = part(0, 4), other = part(4, 4);
    other.render.counts.cut_paths = 3;
    other.render.counts.cut_weight = 7;
    other.bias = {0.5, {{"LpS+DE", "a light", ""}}, {}};
    sum.bias.blind_spots = other.bias.blind_spots;
    merge_film(sum, "a", other, "b");
    EXPECT_EQ(sum.render.counts.cut_paths, 3u);
    EXPECT_EQ(sum.render.counts.cut_weight, 7u);
    EXPECT_EQ(sum.bias.cut_radiance, 0.5) << "the film without cuts does not know it";
    EXPECT_EQ(sum.bias.blind_spots.size(), 1u);
}

TEST(MergeFilms, TheLargestSampleIsThatOfAnyPart) {
    const auto merged = [](std::optional<double> a, std::optional<double> b) {
        FilmFile sum = part(0, 4), other = part(4, 4);
        for (auto& [film, radiance] : {std::pair{&sum, a}, std::pair{&other, b}})
            if (radiance)
                film->bias.hits = HitLight{"LS+DE", *radiance};
        merge_film(sum, "a", other, "b");
        return sum.bias.hits ? sum.bias.hits->radiance : 0;
    };
    EXPECT_EQ(merged(0.05, 1), 1) << "the first is guided";
    EXPECT_EQ(merged(1, 0.05), 1);
    EXPECT_EQ(merged({}, 1), 1);
    EXPECT_EQ(merged(1, {}), 1);
    EXPECT_EQ(merged({}, {}), 0);
}

TEST(MergeFilms, GapsStayGaps) {
    FilmFile sum = part(20, 4);
    merge_film(sum, "a", part(0, 8), "b");
    EXPECT_EQ(sum.render.film.ranges, (std::vector<SampleRange>{{0, 8}, {20, 24}}));
    EXPECT_EQ(film_samples(sum.render.film), 12u);
    merge_film(sum, "a", part(8, 12), "b");
    EXPECT_EQ(sum.render.film.ranges, (std::vector<SampleRange>{{0, 24}}));
}

TEST(MergeFilms, FoldedReplicatesFoldTheOthers) {
    FilmFile sum = part(0, 8);
    const std::vector<float> first = film_mean(sum.render.film);
    merge_film(sum, "a", part(8, 8, 2), "b");
    EXPECT_EQ(sum.render.film.replicates, 2);
    EXPECT_EQ(sum.render.film.sums.size(), 2 * film_plane(sum.render.film));
    const std::vector<float> second = film_mean(part(8, 8).render.film), merged = film_mean(sum.render.film);
    for (size_t i = 0; i < merged.size(); ++i)
        EXPECT_NEAR(merged[i], 0.5f * (first[i] + second[i]), 1e-6f);
}

TEST(MergeFilms, OverlapsAndStrangersAreRefused) {
    const std::string overlap = refusal(part(0, 8), part(7, 4));
    EXPECT_NE(overlap.find("b.film: "), std::string::npos) << overlap;
    EXPECT_NE(overlap.find("samples 7 to 7 in both"), std::string::npos) << overlap;
    EXPECT_NE(refusal(part(4, 2), part(0, 8)).find("samples 4 to 5 in both"), std::string::npos);
    const std::string seed = refusal(part(0, 8), part(8, 4, 8, 1));
    EXPECT_NE(seed.find("another seed: expected 0, found 1"), std::string::npos) << seed;
    FilmFile with_more = part(8, 4);
    with_more.identity["paths"] = "LDE";
    EXPECT_NE(refusal(part(0, 8), with_more).find("another paths: expected none"), std::string::npos);
    EXPECT_NE(refusal(with_more, part(0, 8)).find("found none"), std::string::npos);
}

TEST(MergeFilms, ThePictureHasVarianceAndSamples) {
    const FilmFile film = part(0, 16);
    const Picture picture = film_picture(film);
    EXPECT_EQ(picture.width, 4);
    EXPECT_EQ(picture.full_height, 3);
    ASSERT_EQ(picture.layers.size(), 3u);
    EXPECT_EQ(picture.layers[0].values, film_mean(film.render.film));
    EXPECT_EQ(picture.layers[1].values, film_variance(film.render.film));
    EXPECT_EQ(picture.layers[2].values, std::vector<float>(12, 16.0f));
}

TEST(MergeFilms, AdaptiveFilmsAreRefused) {
    FilmFile adaptive = part(4, 4);
    adaptive.render.film.tile_samples = {std::vector<std::uint32_t>{8}, std::vector<std::uint32_t>{8}};
    EXPECT_NE(refusal(part(0, 4), adaptive).find("b.film: expected a film with adaptive: false"),
              std::string::npos);
    EXPECT_NE(refusal(adaptive, part(0, 4)).find("a.film: expected a film with adaptive: false"),
              std::string::npos);
}

TEST(MergeFilms, AGuideIsOfOnePartAlone) {
    FilmFile guided = part(0, 5);
    guided.render.guide.stage = GuideStage::ON;
    guided.render.guide.guided_from = 2;
    guided.render.guide.guide.emplace();
    for (const bool is_first : {true, false}) {
        FilmFile sum = is_first ? guided : part(5, 5);
        merge_film(sum, "a", is_first ? part(5, 5) : guided, "b");
        EXPECT_EQ(sum.render.film.ranges, (std::vector<SampleRange>{{0, 10}}));
        EXPECT_EQ(sum.render.guide.stage, GuideStage::OFF);
        EXPECT_FALSE(sum.render.guide.guide);
    }
}

TEST(MergeFilms, SumsThatDoNotFitAreRefused) {
    FilmFile a = part(0, 5);
    const FilmFile b = part(5, 5);
    a.render.film.sums.back() = std::numeric_limits<std::int64_t>::max();
    EXPECT_NE(refusal(a, b).find("64 bits"), std::string::npos) << refusal(a, b);
    a.render.film.sums.back() -= b.render.film.sums.back();
    EXPECT_EQ(refusal(a, b), "accepted");
}

} // namespace clrt
