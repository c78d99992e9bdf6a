// SPDX-License-Identifier: Apache-2.0
#include "scene/texture_levels.h"

#include "colour.h"
#include "float_bits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

bool is_grey_format(u32 format) {
    return format == TEXEL_GREY_SRGB8 || format == TEXEL_GREY_LINEAR8;
}

bool is_srgb_format(u32 format) {
    return format == TEXEL_SRGB8 || format == TEXEL_GREY_SRGB8;
}

/// The byte whose value on the curve, which grows, is nearest.
u32 nearest_on_curve(float value, const u32* curve) {
    u32 low = 0, high = 255;
    while (low < high) { // the first that is not below
        const u32 middle = (low + high) / 2;
        if (float_of_bits(curve[middle]) < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low > 0 && value - float_of_bits(curve[low - 1]) < float_of_bits(curve[low]) - value ? low - 1
                                                                                                : low;
}

u32 linear_byte(float value) {
    return u32(std::lround(std::clamp(value, 0.f, 1.f) * 255.f));
}

/// Stores texel i; words of bytes are 0 before.
void encode_texel(u32 format, const vec4& texel, size_t i, const u32* curve, u32* words) {
    if (format == TEXEL_FLOAT) {
        const float values[4] = {texel.x, texel.y, texel.z, texel.w};
        for (size_t c = 0; c < 4; ++c)
            words[4 * i + c] = float_bits(values[c]);
        return;
    }
    const auto byte = [&](float value) {
        return is_srgb_format(format) ? nearest_on_curve(value, curve) : linear_byte(value);
    };
    if (is_grey_format(format))
        words[i / 4] |= byte(texel.x) << (i % 4 * 8);
    else
        words[i] = byte(texel.x) | byte(texel.y) << 8 | byte(texel.z) << 16 | linear_byte(texel.w) << 24;
}

/// What a texel of a smaller row takes of a larger one: [begin, end) in texels of that.
struct Cover {
    size_t first, count;
    double before, after; ///< of the first and the last, how much is not covered

    double share(size_t k) const { return 1 - (k == 0 ? before : 0) - (k + 1 == count ? after : 0); }
};

Cover cover_of(u32 i, u32 smaller, u32 larger) {
    const std::uint64_t begin = std::uint64_t(i) * larger, end = begin + larger; // over `smaller`
    const std::uint64_t first = begin / smaller, last = (end + smaller - 1) / smaller;
    return {size_t(first), size_t(last - first), double(begin - first * smaller) / smaller,
            double(last * smaller - end) / smaller};
}

} // namespace

size_t texel_words(u32 format, size_t texels) {
    return format == TEXEL_FLOAT ? 4 * texels : is_grey_format(format) ? (texels + 3) / 4 : texels;
}

vec4 decode_texel(u32 format, const u32* words, size_t i, const u32* curve) {
    if (format == TEXEL_FLOAT) {
        const u32* word = words + 4 * i;
        return {float_of_bits(word[0]), float_of_bits(word[1]), float_of_bits(word[2]),
                float_of_bits(word[3])};
    }
    const auto value = [&](u32 byte) {
        return is_srgb_format(format) ? float_of_bits(curve[byte]) : float(byte) / 255.f;
    };
    if (is_grey_format(format)) {
        const float grey = value(words[i / 4] >> (i % 4 * 8) & 0xff);
        return {grey, grey, grey, 1};
    }
    const u32 word = words[i];
    return {value(word & 0xff), value(word >> 8 & 0xff), value(word >> 16 & 0xff), float(word >> 24) / 255.f};
}

void halve_values(const float* values, u32 width, u32 height, u32 channels, float* half) {
    const u32 half_width = half_size(width), half_height = half_size(height);
    tbb::parallel_for(0u, half_height, [&](u32 y) {
        const Cover rows = cover_of(y, half_height, height);
        for (u32 x = 0; x < half_width; ++x) {
            const Cover columns = cover_of(x, half_width, width);
            std::array<double, 4> sum{};
            double all = 0;
            for (size_t j = 0; j < rows.count; ++j)
                for (size_t i = 0; i < columns.count; ++i) {
                    const float* texel = values + ((rows.first + j) * width + columns.first + i) * channels;
                    const double share = rows.share(j) * columns.share(i);
                    for (size_t c = 0; c < channels; ++c)
                        sum[c] += share * double(texel[c]);
                    all += share;
                }
            for (size_t c = 0; c < channels; ++c)
                half[(size_t(y) * half_width + x) * channels + c] = float(sum[c] / all);
        }
    });
}

TexelRows halve_picture(const TexelRows& picture) {
    TexelRows half{half_size(picture.width), half_size(picture.height), {}};
    half.texels.resize(size_t(half.width) * half.height);
    halve_values(&picture.texels[0].x, picture.width, picture.height, 4, &half.texels[0].x);
    return half;
}

void append_levels(u32 format, u32 width, u32 height, std::vector<u32>& words) {
    const size_t texels = size_t(width) * height, own = words.size() - texel_words(format, texels);
    TexelRows level{width, height, std::vector<vec4>(texels)};
    tbb::parallel_for(size_t(0), texels, [&](size_t i) {
        level.texels[i] = decode_texel(format, &words[own], i, words.data());
    });
    while (level.texels.size() > 1) {
        level = halve_picture(level);
        const size_t first = words.size();
        words.resize(first + texel_words(format, level.texels.size()), 0);
        // Four at a time, which may share a word.
        tbb::parallel_for(size_t(0), (level.texels.size() + 3) / 4, [&](size_t four) {
            for (size_t i = 4 * four; i < std::min(4 * four + 4, level.texels.size()); ++i)
                encode_texel(format, level.texels[i], i, words.data(), &words[first]);
        });
    }
}

} // namespace clrt
