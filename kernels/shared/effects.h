// SPDX-License-Identifier: Apache-2.0
// Effects a kernel can be built with. The host proves which ones a scene cannot show (src/effects) and leaves
// their bits out of CLRT_EFFECTS; kernels guard the code with `if (HAS(EFFECT_X))`, which type-checks all of
// it in every build. A cleared bit only removes code whose run-time condition is never true in this scene.
#ifndef CLRT_SHARED_EFFECTS_H
#define CLRT_SHARED_EFFECTS_H

#define EFFECT_AREA_LIGHT 0x0001u      /* emissive triangles */
#define EFFECT_DELTA_LIGHT 0x0002u     /* point lights and suns */
#define EFFECT_ENVIRONMENT 0x0004u     /* light from outside the scene */
#define EFFECT_ENVIRONMENT_MAP 0x0008u /* ... that varies with direction */
#define EFFECT_MATTE 0x0010u           /* Lambertian lobes */
#define EFFECT_GLOSSY 0x0020u          /* rough reflection */
#define EFFECT_MIRROR 0x0040u          /* delta reflection */
#define EFFECT_REFRACTION 0x0080u      /* dielectrics */
#define EFFECT_ROUGH_REFRACTION 0x0100u
#define EFFECT_TEXTURES 0x0200u        /* any map */
#define EFFECT_NORMAL_MAP 0x0400u      /* normal and bump maps */
#define EFFECT_SMOOTH_NORMALS 0x0800u  /* vn that differ from the face's normal */
#define EFFECT_CUT_OUT 0x1000u         /* coverage below 1 */
#define EFFECT_FILTER 0x2000u          /* pixel filter other than the box */
#define EFFECT_PATH_FILTER 0x4000u     /* --paths, layers of paths (path/automaton.h) */
#define EFFECT_LIGHT_TREE 0x8000u      /* lights chosen by what they may send to a vertex */
#define EFFECT_MOTION_BLUR 0x10000u    /* what moves while the shutter is open; rays have a time */
#define EFFECT_DEPTH_OF_FIELD 0x20000u /* a lens wider than a point */
#define EFFECT_PART_GLASS 0x40000u     /* transmission mixed with other lobes by a weight */
#define EFFECT_ATTENUATION 0x80000u    /* solids that absorb on the way through them */
#define EFFECT_COAT 0x100000u          /* clear coats */
#define EFFECT_SHEEN 0x200000u         /* fibres that reflect towards grazing angles */
#define EFFECT_SPOT 0x400000u          /* point lights that shine within a cone */
#define EFFECT_CONDUCTOR 0x800000u     /* reflection by a complex index of refraction */
#define EFFECT_DISPERSION 0x2000000u   /* glass that bends colours apart */
#define EFFECT_NESTED 0x4000000u       /* solids within each other, by priority (geometry/nest.h) */
#define EFFECT_MAPPED_EMISSION 0x8000000u /* emissive triangles in parts (geometry/emitter_part.h) */
#define EFFECT_INSTANCES 0x10000000u   /* copies that share one mesh (geometry/instance.h) */
#define EFFECT_THIN_WALL 0x20000000u   /* panes without an inside */
#define EFFECT_ROTATION 0x40000000u    /* highlights stretched askew to the texture coordinates */
#define EFFECT_TEXTURE_FILTER 0x80000000u /* lookups over the ray's footprint (geometry/ray_cone.h) */
#define EFFECT_ALL                                                                                           \
    (0xffffffu | EFFECT_DISPERSION | EFFECT_NESTED | EFFECT_MAPPED_EMISSION | EFFECT_INSTANCES |             \
     EFFECT_THIN_WALL | EFFECT_ROTATION | EFFECT_TEXTURE_FILTER)

/* Effects that read the array of material extensions. */
#define EFFECTS_EXTENSION                                                                                    \
    (EFFECT_PART_GLASS | EFFECT_ATTENUATION | EFFECT_COAT | EFFECT_SHEEN | EFFECT_ROTATION |                \
     EFFECT_DISPERSION | EFFECT_NESTED)

/* Effects of surfaces behind which the same ray goes on (path/visibility.h). */
#define EFFECTS_PASSED (EFFECT_CUT_OUT | EFFECT_THIN_WALL | EFFECT_NESTED)

#ifndef __cplusplus
#ifndef CLRT_EFFECTS
#define CLRT_EFFECTS EFFECT_ALL
#endif
#define HAS(effects) ((CLRT_EFFECTS & (effects)) != 0) /* any of them */
#endif

#endif
