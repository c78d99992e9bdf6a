// SPDX-License-Identifier: Apache-2.0
// Texture lookup: bilinear, in buffers (images are optional in OpenCL and differ between devices).
#ifndef CLRT_GEOMETRY_TEXTURE_H
#define CLRT_GEOMETRY_TEXTURE_H

#include "uv.h"

#define TEXTURE_LUMINANCE 4u /* Texture.channel of maps read as grey */

/* A picture or one of its smaller levels. */
typedef struct {
    uint first_word, width, height;
} TextureLevel;

/* One texel, linear, as (r, g, b, a). */
static inline float4 texture_texel(const Scene* scene, uint format, const TextureLevel* level, uint x, uint y)
{
    const uint texel = y * level->width + x;
    global const uint* words = scene->texel_words + level->first_word;
    if (format == TEXEL_FLOAT)
        return as_float4(vload4(0, words + 4u * texel));
    if (format >= TEXEL_GREY_SRGB8) {
        const uint byte = (words[texel / 4u] >> (8u * (texel % 4u))) & 255u;
        const float grey =
            format == TEXEL_GREY_SRGB8 ? as_float(scene->texel_words[byte]) : (float)byte / 255.0f;
        return (float4)(grey, grey, grey, 1.0f);
    }
    const uint word = words[texel];
    const uint4 bytes = (uint4)(word & 255u, (word >> 8) & 255u, (word >> 16) & 255u, word >> 24);
    if (format == TEXEL_LINEAR8)
        return convert_float4(bytes) / 255.0f;
    /* The first 256 words are the sRGB curve. */
    return (float4)(as_float(scene->texel_words[bytes.x]), as_float(scene->texel_words[bytes.y]),
                    as_float(scene->texel_words[bytes.z]), (float)bytes.w / 255.0f);
}

/* The floor of a texel coordinate, which fits an int: conversions are one instruction each, floor() may be a
   function. */
static inline int texture_floor(float x)
{
    const int whole = (int)x;
    return whole - ((float)whole > x ? 1 : 0);
}

/* Where in the picture, from 0 to 1, a coordinate reads; one that is not finite reads the corner texel. */
static inline float texture_inside(float t, uint wrap)
{
    if (!real_is_finite((real)t))
        return 0.0f;
    if (wrap == WRAP_REPEAT)
        return t - floor(t);
    if (wrap == WRAP_MIRROR) {
        const float pair = t - 2.0f * floor(0.5f * t);
        return pair > 1.0f ? 2.0f - pair : pair;
    }
    return fmin(fmax(t, 0.0f), 1.0f);
}

/* Wraps a texel coordinate that is at most one picture off. */
static inline uint texture_wrap(int i, uint size, uint wrap)
{
    const int n = (int)size;
    if (wrap != WRAP_REPEAT) /* beside a mirrored picture lies its own edge */
        return (uint)clamp(i, 0, n - 1);
    return (uint)(i < 0 ? i + n : (i >= n ? i - n : i));
}

/* True where the lookup is beside a picture that has black around it. */
static inline bool texture_is_outside(float t, uint wrap)
{
    return wrap == WRAP_BLACK && !(t >= 0.0f && t <= 1.0f);
}

/* (r, g, b, a) of a level at u, v within the picture, v upward. */
static inline float4 texture_bilinear(const Scene* scene, global const Texture* texture,
                                      const TextureLevel* level, float u, float v)
{
    /* Texel centres lie at half-integers; rows go down while v goes up. */
    const float x = u * (float)level->width - 0.5f;
    const float y = (1.0f - v) * (float)level->height - 0.5f;
    const int left = texture_floor(x);
    const int top = texture_floor(y);
    const float fx = x - (float)left;
    const float fy = y - (float)top;
    const uint x0 = texture_wrap(left, level->width, texture->wrap_u);
    const uint y0 = texture_wrap(top, level->height, texture->wrap_v);
    const uint x1 = texture_wrap(left + 1, level->width, texture->wrap_u);
    const uint y1 = texture_wrap(top + 1, level->height, texture->wrap_v);
    const uint format = texture->format;
    const float4 a = texture_texel(scene, format, level, x0, y0);
    const float4 b = texture_texel(scene, format, level, x1, y0);
    const float4 c = texture_texel(scene, format, level, x0, y1);
    const float4 d = texture_texel(scene, format, level, x1, y1);
    const float4 upper = a + fx * (b - a);
    const float4 lower = c + fx * (d - c);
    return upper + fy * (lower - upper);
}

/* The next smaller level; the last is its own. */
static inline void texture_descend(uint format, TextureLevel* level)
{
    const uint texels = level->width * level->height;
    if (texels == 1u)
        return;
    level->first_word += format == TEXEL_FLOAT        ? 4u * texels
                         : format >= TEXEL_GREY_SRGB8 ? (texels + 3u) / 4u
                                                      : texels;
    level->width = max(level->width / 2u, 1u);
    level->height = max(level->height / 2u, 1u);
}

/* log2 of the footprint's side in texels, not below 0, of its area in texels: exact for powers of 2, linear
   between them, at most 0.043 too small. */
static inline float texture_level_of(float texels)
{
    return texels > 1.0f ? (float)(as_int(texels) - as_int(1.0f)) * 0x1p-24f : 0.0f;
}

/* (r, g, b, a) at u, v within the picture over a footprint of this many texels: trilinear (Williams 1983). */
static CLRT_NOINLINE float4 texture_filtered(const Scene* scene, global const Texture* texture, float u,
                                             float v, float texels)
{
    const float at = texture_level_of(texels);
    const uint whole = (uint)at;
    TextureLevel level = {texture->first_word, texture->width, texture->height};
    for (uint i = 0; i < whole; ++i)
        texture_descend(texture->format, &level);
    const float4 finer = texture_bilinear(scene, texture, &level, u, v);
    texture_descend(texture->format, &level);
    const float4 coarser = texture_bilinear(scene, texture, &level, u, v);
    return finer + (at - (float)whole) * (coarser - finer);
}

/* (r, g, b, a) at uv, where (0, 0) is the lower left corner of the picture; base + gain * value. `uv_area`:
   of the footprint over which it is filtered, 0 where it is not. */
static CLRT_NOINLINE float4 texture_lookup(const Scene* scene, uint index, Uv uv, UvArea uv_area)
{
    global const Texture* texture = scene->textures + index;
    const float2 at = uv_of(texture, uv);
    const uint wrap_u = texture->wrap_u;
    const uint wrap_v = texture->wrap_v;
    const float at_u = fma(at.x, texture->scale_u, fma(at.y, texture->shear_u, texture->offset_u));
    const float at_v = fma(at.y, texture->scale_v, fma(at.x, texture->shear_v, texture->offset_v));
    if (texture_is_outside(at_u, wrap_u) || texture_is_outside(at_v, wrap_v))
        return (float4)(0.0f);
    const float u = texture_inside(at_u, wrap_u);
    const float v = texture_inside(at_v, wrap_v);
    if (HAS(EFFECT_TEXTURE_FILTER)) {
        const float turned = texture->scale_u * texture->scale_v - texture->shear_u * texture->shear_v;
        const float texels = uv_area_of(texture, uv_area) * fabs(turned) * (float)texture->width *
                             (float)texture->height;
        if (texels > 1.0f)
            return texture->base + texture->gain * texture_filtered(scene, texture, u, v, texels);
    }
    const TextureLevel level = {texture->first_word, texture->width, texture->height};
    return texture->base + texture->gain * texture_bilinear(scene, texture, &level, u, v);
}

/* A colour, not negative; a NaN stays one. */
static inline real3 texture_color(const Scene* scene, uint index, Uv uv, UvArea uv_area)
{
    const float4 value = texture_lookup(scene, index, uv, uv_area);
    const uint flags = scene->textures[index].channel;
    real3 color = flags & TEXTURE_WHITE ? (real3)(REAL(1.0)) : convert_real3(value.xyz);
    if (flags & TEXTURE_TIMES_ALPHA)
        color *= (real)value.w;
    return color < (real3)(REAL(0.0)) ? (real3)(REAL(0.0)) : color;
}

/* The channel a scalar map asks for. */
static inline real texture_scalar(const Scene* scene, uint index, Uv uv, UvArea uv_area)
{
    const float4 value = texture_lookup(scene, index, uv, uv_area);
    const uint channel = TEXTURE_CHANNEL(scene->textures[index]);
    if (channel == TEXTURE_LUMINANCE)
        return vector_luminance(convert_real3(value.xyz));
    return (real)(channel == 0u ? value.x : channel == 1u ? value.y : channel == 2u ? value.z : value.w);
}

#endif
