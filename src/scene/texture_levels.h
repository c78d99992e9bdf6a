// SPDX-License-Identifier: Apache-2.0
// A picture's texels as words, and the smaller levels of it over which lookups are filtered.
#pragma once

#include "kernels/shared/scene_types.h"

#include <cstddef>
#include <vector>

namespace clrt {

/// Texture::channel of maps of which alpha is read, or the luminance.
constexpr u32 CHANNEL_ALPHA = 3, CHANNEL_LUMINANCE = 4;

/// Words that so many texels take in a format (TEXEL_*), but for TEXEL_VERTEX.
size_t texel_words(u32 format, size_t texels);

/// Linear r, g, b, a of texel i of words in a format, as kernels decode it; `curve` begins with the sRGB
/// curve.
vec4 decode_texel(u32 format, const u32* words, size_t i, const u32* curve);

/// The size of the next smaller level along an axis.
inline u32 half_size(u32 size) {
    return size > 1 ? size / 2 : 1;
}

/// Means over the areas that texels of half the size take of a larger picture, parts of texels counted by
/// their share; each texel has so many channels, at most 4, one after the other.
void halve_values(const float* values, u32 width, u32 height, u32 channels, float* half);

/// A picture of linear texels, rows from the top.
struct TexelRows {
    u32 width = 0, height = 0;
    std::vector<vec4> texels;
};

/// Half the size, rounded down, at least 1: each texel by halve_values. The mean of the picture stays.
TexelRows halve_picture(const TexelRows& picture);

/// Appends the levels of a picture below itself, down to one texel, to `words`, in its format; those of 8
/// bits are rounded to the nearest. The picture's own words are the last of `words`.
void append_levels(u32 format, u32 width, u32 height, std::vector<u32>& words);

} // namespace clrt
