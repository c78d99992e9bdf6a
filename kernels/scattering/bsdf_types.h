// SPDX-License-Identifier: Apache-2.0
// A material at one surface point, ready to be evaluated, and what evaluating and sampling it give.
#ifndef CLRT_SCATTERING_BSDF_TYPES_H
#define CLRT_SCATTERING_BSDF_TYPES_H

#include "albedo.h"
#include "numerics/frame.h"
#include "shared/effects.h"
#include "shared/measured_types.h"
#include "shared/scene_types.h"
#include "trace/trace.h"

/* What a BSDF carries from wi to wo: radiance, on paths from the eye, or importance, on paths from lights. A
   flag of it. */
#define TRANSPORT_RADIANCE 0u
#define TRANSPORT_IMPORTANCE 0x80000u

/* Ways of a smooth dielectric that a path must not go (path/filter.h), beside MATERIAL_*. */
#define BSDF_NO_REFLECTION 0x10000u
#define BSDF_NO_REFRACTION 0x20000u

/* wo sees the shading normal from behind, and it has been bent (material.h). */
#define BSDF_BENT 0x8000u

/* The matte lobe gets what the reflection above it leaves (bsdf_energy.h). */
#define BSDF_COUPLED 0x40000u

/* A coat or a sheen lies above the lobes (bsdf_cover.h), and wo is below it, in the solid. */
#define BSDF_COVERED 0x100000u
#define BSDF_INSIDE 0x200000u

/* Where the surface disperses, the wave of the ray that has hit it (geometry/ray.h), from this bit on. */
#define BSDF_WAVE_SHIFT 22u

/* What lies above the lobes of the surface (bsdf_cover.h). */
typedef struct {
    real3 sheen;          /* colour */
    real sheen_alpha;
    real coat;            /* weight */
    real coat_alpha;
    real coat_left, left; /* what the coat, and what both leave of light from wo, */
    real mean_left;       /* and both of light from everywhere */
    real coat_shared;     /* s(wo) below the coat */
} BsdfCover;

/* What surfaces of one kind alone have. */
typedef union {
    real3 etas; /* of the colours, as `eta`; where the surface disperses */
    global const MeasuredBrdf* measured; /* of LOBE_MEASURED; its values lie behind it */
} BsdfRare;

typedef struct {
    Frame frame;        /* z is the shading normal, on wo's side */
    real3 wo;           /* towards the eye, in the frame: wo.z >= 0 */
    real3 normal_g;     /* world: geometric normal, on wo's side */
    real3 normal_s;     /* world: interpolated normal, no map; used where the surface is curved */
    real3 matte;        /* reflectance */
    real3 specular;     /* reflection colour, or F0 */
    real3 transmission; /* tint of a crossing */
    real alpha_x, alpha_y;
    real eta;                /* index on wo's side over index on the other side; of a pane, air over glass */
    real glass;              /* weight of the glass beside the other lobes; where BSDF has none of it unset */
    real exponent;           /* of Phong's highlight; 0: none */
    bool is_curved;          /* the surface bulges over its plane: directions below it may be reflected */
    uint lobes;              /* LOBE_* */
    uint fresnel;            /* FRESNEL_* */
    uint flags;              /* MATERIAL_*, BSDF_*, TRANSPORT_* */
    AlbedoRoughness rough;   /* alpha 0: nothing rough */
    real multiple_color;     /* size of the colour of light of more than one facet */
    real3 passing;           /* coupling of the matte lobe but for what depends on wi */
    real3 passing_loss;      /* how it grows with what rough facets lose */
    real3 multiple;          /* light of more than one facet but for what depends on wi: reflected */
    real3 multiple_glass;    /* the same by the glass: reflected, */
    real3 multiple_through;  /* and let through, with the squared index ratio */
    real multiple_reflects;  /* the reflected share of it */
    real matte_size;         /* of the albedo of the matte lobe, */
    real multiple_size;      /* and of that of the light of more than one facet */
    real choose[LOBE_COUNT]; /* probabilities of the lobes, by LOBE_ROW_*; 0 where it has none */
    real choose_multiple;    /* the part of the rough lobe's that goes to the light of more than one facet */
#if CLRT_EFFECTS & (EFFECT_COAT | EFFECT_SHEEN)
    BsdfCover cover;         /* where the flag is BSDF_COVERED */
#endif
#if CLRT_EFFECTS & (EFFECT_DISPERSION | EFFECT_MEASURED)
    BsdfRare rare;
#endif
} Bsdf;

/* What lies above the lobes; nowhere where no material has such a thing, and nothing asks. */
static inline BsdfCover* bsdf_cover(const Bsdf* bsdf)
{
#if CLRT_EFFECTS & (EFFECT_COAT | EFFECT_SHEEN)
    return (BsdfCover*)&bsdf->cover;
#else
    return 0;
#endif
}

/* The measured BRDF, with its values behind it; nowhere where no material has one. */
static inline global const MeasuredBrdf* bsdf_measured(const Bsdf* bsdf)
{
#if CLRT_EFFECTS & EFFECT_MEASURED
    return bsdf->rare.measured;
#else
    return 0;
#endif
}

static inline void bsdf_set_measured(Bsdf* bsdf, global const u32* words)
{
#if CLRT_EFFECTS & EFFECT_MEASURED
    bsdf->rare.measured = (global const MeasuredBrdf*)words;
#endif
}

/* All lobes that are no delta functions, for one direction. */
typedef struct {
    real3 value; /* BSDF times |cos_i| */
    real pdf_w;  /* of sampling it, per steradian */
} BsdfValue;

static inline BsdfValue bsdf_value_none(void)
{
    BsdfValue none;
    none.value = (real3)(REAL(0.0));
    none.pdf_w = REAL(0.0);
    return none;
}

/* A sampled direction. */
typedef struct {
    real3 wi;               /* world */
    real3 weight;           /* BSDF times |cos_i| over pdf, all factors inside */
    real pdf_w;             /* per steradian; 0 for a delta lobe */
    real eta;               /* relative index crossed; 1 for reflection */
    bool reflects;          /* wi is on wo's side of the surface */
    bool is_valid;          /* false: no direction, the path ends */
    bool is_weighted;       /* by the lobe that was sampled; else weight and density are those of the sum */
    TRACE_MEMBER(uint lobe) /* chosen */
} BsdfSample;

/* The number that chooses a lobe, and how much of it went to the lobes before. */
typedef struct {
    real u;
    real before; /* sum of their probabilities */
} BsdfChoice;

/* What every lobe of the table (shared/lobes.h) defines, for local directions:
   - bool bsdf_<name>_is_delta(bsdf);
   - real bsdf_<name>_size(bsdf): size of what it reflects towards wo, by which it is chosen beside others;
   - real3 bsdf_<name>_albedo(bsdf): head-on, for the albedo layer;
   - void bsdf_<name>_add(bsdf, wi, sum): adds its value and its share of the mixture's density;
   - real3 bsdf_<name>_sample(bsdf, choice, u, sample): a direction, with weight and density where it knows
   them (is_weighted).

   Densities of the reverse direction, sampling wo from wi, are those of the surface seen from wi
   (bsdf_reverse.h). */

/* True where other lobes are beside the glass; the matte one is already scaled by its share, and so is the
   glass's transmission. */
static inline bool bsdf_is_part_glass(const Bsdf* bsdf)
{
    return HAS(EFFECT_PART_GLASS) && (bsdf->flags & MATERIAL_PART_GLASS);
}

/* Factor of what the glass reflects. */
static inline real3 bsdf_glass_color(const Bsdf* bsdf)
{
    return bsdf_is_part_glass(bsdf) ? (real3)(bsdf->glass) : bsdf->specular;
}

/* The index ratio that a direction has crossed: none at a pane. */
static inline real bsdf_crossed_eta(const Bsdf* bsdf)
{
    return HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE) ? REAL(1.0) : bsdf->eta;
}

/* True if what lies above the lobes takes part. */
static inline bool bsdf_is_covered(const Bsdf* bsdf)
{
    return HAS(EFFECT_COAT | EFFECT_SHEEN) && (bsdf->flags & BSDF_COVERED);
}

/* The squared index ratio, which scales radiance where it crosses a boundary, but not importance (Veach 1997,
   sec. 5.2), times x. This is its one place. */
static inline real bsdf_cross(const Bsdf* bsdf, real x)
{
    return (bsdf->flags & TRANSPORT_IMPORTANCE) ? x : x * bsdf->eta * bsdf->eta;
}

#endif
