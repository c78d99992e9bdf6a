// SPDX-License-Identifier: Apache-2.0
// Smaller levels of a picture: means that stay, sizes, and rounding to bytes.
#include "scene/texture_levels.h"

#include "colour.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

using namespace clrt;

namespace {

std::vector<u32> srgb_curve() {
    std::vector<u32> words(256);
    for (u32 i = 0; i < 256; ++i) {
        const auto value = float(srgb_to_linear(i / 255.0));
        std::memcpy(&words[i], &value, sizeof value);
    }
    return words;
}

/// The curve, then random texels of a picture in a format.
std::vector<u32> random_words(u32 format, u32 width, u32 height) {
    std::mt19937 random(format + width);
    std::vector<u32> words = srgb_curve();
    const size_t first = words.size();
    words.resize(first + texel_words(format, size_t(width) * height));
    for (size_t i = first; i < words.size(); ++i) {
        words[i] = u32(random());
        if (format == TEXEL_FLOAT) {
            const auto value = float(words[i]) / 65536;
            std::memcpy(&words[i], &value, sizeof value);
        }
    }
    return words;
}

double mean_red(u32 format, const std::vector<u32>& words, size_t first, size_t texels) {
    double sum = 0;
    for (size_t i = 0; i < texels; ++i)
        sum += double(decode_texel(format, &words[first], i, words.data()).x);
    return sum / double(texels);
}

} // namespace

TEST(TextureLevels, HalvesKeepTheMeanOfPicturesOfAnySize) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (const u32 width : {1u, 2u, 5u, 8u, 13u})
        for (const u32 height : {1u, 3u, 6u}) {
            TexelRows picture{width, height, {}};
            double before = 0, after = 0;
            for (u32 i = 0; i < width * height; ++i) {
                picture.texels.push_back({uniform(random), 2, 0.25f, 1});
                before += double(picture.texels.back().x);
            }
            const TexelRows half = halve_picture(picture);
            EXPECT_EQ(half.width, std::max(width / 2, 1u));
            EXPECT_EQ(half.height, std::max(height / 2, 1u));
            for (const vec4& texel : half.texels) {
                after += double(texel.x);
                EXPECT_TRUE(texel.y == 2 && texel.z == 0.25f && texel.w == 1) << "an even channel stays";
            }
            EXPECT_NEAR(after / (half.width * half.height), before / (width * height), 1e-6)
                << width << "x" << height;
        }
}

TEST(TextureLevels, TexelsOfAPowerOfTwoAreMeansOfFour) {
    const TexelRows half = halve_picture({2, 2, {{1, 0, 0, 1}, {0, 4, 0, 1}, {0, 0, 8, 1}, {0, 0, 0, 0}}});
    ASSERT_EQ(half.texels.size(), 1u);
    EXPECT_TRUE(half.texels[0].x == 0.25f && half.texels[0].y == 1 && half.texels[0].z == 2 &&
                half.texels[0].w == 0.75f);
}

TEST(TextureLevels, EveryLevelHasTheMeanOfThePictureUpToItsRounding) {
    constexpr u32 WIDTH = 37, HEIGHT = 16;
    for (const u32 format : {TEXEL_SRGB8, TEXEL_LINEAR8, TEXEL_FLOAT, TEXEL_GREY_SRGB8, TEXEL_GREY_LINEAR8}) {
        std::vector<u32> words = random_words(format, WIDTH, HEIGHT);
        append_levels(format, WIDTH, HEIGHT, words);
        const double mean = mean_red(format, words, 256, WIDTH * HEIGHT);
        u32 width = WIDTH, height = HEIGHT;
        size_t first = 256;
        while (width * height > 1) {
            first += texel_words(format, size_t(width) * height);
            width = std::max(width / 2, 1u);
            height = std::max(height / 2, 1u);
            // Half a byte for the one texel, less for the mean of many; an sRGB byte is 0.009 at most.
            const double rounding = format == TEXEL_FLOAT ? 1e-6 * mean : 0.0045 / std::sqrt(width * height);
            EXPECT_NEAR(mean_red(format, words, first, size_t(width) * height), mean, 2 * rounding)
                << format << ": " << width << "x" << height;
        }
        EXPECT_EQ(words.size(), first + texel_words(format, 1)) << "down to one texel";
    }
}

TEST(TextureLevels, GreyTexelsTakeAByte) {
    EXPECT_EQ(texel_words(TEXEL_GREY_SRGB8, 1024), 256u);
    EXPECT_EQ(texel_words(TEXEL_GREY_LINEAR8, 5), 2u);
    EXPECT_EQ(texel_words(TEXEL_SRGB8, 5), 5u);
    EXPECT_EQ(texel_words(TEXEL_FLOAT, 5), 20u);
}
