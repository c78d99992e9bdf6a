// SPDX-License-Identifier: Apache-2.0
// The matte part of what leaves a second vertex (path_reuse.h): what its other lobes send to one pixel's first
// vertex says nothing of another's. The matte lobe sends the same to all, but for what a reflection above it
// lets pass on the way out (scattering/bsdf_energy.h).
#ifndef CLRT_INTEGRATORS_REUSE_MATTE_H
#define CLRT_INTEGRATORS_REUSE_MATTE_H

#include "path/walk.h"

/* Lobes that the matte one may lie below. */
#define REUSE_COVERS (LOBE_GLOSSY | LOBE_MIRROR)

/* Where they let less than this pass, the light that leaves is theirs. */
#define REUSE_LEAST_PASSING REAL(0.25)

/* What lies above a matte lobe. */
typedef struct {
    bool is_coupled;       /* it takes part of the light: */
    AlbedoRoughness rough; /* as Bsdf's */
    real3 passing_loss;
} MatteCover;

/* Whether a vertex sends light by a matte lobe that others can make use of. */
static inline bool matte_is_of_use(const Bsdf* bsdf)
{
    if (!(bsdf->lobes & LOBE_MATTE) || (bsdf->lobes & ~(LOBE_MATTE | REUSE_COVERS)) || bsdf_is_covered(bsdf))
        return false;
    return !bsdf_energy_is_coupled(bsdf) || bsdf->alpha_x == bsdf->alpha_y;
}

static inline MatteCover matte_cover(const Bsdf* bsdf)
{
    MatteCover cover;
    cover.is_coupled = bsdf_energy_is_coupled(bsdf);
    cover.rough = bsdf->rough;
    cover.passing_loss = bsdf->passing_loss;
    return cover;
}

/* The factor of the matte lobe's light towards a direction with this cosine; false where it is too small. */
static inline bool matte_passes(const MatteCover* cover, real cosine, real3* passing)
{
    *passing = (real3)(REAL(1.0));
    if (!HAS(EFFECT_GLOSSY | EFFECT_MIRROR) || !cover->is_coupled)
        return true;
    const Albedo albedo = energy_albedo(&cover->rough, vector_make(REAL(0.0), REAL(0.0), cosine));
    *passing = energy_passing(cover->passing_loss, albedo);
    return fmin(passing->x, fmin(passing->y, passing->z)) >= REUSE_LEAST_PASSING;
}

static inline real matte_share_component(real matte, real whole)
{
    return whole > REAL(0.0) ? fmin(matte / whole, REAL(1.0)) : REAL(0.0);
}

/* The share of the matte lobe in the BSDF towards a direction. */
static CLRT_NOINLINE real3 matte_share(const Bsdf* bsdf, real3 wi_world)
{
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    const real3 whole = bsdf_eval(bsdf, wi_world).value;
    const real3 matte = bsdf_matte_eval(bsdf, wi);
    return vector_make(matte_share_component(matte.x, whole.x), matte_share_component(matte.y, whole.y),
                       matte_share_component(matte.z, whole.z));
}

#endif
