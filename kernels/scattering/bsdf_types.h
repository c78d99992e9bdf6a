// SPDX-License-Identifier: Apache-2.0
// A material at one surface point, ready to be evaluated, and what evaluating and sampling it give.
#ifndef CLRT_SCATTERING_BSDF_TYPES_H
#define CLRT_SCATTERING_BSDF_TYPES_H

#include "albedo.h"
#include "numerics/frame.h"
#include "shared/effects.h"
#include "shared/scene_types.h"
#include "trace/trace.h"

/* Ways of a smooth dielectric that a path must not go (path/filter.h), beside MATERIAL_*. */
#define BSDF_NO_REFLECTION 0x10000u
#define BSDF_NO_REFRACTION 0x20000u

/* The matte lobe gets what the reflection above it leaves (bsdf_energy.h). */
#define BSDF_COUPLED 0x40000u

typedef struct {
    Frame frame;        /* z is the shading normal, on wo's side */
    real3 wo;           /* towards the eye, in the frame: wo.z >= 0 */
    real3 normal_g;     /* world: geometric normal, on wo's side */
    real3 normal_s;     /* world: interpolated normal, no map; used where the surface is curved */
    bool is_curved;     /* the surface bulges over its plane: directions below the plane may be reflected */
    real3 matte;        /* reflectance */
    real3 specular;     /* reflection colour, or F0 */
    real3 transmission; /* tint of a crossing */
    real alpha_x, alpha_y;
    real eta;           /* index on wo's side over index on the other side */
    real exponent;      /* of Phong's highlight; 0: none */
    uint lobes;         /* LOBE_* */
    uint fresnel;       /* FRESNEL_* */
    uint flags;         /* MATERIAL_*, BSDF_* */
    AlbedoRoughness rough;  /* alpha 0: nothing rough */
    real3 passing;          /* coupling of the matte lobe but for what depends on wi */
    real3 passing_loss;     /* how it grows with what rough facets lose */
    real3 multiple;         /* light of more than one facet but for what depends on wi: reflected */
    real3 multiple_through; /* and refracted, with the squared index ratio */
    real multiple_reflects; /* the reflected share of it */
    real matte_size, multiple_size; /* of the albedos of the matte lobe and of the light of more than one facet */
    /* Probabilities of the matte lobe, of the glossy lobe's or the dielectric's part for one facet and for more; the rest is
       the mirror. */
    real choose_matte, choose_glossy, choose_multiple;
} Bsdf;

/* All lobes that are no delta functions, for one direction. */
typedef struct {
    real3 value; /* BSDF times |cos_i| */
    real pdf_w;  /* of sampling it, per steradian */
} BsdfValue;

/* A sampled direction. */
typedef struct {
    real3 wi;      /* world */
    real3 weight;  /* BSDF times |cos_i| over pdf, all factors inside */
    real pdf_w;    /* per steradian; 0 for a delta lobe */
    real eta;      /* relative index crossed; 1 for reflection */
    bool reflects; /* wi is on wo's side of the surface */
    bool is_valid; /* false: no direction, the path ends */
    TRACE_MEMBER(uint lobe) /* chosen */
} BsdfSample;

#endif
