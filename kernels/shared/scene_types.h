// SPDX-License-Identifier: Apache-2.0
// The scene as the kernels see it: flat arrays of these structs. Positions are in the normalised frame
// (centred, scaled by a power of two; see src/scene/normalise.h), colours are linear RGB.
#ifndef CLRT_SHARED_SCENE_TYPES_H
#define CLRT_SHARED_SCENE_TYPES_H

#include "lobes.h"
#include "types.h"

SHARED_BEGIN

/* Corner indices into the position, normal and uv arrays. Normals or uvs are given for all three corners or
   for none (all three NO_INDEX). */
typedef struct {
    u32 v0, v1, v2;
    u32 n0, n1, n2;
    u32 t0, t1, t2;
    u32 material;
    u32 emitter; /* index into the emitters, NO_INDEX when dark or of zero area */
    u32 object;  /* index of the `o` or `g` statement, for the objectId layer */
} Triangle;
ASSERT_SIZE(Triangle, 48);

/* What scales LOBE_GLOSSY and LOBE_MIRROR. */
#define FRESNEL_NONE 0u    /* colour `specular` at every angle */
#define FRESNEL_SCHLICK 1u /* F0 = `specular`, 1 at grazing */

/* `specular` is F0 of the part that is no metal: specular = mix(specular, matte, metallic),
   matte = matte (1 - metallic). */
#define MATERIAL_METALLIC_ROUGHNESS 1u
#define MATERIAL_EMITS_BOTH_SIDES 2u
#define MATERIAL_WHITTED_MIRROR 4u /* `whitted` sends one mirror ray for the reflection lobe, no highlight */
#define MATERIAL_CUT_OUT 8u        /* coverage below 1 somewhere */

typedef struct {
    vec4 matte;        /* rgb: Kd in [0,1]; w: MATERIAL_COVERAGE */
    vec4 specular;     /* rgb: Ks, or F0 with FRESNEL_SCHLICK; w: MATERIAL_EXPONENT */
    vec4 transmission; /* rgb: Tf, tint of each crossing; w: MATERIAL_INDEX */
    vec4 emission;     /* rgb: Ke, emitted radiance; w: MATERIAL_METALLIC */
    float alpha_x, alpha_y; /* GGX roughness along the tangent (direction of growing u) and across it */
    u32 lobes;              /* LOBE_* */
    u32 fresnel;            /* FRESNEL_* */
    u32 flags;              /* MATERIAL_* */
    u32 map_matte, map_specular, map_emission; /* indices into the textures, multiply the constants above */
    u32 map_coverage, map_roughness, map_metallic; /* map_roughness holds Pr: alpha = (Pr map)^2 */
    u32 map_normal, map_bump;
    float bump_scale;     /* -bm: height of a full-range bump map in normalised scene units; where there is
                             only a normal map, the factor of its x and y */
    float roughness_sqrt_x, roughness_sqrt_y; /* Pr along x and y: sqrt(alpha), multiplied by map_roughness */
} Material;
ASSERT_SIZE(Material, 128);

/* What the fourth components hold. */
#define MATERIAL_COVERAGE(material) ((material).matte.w)     /* d in [0,1] */
#define MATERIAL_EXPONENT(material) ((material).specular.w)  /* Phong's Ns; 0: no highlight */
#define MATERIAL_INDEX(material) ((material).transmission.w) /* of refraction, Ni */
#define MATERIAL_METALLIC(material) ((material).emission.w)  /* Pm in [0,1] */

/* How texels are stored in the word array. */
#define TEXEL_SRGB8 0u   /* one word: r, g, b, a bytes from the lowest; sRGB-encoded but for a */
#define TEXEL_LINEAR8 1u /* the same, all four linear */
#define TEXEL_FLOAT 2u   /* four words: r, g, b, a as floats */
#define TEXEL_VERTEX 3u  /* no picture: three words a vertex (index as in positions): r, g, b as floats */

/* One use of an image: rows from top to bottom; uv = (0,0) is the lower left corner.
   The lookup is at u' = scale_u u + offset_u, v' = scale_v v + offset_v; value' = base + gain value (-mm). */
typedef struct {
    u32 first_word; /* into the texel words */
    u32 width, height;
    u32 format;  /* TEXEL_* */
    float scale_u, scale_v, offset_u, offset_v;
    float base, gain;
    u32 clamp;   /* 0: repeat; 1: black (zero) outside [0,1] (-clamp on) */
    u32 channel; /* for scalar maps: 0..3 = r, g, b, a; 4 = luminance (-imfchan) */
} Texture;
ASSERT_SIZE(Texture, 48);

/* An emissive triangle. Choosing: i = floor(u n); keep i where the second random word is below `threshold`,
   else take `alias` (Walker 1977, Vose 1991). */
typedef struct {
    u32 triangle;
    u32 alias;
    u32 threshold;
    float pdf_a; /* probability of this triangle over its area, per unit area of the normalised frame */
} Emitter;
ASSERT_SIZE(Emitter, 16);

#define LIGHT_POINT 0u
#define LIGHT_SUN 1u

/* Lights that are no geometry. */
typedef struct {
    vec4 vector;   /* LIGHT_POINT: position; LIGHT_SUN: unit direction towards the sun. w: unused, 0 */
    vec4 emission; /* LIGHT_POINT: radiant intensity, W/sr in the normalised frame; LIGHT_SUN with radius 0:
                      irradiance at normal incidence; with a radius: radiance of the disc. w: unused, 0 */
    u32 kind;           /* LIGHT_* */
    float probability;  /* of choosing this light among the lights of this array */
    u32 alias, threshold; /* as in Emitter */
    float one_minus_cos; /* LIGHT_SUN: 1 - cos(angular radius); 0: a delta light */
    u32 unused0, unused1, unused2;
} Light;
ASSERT_SIZE(Light, 64);

/* A texel of a lat-long environment map, rows from +Y down. The choice is piecewise constant over texels,
   the lookup bilinear. */
typedef struct {
    vec4 radiance; /* rgb; w: TEXEL_PROBABILITY */
    u32 alias, threshold;
    u32 unused0, unused1;
} EnvironmentTexel;
ASSERT_SIZE(EnvironmentTexel, 32);

/* Of choosing the texel. */
#define TEXEL_PROBABILITY(texel) ((texel).radiance.w)

/* Two siblings of the light tree (kernels/lights/light_tree.h): sphere and cone around what is below each,
   its power, and where it is. The root is the pair 0. */
typedef struct {
    vec2 x, y, z;                /* centres of the spheres around the lights */
    vec2 radius;
    vec2 axis_x, axis_y, axis_z; /* unit axes of the cones around their normals */
    vec2 cos_spread;             /* of the cones' half angles; -1 where normals lie anywhere */
    vec2 power;                  /* over that of the strongest light: radiance times area, intensity, ... */
    u32 first, second;           /* LIGHT_LINK_* */
    u32 first_share;             /* of the first child in the pair's power, over 2^24, from 1 to 2^24 - 1 */
    u32 unused0, unused1, unused2;
} LightPair;
ASSERT_SIZE(LightPair, 96);

/* A link leads to a pair, or to the first light of a leaf. */
#define LIGHT_LINK_LEAF 0x80000000u
#define LIGHT_LINK_BOTH_SIDES 0x40000000u /* some light below shines on both sides of its plane */
#define LIGHT_LINK_INDEX 0x3fffffffu

/* Where a light is in the tree: the way from the root, a bit for each pair, set for the second child. Leaves
   hold lights of successive numbers, chosen by fixed shares. */
typedef struct {
    u32 trail_low, trail_high;
    u32 end;       /* sum of the shares of the leaf's lights up to this one, over 2^32; LIGHT_LEAF_END: all;
                      0: the light is not in the tree */
    float density; /* of an emissive triangle: 1 over its area; of others: 1 */
} LightPlace;
ASSERT_SIZE(LightPlace, 16);

#define LIGHT_LEAF_END 0xffffffffu

SHARED_END

#endif
