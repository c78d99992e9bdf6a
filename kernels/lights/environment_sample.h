// SPDX-License-Identifier: Apache-2.0
// Light sampling of the environment: directions of a map by its texels, of a constant one by the cosine.
#ifndef CLRT_LIGHTS_ENVIRONMENT_SAMPLE_H
#define CLRT_LIGHTS_ENVIRONMENT_SAMPLE_H

#include "environment.h"
#include "light_sample.h"

/* The slot of the alias table that a word stands for. */
static inline uint environment_slot(const RenderParams* params, uint word)
{
    return warp_index(word, environment_tile_count(params));
}

/* The tile that a slot and another word choose. */
static inline uint environment_tile(const Scene* scene, uint slot, uint alias_word)
{
    const uint alias = scene->sky_tiles[slot].alias;
    return alias_word < scene->sky_tiles[slot].threshold ? slot : alias;
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
    if (environment_is_searched(params) && params->portal_count == 0u)
        CLRT_PREFETCH(scene->sky_tiles + environment_slot(params, environment_word(params, words)));
}

static inline void environment_prefetch_texel(const Scene* scene, const RenderParams* params, uint2 words,
                                              uint alias_word)
{
    if (!environment_is_searched(params) || params->portal_count != 0u)
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

/* One of four shares, and how far a number is between its ends. */
typedef struct {
    uint place, share;
    real within;
} SkyShare;

/* Chooses among four shares, not all 0, by a number in [0, 1): one that is not 0. A number below 1 times the
   sum of the shares stays below the sum when it is rounded. */
static inline SkyShare environment_choose_share(uint a, uint b, uint c, uint d, real u)
{
    const uint end_b = a + b;
    const uint end_c = end_b + c;
    const real at = u * (real)(end_c + d);
    const bool behind_a = at >= (real)a, behind_b = at >= (real)end_b, behind_c = at >= (real)end_c;
    const uint begin = behind_c ? end_c : behind_b ? end_b : behind_a ? a : 0u;
    SkyShare chosen;
    chosen.place = (behind_a ? 1u : 0u) + (behind_b ? 1u : 0u) + (behind_c ? 1u : 0u);
    chosen.share = behind_c ? d : behind_b ? c : behind_a ? b : a;
    chosen.within = (at - (real)begin) / (real)chosen.share;
    return chosen;
}

/* Sum of a word's four bytes, which fits one. */
static inline uint environment_bytes_sum(uint word) { return (word * 0x01010101u) >> 24; }

/* A direction that was drawn from the map, in scalars as SkyColor. */
typedef struct {
    real wi_x, wi_y, wi_z;
    real pdf_w;
    SkyColor radiance;
} SkySample;

/* Chooses a texel of a map in this format and a direction uniformly within it. Without branches, for loops
   over lanes. */
CLRT_GIVES_STRUCT SkySample environment_draw(const Scene* scene, const RenderParams* params, uint format,
                                             uint word, uint alias_word, real v)
{
    const uint width = params->environment_width;
    const uint across = environment_tiles_across(params);
    const uint number = environment_tile(scene, environment_slot(params, word), alias_word);
    global const SkyTile* tile = scene->sky_tiles + number;
    const SkyShare below = environment_choose_share(
        environment_bytes_sum(tile->shares[0]), environment_bytes_sum(tile->shares[1]),
        environment_bytes_sum(tile->shares[2]), environment_bytes_sum(tile->shares[3]), v);
    const uint of_row = tile->shares[below.place];
    const SkyShare beside =
        environment_choose_share(environment_share(of_row, 0u), environment_share(of_row, 1u),
                                 environment_share(of_row, 2u), environment_share(of_row, 3u),
                                 warp_rest(word, environment_tile_count(params), alias_word));
    const uint row = number / across * SKY_TILE_SIZE + below.place;
    const uint column = number % across * SKY_TILE_SIZE + beside.place;
    /* 1 - cos is uniform between the row's edges, measured from the nearer pole: so no digits are lost next
       to it. */
    const bool upper = 2u * row < params->environment_height;
    const uint from_pole = upper ? row : params->environment_height - 1u - row;
    const real inner = environment_half_sin(params, (real)from_pole);
    const real outer = environment_half_sin(params, (real)(from_pole + 1u));
    const real h = REAL(2.0) * fma(below.within, (outer - inner) * (outer + inner), inner * inner);
    const real r = real_root(h * (REAL(2.0) - h));
    const real y = upper ? REAL(1.0) - h : h - REAL(1.0);
    const real map_u = ((real)column + beside.within) / (real)width;
    /* u = 0.5 + phi / (2 pi): phi = 0 lies in the middle of the map. */
    const real2 sc = real_sin_cos_turn(map_u < REAL(0.5) ? map_u + REAL(0.5) : map_u - REAL(0.5));
    const real3 wi = environment_to_world(params, vector_make(r * sc.y, y, r * sc.x));
    const SkyColor seen =
        environment_lookup(scene, params, format, map_u, real_atan2(r, y) * REAL_INVERSE_PI);
    SkySample sample;
    sample.wi_x = wi.x;
    sample.wi_y = wi.y;
    sample.wi_z = wi.z;
    sample.pdf_w = environment_share_pdf_w(params, tile, beside.share, row);
    sample.radiance.red = (real)params->environment.x * seen.red;
    sample.radiance.green = (real)params->environment.y * seen.green;
    sample.radiance.blue = (real)params->environment.z * seen.blue;
    return sample;
}

/* The sample that a drawn direction is. */
static inline LightSample environment_drawn(const SkySample* drawn)
{
    LightSample sample = light_sample_none();
    sample.wi = vector_make(drawn->wi_x, drawn->wi_y, drawn->wi_z);
    sample.pdf_w = drawn->pdf_w;
    sample.radiance = vector_make(drawn->radiance.red, drawn->radiance.green, drawn->radiance.blue);
    sample.is_delta = false;
    return sample;
}

/* Chooses a texel and a direction within it. */
static inline LightSample environment_map_sample(const Scene* scene, const RenderParams* params, uint word,
                                                 uint alias_word, real v)
{
    const SkySample drawn =
        environment_draw(scene, params, params->environment_format, word, alias_word, v);
    return environment_drawn(&drawn);
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

#endif
