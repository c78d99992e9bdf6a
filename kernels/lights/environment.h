// SPDX-License-Identifier: Apache-2.0
// Light from outside the scene: constant, or a lat-long map with bilinear lookup.
// +Y is up; a direction d reads u = 0.5 + atan2(d.z, d.x) / (2 pi), v = acos(d.y) / pi, v = 0 in the top row.
#ifndef CLRT_LIGHTS_ENVIRONMENT_H
#define CLRT_LIGHTS_ENVIRONMENT_H

#include "geometry/scene.h"
#include "numerics/frame.h"
#include "numerics/halves.h"
#include "numerics/real_functions.h"

/* Turns a world direction into the map's frame. */
static inline real3 environment_to_map(const RenderParams* params, real3 d)
{
    const real c = (real)params->environment_cos;
    const real s = (real)params->environment_sin;
    return vector_make(fma(c, d.x, -(s * d.z)), d.y, fma(s, d.x, c * d.z));
}

static inline real3 environment_to_world(const RenderParams* params, real3 d)
{
    const real c = (real)params->environment_cos;
    const real s = (real)params->environment_sin;
    return vector_make(fma(c, d.x, s * d.z), d.y, fma(-s, d.x, c * d.z));
}

/* Map coordinates of a unit direction in the map's frame, in [0, 1]. The angle from +Y is taken from both its
   sine and its cosine: next to the poles the cosine alone tells rows of a large map no longer apart. */
static inline real2 environment_uv(real3 d)
{
    return (real2)(fma(real_atan2(d.z, d.x), REAL(0.5) * REAL_INVERSE_PI, REAL(0.5)),
                   real_atan2(real_sqrt(fma(d.x, d.x, d.z * d.z)), d.y) * REAL_INVERSE_PI);
}

/* sin of half the angle that this many rows are high. */
static inline real environment_half_sin(const RenderParams* params, real rows)
{
    return real_sin_cos_turn(rows / (REAL(4.0) * (real)params->environment_height)).x;
}

/* Solid angle of one texel of a row. */
static inline real environment_texel_solid_angle(const RenderParams* params, uint row)
{
    /* cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2), with the angles from the nearer pole. */
    const uint from_pole = min(row, params->environment_height - 1u - row);
    const real band = REAL(2.0) * environment_half_sin(params, (real)(2u * from_pole + 1u)) *
                      environment_half_sin(params, REAL(1.0));
    return REAL(2.0) * REAL_PI * band / (real)params->environment_width;
}

/* Tiles in a row of them, and in all. */
static inline uint environment_tiles_across(const RenderParams* params)
{
    return (params->environment_width + (SKY_TILE_SIZE - 1u)) / SKY_TILE_SIZE;
}

static inline uint environment_tile_count(const RenderParams* params)
{
    return environment_tiles_across(params) *
           ((params->environment_height + (SKY_TILE_SIZE - 1u)) / SKY_TILE_SIZE);
}

/* The number of the tile that a texel is in. */
static inline uint environment_tile_at(const RenderParams* params, uint column, uint row)
{
    return row / SKY_TILE_SIZE * environment_tiles_across(params) + column / SKY_TILE_SIZE;
}

/* A colour in scalars: loops over the lanes of vectors take no vectors within. */
typedef struct {
    real red, green, blue;
} SkyColor;

/* Where a texel is among the map's. */
static inline uint environment_texel_number(const RenderParams* params, uint column, uint row)
{
    return environment_tile_at(params, column, row) * SKY_TILE_TEXELS + row % SKY_TILE_SIZE * SKY_TILE_SIZE +
           column % SKY_TILE_SIZE;
}

static inline SkyColor environment_decode_rgbe(uint word)
{
    const float unit = as_float(((word >> 24) - 9u) << 23);
    const SkyColor color = {(real)((float)(word & 255u) * unit), (real)((float)((word >> 8) & 255u) * unit),
                            (real)((float)((word >> 16) & 255u) * unit)};
    return color;
}

/* Radiance of texel i in this format, without the map's factor. */
CLRT_GIVES_STRUCT SkyColor environment_texel(const Scene* scene, uint format, uint i)
{
    if (format == SKY_TEXEL_RGBE)
        return environment_decode_rgbe(scene->sky_texels[i]);
    const size_t first = (size_t)i * 3u;
    if (format == SKY_TEXEL_HALF) {
        global const ushort* stored = (global const ushort*)scene->sky_texels + first;
        const SkyColor color = {(real)binary16_decode(stored[0]), (real)binary16_decode(stored[1]),
                                (real)binary16_decode(stored[2])};
        return color;
    }
    global const float* floats = (global const float*)scene->sky_texels + first;
    const SkyColor color = {(real)floats[0], (real)floats[1], (real)floats[2]};
    return color;
}

static inline real environment_mix(real a, real b, real t) { return a + t * (b - a); }

static inline SkyColor environment_mix_colors(SkyColor a, SkyColor b, real t)
{
    const SkyColor mixed = {environment_mix(a.red, b.red, t), environment_mix(a.green, b.green, t),
                            environment_mix(a.blue, b.blue, t)};
    return mixed;
}

/* Radiance of the map at map coordinates, bilinear; wraps around, ends at the poles. `format`: the map's. */
CLRT_GIVES_STRUCT SkyColor environment_lookup(const Scene* scene, const RenderParams* params, uint format,
                                              real u, real v)
{
    const int width = (int)params->environment_width;
    const int height = (int)params->environment_height;
    const real x = u * (real)width - REAL(0.5);
    const real y = v * (real)height - REAL(0.5);
    const real fx = x - floor(x);
    const real fy = y - floor(y);
    const int column = (int)floor(x);
    const int row = (int)floor(y);
    const int x0 = column < 0 ? column + width : (column >= width ? column - width : column);
    const int x1 = x0 + 1 == width ? 0 : x0 + 1;
    const uint y0 = (uint)min(max(row, 0), height - 1);
    const uint y1 = (uint)min(max(row + 1, 0), height - 1);
    const SkyColor a = environment_texel(scene, format, environment_texel_number(params, (uint)x0, y0));
    const SkyColor b = environment_texel(scene, format, environment_texel_number(params, (uint)x1, y0));
    const SkyColor c = environment_texel(scene, format, environment_texel_number(params, (uint)x0, y1));
    const SkyColor d = environment_texel(scene, format, environment_texel_number(params, (uint)x1, y1));
    return environment_mix_colors(environment_mix_colors(a, b, fx), environment_mix_colors(c, d, fx), fy);
}

static CLRT_NOINLINE real3 environment_map_lookup(const Scene* scene, const RenderParams* params, real2 uv)
{
    const uint format = params->environment_format;
    const SkyColor color = format == SKY_TEXEL_RGBE
                               ? environment_lookup(scene, params, SKY_TEXEL_RGBE, uv.x, uv.y)
                               : environment_lookup(scene, params, format, uv.x, uv.y);
    return vector_make(color.red, color.green, color.blue);
}

static inline bool environment_is_map(const RenderParams* params)
{
    return HAS(EFFECT_ENVIRONMENT_MAP) && params->environment_width != 0u;
}

/* The map coordinates of a world direction; 0 of a constant environment. */
static inline real2 environment_place(const RenderParams* params, real3 wi)
{
    return environment_is_map(params) ? environment_uv(environment_to_map(params, wi)) : (real2)(REAL(0.0));
}

/* Radiance that arrives from a place. */
static inline real3 environment_eval_at(const Scene* scene, const RenderParams* params, real2 place)
{
    const real3 factor = vector_from(params->environment);
    return environment_is_map(params) ? factor * environment_map_lookup(scene, params, place) : factor;
}

/* Radiance that arrives along a ray leaving the scene in direction wi. */
static inline real3 environment_eval(const Scene* scene, const RenderParams* params, real3 wi)
{
    return environment_eval_at(scene, params, environment_place(params, wi));
}

/* The share of a row's texel. */
static inline uint environment_share(uint row_shares, uint column)
{
    return (row_shares >> (8u * column)) & 255u;
}

/* Density of a texel with this share of a tile: it is chosen with its share of the tile's probability, and
   filled evenly. */
static inline real environment_share_pdf_w(const RenderParams* params, global const SkyTile* tile, uint share,
                                           uint row)
{
    return (real)tile->probability * (real)share /
           ((real)SKY_SHARES * environment_texel_solid_angle(params, row));
}

static inline real environment_texel_pdf_w(const Scene* scene, const RenderParams* params, uint column,
                                           uint row)
{
    global const SkyTile* tile = scene->sky_tiles + environment_tile_at(params, column, row);
    const uint share = environment_share(tile->shares[row % SKY_TILE_SIZE], column % SKY_TILE_SIZE);
    return environment_share_pdf_w(params, tile, share, row);
}

/* Density of environment_map_sample for the direction to a place. */
static inline real environment_map_pdf_w_at(const Scene* scene, const RenderParams* params, real2 place)
{
    const uint column =
        min((uint)(place.x * (real)params->environment_width), params->environment_width - 1u);
    const uint row =
        min((uint)(place.y * (real)params->environment_height), params->environment_height - 1u);
    return environment_texel_pdf_w(scene, params, column, row);
}

/* The same for a direction. */
static inline real environment_map_pdf_w(const Scene* scene, const RenderParams* params, real3 wi)
{
    return environment_map_pdf_w_at(scene, params, environment_uv(environment_to_map(params, wi)));
}

#endif
