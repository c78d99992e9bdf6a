// SPDX-License-Identifier: Apache-2.0
// Effects a kernel can be built with. The host proves which ones a scene cannot show (src/effects) and leaves
// their bits out of CLRT_EFFECTS; kernels guard the code with `if (HAS(EFFECT_X))`, which type-checks all of
// it in every build. A cleared bit only removes code whose run-time condition is never true in this scene.
#ifndef CLRT_SHARED_EFFECTS_H
#define CLRT_SHARED_EFFECTS_H

/* Sets of effects have 64 bits on both sides; kernels ask for them in preprocessor conditions too. */
#ifdef __cplusplus
#include <cstdint>
namespace clrt {
/// A set of effects, bits EFFECT_*.
using EffectMask = std::uint64_t;
} // namespace clrt
#define EFFECT_BIT(bits) clrt::EffectMask(bits)
#else
#define EFFECT_BIT(bits) bits##ul
#endif

#define EFFECT_AREA_LIGHT EFFECT_BIT(0x0001)      /* emissive triangles */
#define EFFECT_DELTA_LIGHT EFFECT_BIT(0x0002)     /* point lights and suns */
#define EFFECT_ENVIRONMENT EFFECT_BIT(0x0004)     /* light from outside the scene */
#define EFFECT_ENVIRONMENT_MAP EFFECT_BIT(0x0008) /* ... that varies with direction */
#define EFFECT_MATTE EFFECT_BIT(0x0010)           /* Lambertian lobes */
#define EFFECT_GLOSSY EFFECT_BIT(0x0020)          /* rough reflection */
#define EFFECT_MIRROR EFFECT_BIT(0x0040)          /* delta reflection */
#define EFFECT_REFRACTION EFFECT_BIT(0x0080)      /* dielectrics */
#define EFFECT_ROUGH_REFRACTION EFFECT_BIT(0x0100)
#define EFFECT_TEXTURES EFFECT_BIT(0x0200)        /* any map */
#define EFFECT_NORMAL_MAP EFFECT_BIT(0x0400)      /* normal and bump maps */
#define EFFECT_SMOOTH_NORMALS EFFECT_BIT(0x0800)  /* vn that differ from the face's normal */
#define EFFECT_CUT_OUT EFFECT_BIT(0x1000)         /* coverage below 1 */
#define EFFECT_FILTER EFFECT_BIT(0x2000)          /* pixel filter other than the box */
#define EFFECT_PATH_FILTER EFFECT_BIT(0x4000)     /* --paths, layers of paths (path/automaton.h) */
#define EFFECT_LIGHT_TREE EFFECT_BIT(0x8000)      /* lights chosen by what they may send to a vertex */
#define EFFECT_MOTION_BLUR EFFECT_BIT(0x10000)    /* what moves while the shutter is open; rays have a time */
#define EFFECT_DEPTH_OF_FIELD EFFECT_BIT(0x20000) /* a lens wider than a point */
#define EFFECT_PART_GLASS EFFECT_BIT(0x40000)     /* transmission mixed with other lobes by a weight */
#define EFFECT_ATTENUATION EFFECT_BIT(0x80000)    /* solids that absorb on the way through them */
#define EFFECT_COAT EFFECT_BIT(0x100000)          /* clear coats */
#define EFFECT_SHEEN EFFECT_BIT(0x200000)         /* fibres that reflect towards grazing angles */
#define EFFECT_SPOT EFFECT_BIT(0x400000)          /* point lights that shine within a cone */
#define EFFECT_CONDUCTOR EFFECT_BIT(0x800000)     /* reflection by a complex index of refraction */
#define EFFECT_DISPERSION EFFECT_BIT(0x2000000)   /* glass that bends colours apart */
#define EFFECT_NESTED EFFECT_BIT(0x4000000) /* solids within each other, by priority (geometry/nest.h) */
#define EFFECT_MAPPED_EMISSION EFFECT_BIT(0x8000000) /* emissive triangles in parts (emitter_part.h) */
#define EFFECT_INSTANCES EFFECT_BIT(0x10000000) /* copies that share one mesh (geometry/instance.h) */
#define EFFECT_THIN_WALL EFFECT_BIT(0x20000000)   /* panes without an inside */
#define EFFECT_ROTATION EFFECT_BIT(0x40000000)    /* highlights stretched askew to the texture coordinates */
#define EFFECT_TEXTURE_FILTER EFFECT_BIT(0x80000000) /* lookups over the ray's footprint (ray_cone.h) */
#define EFFECT_MEASURED EFFECT_BIT(0x100000000) /* measured BRDFs */
#define EFFECT_SECOND_UV EFFECT_BIT(0x200000000) /* two sets of texture coordinates (geometry/uv.h) */
#define EFFECT_ALL                                                                                           \
    (EFFECT_BIT(0xffffff) | EFFECT_DISPERSION | EFFECT_NESTED | EFFECT_MAPPED_EMISSION | EFFECT_INSTANCES |  \
     EFFECT_THIN_WALL | EFFECT_ROTATION | EFFECT_TEXTURE_FILTER | EFFECT_MEASURED | EFFECT_SECOND_UV)

/* Effects that read the array of material extensions. */
#define EFFECTS_EXTENSION                                                                                    \
    (EFFECT_PART_GLASS | EFFECT_ATTENUATION | EFFECT_COAT | EFFECT_SHEEN | EFFECT_ROTATION |                \
     EFFECT_DISPERSION | EFFECT_NESTED | EFFECT_MEASURED)

/* Effects of surfaces behind which the same ray goes on (path/visibility.h). */
#define EFFECTS_PASSED (EFFECT_CUT_OUT | EFFECT_THIN_WALL | EFFECT_NESTED)

/* Effects by which what a path finds is its own pixel's alone (integrators/path_reuse.h): rays with a time, a
   footprint or solids around them of their own, and paths that are told apart. */
#define EFFECTS_OF_ONE_PIXEL (EFFECT_NESTED | EFFECT_PATH_FILTER | EFFECT_MOTION_BLUR | EFFECT_TEXTURE_FILTER)

#ifndef __cplusplus
#ifndef CLRT_EFFECTS
#define CLRT_EFFECTS EFFECT_ALL
#endif
#define HAS(effects) ((CLRT_EFFECTS & (effects)) != 0) /* any of them */
#endif

#endif
