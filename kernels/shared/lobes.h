// SPDX-License-Identifier: Apache-2.0
// The lobes of surfaces, one row each: all that host and kernels know of a lobe by its name. A BSDF is the
// sum of its lobes.
#ifndef CLRT_SHARED_LOBES_H
#define CLRT_SHARED_LOBES_H

#include "effects.h"
#include "path_types.h"

/* Bits of the lobes of a material; bit i is row i of the table. */
#define LOBE_MATTE 1u       /* Lambert, reflectance `matte` */
#define LOBE_SHEEN 2u       /* fibres that stand up, above all lobes but the coat */
#define LOBE_COAT 4u        /* a clear film, above all other lobes */
#define LOBE_GLOSSY 8u      /* GGX reflection, colour `specular`, alpha_x, alpha_y > 0 */
#define LOBE_MIRROR 16u     /* delta reflection, colour `specular` */
#define LOBE_DIELECTRIC 32u /* reflection and refraction with exact Fresnel, smooth when alpha_x = 0 */
#define LOBE_PANE 64u       /* a thin wall: reflection, and transmission that is not bent; where alpha_x = 0 it
                               is a mirror, and what passes is no event (path/visibility.h) */
#define LOBE_MEASURED 128u  /* a measured BRDF, alone */

/* Lobes of microfacets, which reflect light more than once (scattering/bsdf_energy.h). */
#define LOBES_ROUGH (LOBE_GLOSSY | LOBE_DIELECTRIC | LOBE_PANE)

/* Surfaces whose glossy reflection has an alpha up to this are casters, as those with delta lobes are: what
   they reflect gathers in caustics that paths from the eye seldom find. */
#define CASTER_LARGEST_ALPHA 0.1f

/* Lobes that let light through. */
#define LOBES_GLASS (LOBE_DIELECTRIC | LOBE_PANE)

/* The table, in the order in which lobes are chosen and summed; ROW(NAME, name, EFFECT, letters,
   delta_letters, absent):
   - LOBE_NAME is the bit, LOBE_ROW_NAME its number;
   - name: in reports, and of its functions, bsdf_<name>_* in scattering/bsdf_<name>.h;
   - EFFECT_* that compiles it in;
   - letters of the path notation (bits LETTER_BIT) that it writes where it has a density: 0: nowhere;
   - and where it is a delta function, reflected or refracted;
   - absent: what --explain says where no material has it. */
#define LOBE_TABLE(ROW)                                                                                      \
    ROW(MATTE, matte, EFFECT_MATTE, LETTER_BIT(LETTER_MATTE), 0u, "no material has Kd above 0")              \
    ROW(SHEEN, sheen, EFFECT_SHEEN, LETTER_BIT(LETTER_GLOSSY), 0u, "no material has a sheen")                \
    ROW(COAT, coat, EFFECT_COAT, LETTER_BIT(LETTER_GLOSSY), 0u, "no material has a coat")                    \
    ROW(GLOSSY, glossy, EFFECT_GLOSSY, LETTER_BIT(LETTER_GLOSSY), 0u, "no material reflects roughly")        \
    ROW(MIRROR, mirror, EFFECT_MIRROR, 0u, LETTER_BIT(LETTER_MIRROR), "no material is a mirror")             \
    ROW(DIELECTRIC, dielectric, EFFECT_REFRACTION, LETTER_BIT(LETTER_GLOSSY),                                \
        LETTER_BIT(LETTER_MIRROR) | LETTER_BIT(LETTER_REFRACTION), "no material is a dielectric")         \
    ROW(PANE, pane, EFFECT_THIN_WALL, LETTER_BIT(LETTER_GLOSSY), LETTER_BIT(LETTER_MIRROR),                  \
        "no material is a thin wall")                                                                        \
    ROW(MEASURED, measured, EFFECT_MEASURED, LETTER_BIT(LETTER_GLOSSY), 0u,                                  \
        "no material has a measured BRDF")

#define LOBE_NUMBER(NAME, name, effect, letters, delta_letters, absent) LOBE_ROW_##NAME,
enum { LOBE_TABLE(LOBE_NUMBER) LOBE_COUNT };
#undef LOBE_NUMBER

#endif
