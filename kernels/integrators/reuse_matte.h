// SPDX-License-Identifier: Apache-2.0
// The matte part of what leaves a second vertex (path_reuse.h): what its other lobes send to one pixel's
// first vertex says nothing of another's. The matte lobe sends the same to all, but for what a reflection
// above lets pass on the way out (scattering/bsdf_energy.h).
#ifndef CLRT_INTEGRATORS_REUSE_MATTE_H
#define CLRT_INTEGRATORS_REUSE_MATTE_H

#include "scattering/bsdf.h"

/* Lobes that the matte one may lie below or beside. */
#define REUSE_MATTE_COVERS (LOBE_GLOSSY | LOBE_MIRROR)

/* Where they let less than this pass, the light is the pixel's own: what others make of it would weigh more
   by the quotient of what passes to both, which this keeps below 4. */
#define REUSE_MATTE_LEAST_PASSING REAL(0.25)

/* What lies above a matte lobe. */
typedef struct {
    bool is_coupled;       /* it takes part of the light: */
    AlbedoRoughness rough; /* as Bsdf's */
    real3 passing_loss;
} MatteCover;

/* Whether a vertex sends light by a matte lobe that others can make use of. */
static inline bool reuse_matte_is_of_use(const Bsdf* bsdf)
{
    if (!(bsdf->lobes & LOBE_MATTE) || (bsdf->lobes & ~(LOBE_MATTE | REUSE_MATTE_COVERS)) ||
        bsdf_is_covered(bsdf) || vector_is_black(bsdf->matte))
        return false;
    return !bsdf_energy_is_coupled(bsdf) || bsdf->alpha_x == bsdf->alpha_y;
}

/* What lies above that of a vertex which is of use. */
static inline MatteCover reuse_matte_cover(const Bsdf* bsdf)
{
    MatteCover cover;
    cover.is_coupled = bsdf_energy_is_coupled(bsdf);
    cover.rough = bsdf->rough;
    cover.passing_loss = bsdf->passing_loss;
    return cover;
}

/* The factor of the matte lobe's light towards a direction with this cosine; false where it is too small. */
static inline bool reuse_matte_passes(const MatteCover* cover, real cosine, real3* passing)
{
    *passing = (real3)(REAL(1.0));
    if (!HAS(EFFECT_GLOSSY | EFFECT_MIRROR) || !cover->is_coupled)
        return true;
    const Albedo albedo =
        bsdf_energy_rough_albedo(&cover->rough, vector_make(REAL(0.0), REAL(0.0), cosine));
    *passing = bsdf_energy_rough_passing(cover->passing_loss, albedo);
    return fmin(passing->x, fmin(passing->y, passing->z)) >= REUSE_MATTE_LEAST_PASSING;
}

/* A channel of reuse_matte_share. */
static inline real reuse_matte_share_component(real matte, real whole)
{
    return whole > REAL(0.0) ? fmin(matte / whole, REAL(1.0)) : REAL(0.0);
}

/* The share of the matte lobe in the BSDF towards a direction. */
static CLRT_NOINLINE real3 reuse_matte_share(const Bsdf* bsdf, real3 wi_world)
{
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    const real3 whole = bsdf_eval(bsdf, wi_world).value;
    const real3 matte = bsdf_matte_eval(bsdf, wi);
    return vector_make(reuse_matte_share_component(matte.x, whole.x),
                       reuse_matte_share_component(matte.y, whole.y),
                       reuse_matte_share_component(matte.z, whole.z));
}

#endif
