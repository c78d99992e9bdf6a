// SPDX-License-Identifier: Apache-2.0
// Light from outside the scene: constant, or a lat-long map with bilinear lookup that is sampled by texels.
// +Y is up; a direction d reads u = 0.5 + atan2(d.z, d.x) / (2 pi), v = acos(d.y) / pi, v = 0 in the top row.
#ifndef CLRT_LIGHTS_ENVIRONMENT_H
#define CLRT_LIGHTS_ENVIRONMENT_H

#include "light_sample.h"
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

/* Radiance of a texel, without the map's factor. */
static inline real3 environment_texel(const Scene* scene, const RenderParams* params, int column, int row)
{
    const uint within = (uint)row % SKY_TILE_SIZE * SKY_TILE_SIZE + (uint)column % SKY_TILE_SIZE;
    const uint i = environment_tile_at(params, (uint)column, (uint)row) * SKY_TILE_TEXELS + within;
    if (params->environment_format == SKY_TEXEL_RGBE) {
        const uint word = scene->sky_texels[i];
        const uint3 bytes = (uint3)(word & 255u, (word >> 8) & 255u, (word >> 16) & 255u);
        return convert_real3(convert_float3(bytes) * as_float(((word >> 24) - 9u) << 23));
    }
    if (params->environment_format == SKY_TEXEL_HALF)
        return halves_load(i, (global const ushort*)scene->sky_texels);
    return convert_real3(vload3(i, (global const float*)scene->sky_texels));
}

/* Radiance of the map at map coordinates, bilinear; wraps around, ends at the poles. */
static CLRT_NOINLINE real3 environment_map_lookup(const Scene* scene, const RenderParams* params, real2 uv)
{
    const int width = (int)params->environment_width;
    const int height = (int)params->environment_height;
    const real x = uv.x * (real)width - REAL(0.5);
    const real y = uv.y * (real)height - REAL(0.5);
    const real fx = x - floor(x);
    const real fy = y - floor(y);
    const int column = (int)floor(x);
    const int row = (int)floor(y);
    const int x0 = column < 0 ? column + width : (column >= width ? column - width : column);
    const int x1 = x0 + 1 == width ? 0 : x0 + 1;
    const int y0 = clamp(row, 0, height - 1);
    const int y1 = clamp(row + 1, 0, height - 1);
    const real3 a = environment_texel(scene, params, x0, y0);
    const real3 b = environment_texel(scene, params, x1, y0);
    const real3 c = environment_texel(scene, params, x0, y1);
    const real3 d = environment_texel(scene, params, x1, y1);
    return vector_mix(vector_mix(a, b, fx), vector_mix(c, d, fx), fy);
}

/* Radiance that arrives along a ray leaving the scene in direction wi. */
static inline real3 environment_eval(const Scene* scene, const RenderParams* params, real3 wi)
{
    const real3 factor = vector_from(params->environment);
    if (!HAS(EFFECT_ENVIRONMENT_MAP) || params->environment_width == 0u)
        return factor;
    return factor * environment_map_lookup(scene, params, environment_uv(environment_to_map(params, wi)));
}

/* The slot of the alias table that a word stands for. */
static inline uint environment_slot(const RenderParams* params, uint word)
{
    return warp_index(word, environment_tile_count(params));
}

/* The tile that a slot and another word choose. */
static inline uint environment_tile(const Scene* scene, uint slot, uint alias_word)
{
    return alias_word < scene->sky_tiles[slot].threshold ? slot : scene->sky_tiles[slot].alias;
}

/* True where light sampling may look at a map's texels. */
static inline bool environment_is_searched(const RenderParams* params)
{
    return HAS(EFFECT_ENVIRONMENT_MAP) && params->choose_environment > 0.0f &&
           params->environment_width != 0u;
}

/* Of a pair of words, the one that chooses the texel: the tree spends the first on the choice of the
   light. */
static inline uint environment_word(const RenderParams* params, uint2 words)
{
    return HAS(EFFECT_LIGHT_TREE) && LIGHT_TREE_IS_USED(*params) != 0.0f ? words.y : words.x;
}

/* Starts to load the tile that environment_map_sample will choose for these words, and its texels. A map is
   larger than caches are, and these are all over it. environment_prefetch_slot comes first: by the time of
   the second call the slot has arrived. */
static inline void environment_prefetch_slot(const Scene* scene, const RenderParams* params, uint2 words)
{
    if (environment_is_searched(params))
        CLRT_PREFETCH(scene->sky_tiles + environment_slot(params, environment_word(params, words)));
}

static inline void environment_prefetch_texel(const Scene* scene, const RenderParams* params, uint2 words,
                                              uint alias_word)
{
    if (!environment_is_searched(params))
        return;
    const uint slot = environment_slot(params, environment_word(params, words));
    const uint tile = environment_tile(scene, slot, alias_word);
    const ulong bytes = SKY_TILE_TEXELS * (params->environment_format == SKY_TEXEL_RGBE   ? 4u
                                           : params->environment_format == SKY_TEXEL_HALF ? 6u
                                                                                          : 12u);
    const ulong texels = (ulong)scene->sky_texels + bytes * tile;
    CLRT_PREFETCH(scene->sky_tiles + tile);
    CLRT_PREFETCH(texels);
    CLRT_PREFETCH(texels + bytes / 2u);
    CLRT_PREFETCH(texels + bytes - 1u);
}

/* The share of a row's texel. */
static inline uint environment_share(uint row_shares, uint column)
{
    return (row_shares >> (8u * column)) & 255u;
}

static inline uint environment_pick(uint4 of, uint place)
{
    return place == 0u ? of.x : place == 1u ? of.y : place == 2u ? of.z : of.w;
}

/* Chooses among four shares, not all 0, by a number in [0, 1): returns the place of one that is not 0, and in
   *u how far the number is between the ends of its share. A number below 1 times the sum of the shares stays
   below the sum when it is rounded. */
static inline uint environment_choose_share(uint4 shares, real* u)
{
    const uint3 ends = (uint3)(shares.x, shares.x + shares.y, shares.x + shares.y + shares.z);
    const real at = *u * (real)(ends.z + shares.w);
    const uint place =
        (at >= (real)ends.x ? 1u : 0u) + (at >= (real)ends.y ? 1u : 0u) + (at >= (real)ends.z ? 1u : 0u);
    const uint begin = place == 0u ? 0u : place == 1u ? ends.x : place == 2u ? ends.y : ends.z;
    *u = (at - (real)begin) / (real)environment_pick(shares, place);
    return place;
}

/* Density of a texel of a tile: it is chosen with its share of the tile's probability, and filled evenly. */
static inline real environment_texel_pdf_w(const Scene* scene, const RenderParams* params, uint column,
                                           uint row)
{
    global const SkyTile* tile = scene->sky_tiles + environment_tile_at(params, column, row);
    const uint share = environment_share(tile->shares[row % SKY_TILE_SIZE], column % SKY_TILE_SIZE);
    return (real)tile->probability * (real)share /
           ((real)SKY_SHARES * environment_texel_solid_angle(params, row));
}

/* Chooses a texel by the table, in *row and *column, and the place u within it. */
static inline real2 environment_choose_texel(const Scene* scene, const RenderParams* params, uint word,
                                             uint alias_word, real v, uint* column, uint* row)
{
    const uint across = environment_tiles_across(params);
    const uint tile = environment_tile(scene, environment_slot(params, word), alias_word);
    const uint4 shares = vload4(0, scene->sky_tiles[tile].shares);
    real across_u = warp_rest(word, environment_tile_count(params), alias_word);
    real down_u = v;
    /* The sum of a word's bytes, which fits one, comes out on top of this product. */
    const uint below = environment_choose_share((shares * 0x01010101u) >> 24, &down_u);
    const uint of_row = environment_pick(shares, below);
    const uint4 of_texels = (uint4)(of_row & 255u, (of_row >> 8) & 255u, (of_row >> 16) & 255u, of_row >> 24);
    const uint beside = environment_choose_share(of_texels, &across_u);
    *row = tile / across * SKY_TILE_SIZE + below;
    *column = tile % across * SKY_TILE_SIZE + beside;
    return (real2)(across_u, down_u);
}

/* Chooses a texel and a direction uniformly within it. */
static inline LightSample environment_map_sample(const Scene* scene, const RenderParams* params, uint word,
                                                 uint alias_word, real v)
{
    const uint width = params->environment_width;
    uint row, column;
    const real2 u = environment_choose_texel(scene, params, word, alias_word, v, &column, &row);
    /* 1 - cos is uniform between the row's edges, measured from the nearer pole: so no digits are lost next
       to it. */
    const bool upper = 2u * row < params->environment_height;
    const uint from_pole = upper ? row : params->environment_height - 1u - row;
    const real inner = environment_half_sin(params, (real)from_pole);
    const real outer = environment_half_sin(params, (real)(from_pole + 1u));
    const real h = REAL(2.0) * fma(u.y, (outer - inner) * (outer + inner), inner * inner);
    const real r = real_root(h * (REAL(2.0) - h));
    const real y = upper ? REAL(1.0) - h : h - REAL(1.0);
    const real map_u = ((real)column + u.x) / (real)width;
    /* u = 0.5 + phi / (2 pi): phi = 0 lies in the middle of the map. */
    const real2 sc = real_sin_cos_turn(map_u < REAL(0.5) ? map_u + REAL(0.5) : map_u - REAL(0.5));
    const real3 d = vector_make(r * sc.y, y, r * sc.x);
    LightSample sample = light_sample_none();
    sample.wi = environment_to_world(params, d);
    sample.pdf_w = environment_texel_pdf_w(scene, params, column, row);
    sample.radiance =
        vector_from(params->environment) *
        environment_map_lookup(scene, params, (real2)(map_u, real_atan2(r, y) * REAL_INVERSE_PI));
    sample.is_delta = false;
    return sample;
}

/* One direction to the environment for a surface: the map's by its alias table, the constant's by the cosine
   around the shading normal n. `word` and v as in emitter_sample. */
static CLRT_NOINLINE LightSample environment_sample(const Scene* scene, const RenderParams* params, real3 n,
                                                    uint word, uint alias_word, real v)
{
    if (HAS(EFFECT_ENVIRONMENT_MAP) && params->environment_width != 0u)
        return environment_map_sample(scene, params, word, alias_word, v);
    const Frame frame = frame_make(n);
    const real3 d = warp_cosine_hemisphere((real2)(sampler_unit(word), v));
    LightSample sample = light_sample_none();
    sample.wi = frame_to_world(&frame, d);
    sample.pdf_w = warp_cosine_hemisphere_pdf_w(d.z);
    sample.radiance = vector_from(params->environment);
    sample.is_delta = false;
    return sample;
}

/* Density of environment_map_sample for a direction. */
static inline real environment_map_pdf_w(const Scene* scene, const RenderParams* params, real3 wi)
{
    const real2 uv = environment_uv(environment_to_map(params, wi));
    const uint column = min((uint)(uv.x * (real)params->environment_width), params->environment_width - 1u);
    const uint row = min((uint)(uv.y * (real)params->environment_height), params->environment_height - 1u);
    return environment_texel_pdf_w(scene, params, column, row);
}

#endif
