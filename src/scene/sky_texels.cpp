// SPDX-License-Identifier: Apache-2.0
#include "scene/sky_texels.h"
#include "half_float.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

float largest_channel(const glm::vec3& c) {
    return std::max({c.x, c.y, c.z});
}

/// The exponent byte of a texel: its largest channel is a byte of 128 to 255 times 2^(e - 136).
int rgbe_exponent(const glm::vec3& c) {
    return c == glm::vec3(0) ? 10 : std::ilogb(largest_channel(c)) + 129;
}

/// Exact where the result is: 2^(136 - e) times a channel.
glm::dvec3 rgbe_bytes(const glm::vec3& c) {
    return glm::dvec3(c) * std::ldexp(1.0, 136 - rgbe_exponent(c));
}

bool fits_rgbe(const glm::vec3& c) {
    const int e = rgbe_exponent(c);
    const glm::dvec3 bytes = rgbe_bytes(c);
    return e >= 10 && e <= 255 && bytes == glm::dvec3(glm::uvec3(bytes)) && bytes.x < 256 && bytes.y < 256 &&
           bytes.z < 256;
}

u32 to_rgbe(const glm::vec3& c) {
    const glm::dvec3 bytes = rgbe_bytes(c);
    return u32(bytes.x) | u32(bytes.y) << 8 | u32(bytes.z) << 16 | u32(rgbe_exponent(c)) << 24;
}

bool fits_half(const glm::vec3& c) {
    for (int i = 0; i < 3; ++i)
        if (!(c[i] <= LARGEST_HALF && from_half(to_half(c[i])) == c[i]))
            return false;
    return true;
}

bool all_rows(const EnvironmentImage& image, bool (*fits)(const glm::vec3&)) {
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, image.texels.size(), size_t(1) << 14), true,
        [&](const tbb::blocked_range<size_t>& range, bool so_far) {
            return so_far && std::all_of(image.texels.begin() + std::ptrdiff_t(range.begin()),
                                         image.texels.begin() + std::ptrdiff_t(range.end()), fits);
        },
        [](bool a, bool b) { return a && b; });
}

u32 form_of(const EnvironmentImage& image, size_t most_exact) {
    if (all_rows(image, fits_rgbe))
        return SKY_TEXEL_RGBE;
    if (image.texels.size() > most_exact || all_rows(image, fits_half))
        return SKY_TEXEL_HALF;
    return SKY_TEXEL_FLOAT;
}

/// The number of a texel in the order in which they are stored.
size_t texel_place(const Environment& sky, int x, int y) {
    const size_t tile = size_t(y / SKY_TILE) * size_t(sky_tiles(sky.width)) + size_t(x / SKY_TILE);
    return tile * SKY_TILE_TEXELS + size_t(y % SKY_TILE * SKY_TILE + x % SKY_TILE);
}

size_t words_of_texels(u32 format, size_t texels) {
    return format == SKY_TEXEL_RGBE ? texels : format == SKY_TEXEL_HALF ? texels / 2 * 3 : texels * 3;
}

void store_texel(const glm::vec3& c, size_t place, Environment& sky) {
    if (sky.texel_format == SKY_TEXEL_RGBE) {
        sky.texels[place] = to_rgbe(c);
        return;
    }
    for (size_t i = 0; i < 3; ++i) {
        const float channel = c[int(i)];
        if (sky.texel_format == SKY_TEXEL_FLOAT)
            sky.texels[3 * place + i] = float_bits(channel);
        else // the lower half of a word first, on every device there is
            sky.texels[(3 * place + i) / 2] |= to_half(channel) << ((3 * place + i) % 2 * 16);
    }
}

} // namespace

int sky_tiles(int texels) {
    return (texels + SKY_TILE - 1) / SKY_TILE;
}

double store_sky_texels(const EnvironmentImage& image, Environment& sky, size_t most_exact) {
    sky.width = image.width;
    sky.height = image.height;
    sky.texel_format = form_of(image, most_exact);
    float factor = 1;
    if (sky.texel_format == SKY_TEXEL_HALF && !all_rows(image, fits_half)) {
        float largest = 0;
        for (const glm::vec3& texel : image.texels)
            largest = std::max(largest, largest_channel(texel));
        factor = std::ldexp(1.f, std::ilogb(largest) - 14);
    }
    const int rows = sky_tiles(sky.height);
    const size_t texels = size_t(sky_tiles(sky.width)) * size_t(rows) * SKY_TILE_TEXELS;
    sky.texels.assign(words_of_texels(sky.texel_format, texels), 0);
    tbb::parallel_for(0, rows, [&](int tile_row) {
        const int end = std::min((tile_row + 1) * SKY_TILE, sky.height);
        for (int y = tile_row * SKY_TILE; y < end; ++y)
            for (int x = 0; x < sky.width; ++x)
                store_texel(image.texels[size_t(y) * size_t(sky.width) + size_t(x)] / factor,
                            texel_place(sky, x, y), sky);
    });
    return double(factor);
}

glm::vec3 sky_texel(const Environment& sky, int x, int y) {
    const size_t place = texel_place(sky, x, y);
    if (sky.texel_format == SKY_TEXEL_RGBE) {
        const u32 word = sky.texels[place];
        return glm::vec3(float(word & 255), float(word >> 8 & 255), float(word >> 16 & 255)) *
               float_of_bits(((word >> 24) - 9) << 23);
    }
    const auto channel = [&](size_t i) {
        return sky.texel_format == SKY_TEXEL_FLOAT ? float_of_bits(sky.texels[i])
                                                   : from_half(sky.texels[i / 2] >> (i % 2 * 16) & 0xffff);
    };
    return {channel(3 * place), channel(3 * place + 1), channel(3 * place + 2)};
}

double largest_sky_texel(const Environment& sky) {
    float largest = 0;
    for (int y = 0; y < sky.height; ++y)
        for (int x = 0; x < sky.width; ++x)
            largest = std::max(largest, largest_channel(sky_texel(sky, x, y)));
    return double(largest);
}

} // namespace clrt
