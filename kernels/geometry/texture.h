// SPDX-License-Identifier: Apache-2.0
// Texture lookup: bilinear, in buffers (images are optional in OpenCL and differ between devices).
#ifndef CLRT_GEOMETRY_TEXTURE_H
#define CLRT_GEOMETRY_TEXTURE_H

#include "scene.h"

#define TEXTURE_LUMINANCE 4u /* Texture.channel of maps read as grey */

/* One texel, linear, as (r, g, b, a). */
static inline float4 texture_texel(const Scene* scene, global const Texture* texture, uint x, uint y)
{
    const uint texel = y * texture->width + x;
    if (texture->format == TEXEL_FLOAT)
        return as_float4(vload4(0, scene->texel_words + texture->first_word + 4u * texel));
    const uint word = scene->texel_words[texture->first_word + texel];
    const uint4 bytes = (uint4)(word & 255u, (word >> 8) & 255u, (word >> 16) & 255u, word >> 24);
    if (texture->format == TEXEL_LINEAR8)
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

/* (r, g, b, a) at uv, where (0, 0) is the lower left corner of the picture; base + gain * value. */
static CLRT_NOINLINE float4 texture_lookup(const Scene* scene, uint index, float2 uv)
{
    global const Texture* texture = scene->textures + index;
    const uint wrap_u = texture->wrap_u;
    const uint wrap_v = texture->wrap_v;
    const float at_u = fma(uv.x, texture->scale_u, fma(uv.y, texture->shear_u, texture->offset_u));
    const float at_v = fma(uv.y, texture->scale_v, fma(uv.x, texture->shear_v, texture->offset_v));
    if (texture_is_outside(at_u, wrap_u) || texture_is_outside(at_v, wrap_v))
        return (float4)(0.0f);
    const float u = texture_inside(at_u, wrap_u);
    const float v = texture_inside(at_v, wrap_v);
    /* Texel centres lie at half-integers; rows go down while v goes up. */
    const float x = u * (float)texture->width - 0.5f;
    const float y = (1.0f - v) * (float)texture->height - 0.5f;
    const int left = texture_floor(x);
    const int top = texture_floor(y);
    const float fx = x - (float)left;
    const float fy = y - (float)top;
    const uint x0 = texture_wrap(left, texture->width, wrap_u);
    const uint y0 = texture_wrap(top, texture->height, wrap_v);
    const uint x1 = texture_wrap(left + 1, texture->width, wrap_u);
    const uint y1 = texture_wrap(top + 1, texture->height, wrap_v);
    const float4 a = texture_texel(scene, texture, x0, y0);
    const float4 b = texture_texel(scene, texture, x1, y0);
    const float4 c = texture_texel(scene, texture, x0, y1);
    const float4 d = texture_texel(scene, texture, x1, y1);
    const float4 upper = a + fx * (b - a);
    const float4 lower = c + fx * (d - c);
    return texture->base + texture->gain * (upper + fy * (lower - upper));
}

/* A colour, not negative; a NaN stays one. */
static inline real3 texture_color(const Scene* scene, uint index, float2 uv)
{
    const real3 color = convert_real3(texture_lookup(scene, index, uv).xyz);
    return color < (real3)(REAL(0.0)) ? (real3)(REAL(0.0)) : color;
}

/* The channel a scalar map asks for. */
static inline real texture_scalar(const Scene* scene, uint index, float2 uv)
{
    const float4 value = texture_lookup(scene, index, uv);
    const uint channel = scene->textures[index].channel;
    if (channel == TEXTURE_LUMINANCE)
        return vector_luminance(convert_real3(value.xyz));
    return (real)(channel == 0u ? value.x : channel == 1u ? value.y : channel == 2u ? value.z : value.w);
}

#endif
