// SPDX-License-Identifier: Apache-2.0
// The scene as the kernels see it: flat arrays of these structs. Positions are in the normalised frame
// (centred, scaled by a power of two; see src/scene/normalise.h), colours are linear RGB.
#ifndef CLRT_SHARED_SCENE_TYPES_H
#define CLRT_SHARED_SCENE_TYPES_H

#include "lobes.h"
#include "types.h"

SHARED_BEGIN

/* Corner indices into the position, normal and uv arrays, the second uvs beside the first. Normals or uvs are
   given for all three corners or for none (all three NO_INDEX). */
typedef struct {
    u32 v0, v1, v2;
    u32 n0, n1, n2;
    u32 t0, t1, t2;
    u32 material;
    u32 emitter; /* index into the emitters, NO_INDEX when dark or of zero area */
    u32 object;  /* index of the `o` or `g` statement, for the objectId layer */
} Triangle;
ASSERT_SIZE(Triangle, 48);

/* A copy of a prototype's triangles, which the scene shows at an affine map's places only. Triangles of the
   scene itself are those of instance 0, which is in the array where there are others and whose members no
   kernel reads. */
typedef struct {
    vec4 to_world[3]; /* rows of the map from the prototype's frame to the normalised one: xyz, and in w what
                         is added */
    vec4 to_prototype[3]; /* xyz: rows of the inverse of its linear part; w: INSTANCE_SLACK along that axis */
    u32 prototype; /* number of its tree */
    u32 object;    /* for the objectId layer, in the place of its triangles' */
    float side;    /* -1 where the map mirrors, else 1 */
    u32 unused0;
} Instance;
ASSERT_SIZE(Instance, 112);

/* What rounds along an axis of the prototype for any ray, in units of 2^-24 (geometry/instance.h). */
#define INSTANCE_SLACK(row) ((row).w)

/* What scales LOBE_GLOSSY and LOBE_MIRROR. */
#define FRESNEL_NONE 0u    /* colour `specular` at every angle */
#define FRESNEL_SCHLICK 1u /* F0 = `specular`, 1 at grazing */
#define FRESNEL_CONDUCTOR 2u /* index `transmission` + i `specular`, channel by channel */

/* `specular` is F0 of the part that is no metal: specular = mix(specular, matte, metallic),
   matte = matte (1 - metallic). */
#define MATERIAL_METALLIC_ROUGHNESS 1u
#define MATERIAL_EMITS_BOTH_SIDES 2u
#define MATERIAL_WHITTED_MIRROR 4u /* `whitted` sends one mirror ray for the reflection lobe, no highlight */
#define MATERIAL_CUT_OUT 8u        /* coverage below 1 somewhere */
#define MATERIAL_PART_GLASS 16u    /* with MATERIAL_METALLIC_ROUGHNESS: part of what is no metal is glass */
#define MATERIAL_ATTENUATES 32u    /* the solid behind the surface absorbs on the way */
#define MATERIAL_TURNED 64u        /* the stretched highlight is turned against the texture coordinates */
#define MATERIAL_DISPERSES 128u    /* the index of refraction depends on the colour */
#define MATERIAL_NESTED 256u       /* a solid that others may lie in, or overlap */
#define MATERIAL_SLAB 512u         /* smooth clear glass of which most facets have a parallel one behind them */

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

/* What few materials have. The array is as long as that of the materials, or empty. */
typedef struct {
    vec4 attenuation; /* rgb: absorption per length of the normalised frame; w: EXTENSION_TRANSMISSION */
    vec4 sheen;       /* rgb: colour in [0,1]; w: EXTENSION_SHEEN_ALPHA */
    float coat;       /* weight in [0,1] */
    float coat_alpha; /* GGX roughness, above 0 */
    float turn_cos, turn_sin; /* of the highlight's x axis against the direction of growing u */
    u32 map_transmission, map_coat, map_sheen; /* multiply the constants; NO_INDEX: none */
    u32 map_coat_roughness, map_sheen_roughness; /* alpha = constant (map)^2 */
    float spread; /* of the index between Fraunhofer's lines C and F (scattering/dispersion.h) */
    float priority; /* of the solid: of two in one place the greater is there (geometry/nest.h) */
    u32 measured;   /* of LOBE_MEASURED: first word of its BRDF (measured_types.h) */
    u32 map_anisotropy; /* r, g: direction along which the highlight is stretched, (-1, 1) as (0, 1); b: how
                           much, multiplied by */
    float anisotropy;   /* this; NO_INDEX: the highlight is stretched as alpha_x and alpha_y say */
    u32 unused0, unused1;
} MaterialExtension;
ASSERT_SIZE(MaterialExtension, 96);

#define EXTENSION_TRANSMISSION(extension) ((extension).attenuation.w) /* weight of the glass, in [0,1] */
#define EXTENSION_SHEEN_ALPHA(extension) ((extension).sheen.w)        /* of its distribution, above 0 */

/* How texels are stored in the word array. */
#define TEXEL_SRGB8 0u   /* one word: r, g, b, a bytes from the lowest; sRGB-encoded but for a */
#define TEXEL_LINEAR8 1u /* the same, all four linear */
#define TEXEL_FLOAT 2u   /* four words: r, g, b, a as floats */
#define TEXEL_VERTEX 3u  /* no picture, but the colours of vertices alone */
#define TEXEL_GREY_SRGB8 4u   /* a byte, four to a word from the lowest: r = g = b, opaque */
#define TEXEL_GREY_LINEAR8 5u

/* Where lookups are filtered, the words of a picture's smaller levels follow its own, down to one texel: the
   size of each is half the size before, rounded down, at least 1. */

/* What is beside the picture, along each axis. */
#define WRAP_REPEAT 0u
#define WRAP_BLACK 1u  /* zero */
#define WRAP_EDGE 2u   /* its texels at the edge */
#define WRAP_MIRROR 3u /* the picture reversed, and so on */

/* One use of an image: rows from top to bottom; uv = (0,0) is the lower left corner.
   The lookup is at u' = scale_u u + shear_u v + offset_u, v' = shear_v u + scale_v v + offset_v;
   value' = base + gain value (-mm). */
typedef struct {
    u32 first_word; /* into the texel words */
    u32 width, height;
    u32 format; /* TEXEL_* */
    float scale_u, scale_v, offset_u, offset_v;
    float shear_u, shear_v;
    float base, gain;
    u32 wrap_u, wrap_v; /* WRAP_* */
    u32 channel;     /* TEXTURE_CHANNEL for scalar maps: 0..3 = r, g, b, a; 4 = luminance (-imfchan); and
                        TEXTURE_* flags */
    u32 vertex_word; /* first texel word of the colours of vertices that multiply a reflectance: three words a
                        vertex (index as in positions), r, g, b as floats; 0: none */
} Texture;
ASSERT_SIZE(Texture, 64);

#define TEXTURE_CHANNEL(texture) ((texture).channel & 7u)
#define TEXTURE_SECOND_UV 8u    /* it is looked up at the second texture coordinates */
#define TEXTURE_TIMES_ALPHA 16u /* of a reflectance: its alpha multiplies it */
#define TEXTURE_WHITE 32u       /* of a reflectance: all its colours are white */

/* An emissive triangle, or one of the parts of one, which follow each other. Choosing: i = floor(u n); keep i where the second random word is below `threshold`,
   else take `alias` (Walker 1977, Vose 1991). */
typedef struct {
    u32 triangle;
    u32 alias;
    u32 threshold;
    float pdf_a; /* probability of this triangle over its area, per unit area of the normalised frame */
} Emitter;
ASSERT_SIZE(Emitter, 16);

/* Which part of its triangle an emitter is, where any triangle has parts: one for each emitter. A triangle is
   cut into four of half its size, at its corners 0, 1, 2 and (turned by half a turn) in the middle, and so is
   any of these. Parts of a triangle follow each other by their codes. */
typedef struct {
    float b1, b2; /* barycentric weights of corners 1 and 2 of the triangle at the part's corner 0 */
    float step;   /* the part's edges over the triangle's; below 0: turned */
    u32 code;     /* EMITTER_CODE */
} EmitterPart;
ASSERT_SIZE(EmitterPart, 16);

/* Two bits for each cut, from the whole on: at which corner the part is, 3: in the middle; 0 behind the last.
   Below them, how many parts the triangle has. */
#define EMITTER_CODE(digits, parts) ((digits) << 12 | (parts))
#define EMITTER_CODE_DIGITS(code) ((code) >> 12)
#define EMITTER_CODE_PARTS(code) ((code)&0xfffu)
#define EMITTER_LARGEST_LEVEL 10u /* cuts, at most */
#define EMITTER_MOST_PARTS 4095u  /* of a triangle */

#define LIGHT_POINT 0u
#define LIGHT_SUN 1u

/* Lights that are no geometry. */
typedef struct {
    vec4 vector;   /* LIGHT_POINT: position; LIGHT_SUN: unit direction towards the sun. w: unused, 0 */
    vec4 emission; /* LIGHT_POINT: radiant intensity, W/sr in the normalised frame, of a spot on its axis;
                      LIGHT_SUN with radius 0: irradiance at normal incidence; with a radius: radiance of the
                      disc. w: LIGHT_SHARPNESS */
    u32 kind;           /* LIGHT_* */
    float probability;  /* of choosing this light among the lights of this array */
    u32 alias, threshold; /* as in Emitter */
    float one_minus_cos; /* LIGHT_SUN: 1 - cos(angular radius); 0: a delta light. Of spots: of the outer angle */
    float axis_x, axis_y, axis_z; /* of spots: unit direction in which they shine */
} Light;
ASSERT_SIZE(Light, 64);

/* Of spots, which are of LIGHT_POINT: 1 / (cos(inner angle) - cos(outer angle)); 0: it is none. */
#define LIGHT_SHARPNESS(light) ((light).emission.w)

/* A sphere that holds casters, surfaces that may scatter by delta lobes or reflect almost as sharply
   (lights/emission_aim.h), is a vec4: centre, and as w its radius. */
#define CASTER_RADIUS(sphere) ((sphere).w)

/* A lat-long environment map lies in tiles of 4 x 4 texels: tiles row by row, rows from +Y down, and so the
   texels of a tile. What sticks out of the map at the right and at the bottom is black and never chosen.
   Light sampling chooses a tile by the alias table, then a row of it and a texel of the row by their shares:
   the choice is piecewise constant over texels, the lookup bilinear. */
#define SKY_TILE_SIZE 4u
#define SKY_TILE_TEXELS 16u

typedef struct {
    u32 alias, threshold; /* as in Emitter */
    float probability;    /* of choosing this tile */
    u32 unused0;
    u32 shares[4];        /* of each row's texels, a byte each from the lowest; none, or SKY_SHARES in all */
} SkyTile;
ASSERT_SIZE(SkyTile, 32);

#define SKY_SHARES 240u /* 15 for each of 16 equal texels */

/* Texels along a side of a rectified map (lights/rectified_sky.h); its sums are at their corners. */
#define RECTIFIED_SIZE 128u
#define RECTIFIED_SUMS ((RECTIFIED_SIZE + 1u) * (RECTIFIED_SIZE + 1u))

/* A rectangle through which the sky is seen from within, such as a window (lights/sky_portal.h). */
typedef struct {
    vec4 corner;   /* w: light, luminance times solid angle, of a unit of a map's sums; else 1 */
    vec4 axis_u;   /* along an edge, of unit length; w: length of the edge */
    vec4 axis_v;   /* likewise */
    vec4 normal;   /* likewise, inwards; w: 0 */
    u32 first_sum; /* of the sky seen from within along it */
    u32 unused0, unused1, unused2;
} SkyPortal;
ASSERT_SIZE(SkyPortal, 80);

/* How texels of the map are stored, in words tile by tile. */
#define SKY_TEXEL_RGBE 0u  /* one word: bytes r, g, b, e from the lowest; a channel is byte 2^(e - 136) */
#define SKY_TEXEL_HALF 1u  /* three halves, not negative */
#define SKY_TEXEL_FLOAT 2u /* three floats */

/* Children of a node of the light tree: as many as AVX has lanes. */
#define LIGHT_NODE_WIDTH 8

/* A node of the light tree (kernels/lights/light_tree.h): for each child the sphere and the cone around what
   is below it, its power, and where it is. The root is node 0. Places without a child have no power. */
typedef struct {
    float x[LIGHT_NODE_WIDTH], y[LIGHT_NODE_WIDTH], z[LIGHT_NODE_WIDTH]; /* centre of the sphere */
    float radius[LIGHT_NODE_WIDTH];
    float axis_x[LIGHT_NODE_WIDTH], axis_y[LIGHT_NODE_WIDTH], axis_z[LIGHT_NODE_WIDTH]; /* unit, of the cone
                                            around the normals */
    float chord[LIGHT_NODE_WIDTH]; /* of the cone's half angle on the unit circle; 2: normals lie anywhere */
    float power[LIGHT_NODE_WIDTH]; /* over that of the strongest light: radiance times area, intensity, ... */
    i32 end[LIGHT_NODE_WIDTH];  /* sum of the powers up to this child's, over LIGHT_SHARES; at least 1 each */
    u32 link[LIGHT_NODE_WIDTH]; /* LIGHT_LINK_* */
} LightNode;
ASSERT_SIZE(LightNode, 352);

/* Shares of a node's children are multiples of 2^-24. */
#define LIGHT_SHARE_BITS 24
#define LIGHT_SHARES (1 << LIGHT_SHARE_BITS)

/* A link leads to a node, or to the first light of a leaf. */
#define LIGHT_LINK_LEAF 0x80000000u
#define LIGHT_LINK_BOTH_SIDES 0x40000000u /* some light below shines on both sides of its plane */
#define LIGHT_LINK_INDEX 0x3fffffffu

/* The way from the root to a leaf, a child's place for each node, from the lowest bits. */
#define LIGHT_TRAIL_BITS 3
#define LIGHT_TRAIL_NODES 21 /* that fit 64 bits: the longest way */

/* Where a light is in the tree. Leaves hold lights of successive numbers, chosen by fixed shares. */
typedef struct {
    u32 trail_low, trail_high; /* LIGHT_TRAIL_* */
    u32 end;       /* sum of the shares of the leaf's lights up to this one, over 2^32; LIGHT_LEAF_END: all;
                      0: the light is not in the tree */
    float density; /* of an emissive triangle: 1 over its area; of others: 1 */
} LightPlace;
ASSERT_SIZE(LightPlace, 16);

#define LIGHT_LEAF_END 0xffffffffu

SHARED_END

#endif
