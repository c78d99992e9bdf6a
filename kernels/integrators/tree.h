// SPDX-License-Identifier: Apache-2.0
// What trees of rays share: the numbers of their rays, and the rays that smooth surfaces send on.
#ifndef CLRT_INTEGRATORS_TREE_H
#define CLRT_INTEGRATORS_TREE_H

#include "geometry/surface.h"
#include "numerics/sampler.h"
#include "scattering/bsdf.h"

/* Numbers of rays are below this: a random number's address has room for no more (sampler_address). */
#define TREE_NUMBERS (1u << 28)
#define TREE_FIRST_HASHED (TREE_NUMBERS / 2u)

/* The number of a ray's child by way `which` of `ways`, by which its random numbers are addressed. The first
   ray is 1; children of n are ways n + which as long as the numbers last, then a hash of that among the
   largest numbers: one that overflows would be the same for all deeper rays. */
static inline uint tree_number(uint parent, uint ways, uint which)
{
    const uint number = ways * parent + which;
    return number < TREE_NUMBERS ? number
                                 : TREE_FIRST_HASHED | (sampler_hash(number) & (TREE_FIRST_HASHED - 1u));
}

/* Where a smooth surface sends a ray on, and with how much of its weight. A mirror has no second ray, nor has
   a dielectric that reflects totally. What passes a pane is none either: it goes on in the same segment. It
   is put on the stack before what the pane reflects, and so followed behind that: no segment has more rays
   waiting than by glass that refracts. */
typedef struct {
    real3 reflected, reflected_color;
    real3 refracted, refracted_color;
    bool reflects, refracts;
} SmoothRays;

/* Those of a dielectric, else of a mirror. */
static inline SmoothRays tree_smooth_rays(const Surface* surface, const Bsdf* bsdf, real3 wo_world,
                                          bool dielectric)
{
    SmoothRays rays;
    const real3 n = bsdf->frame.z;
    const real cos_o = clamp(bsdf->wo.z, REAL(0.0), REAL(1.0));
    real cos_t = REAL(0.0);
    const real f = dielectric ? fresnel_dielectric(cos_o, bsdf->eta, &cos_t) : REAL(1.0);
    rays.reflected = REAL(2.0) * cos_o * n - wo_world;
    rays.reflects = surface_reflects(surface, rays.reflected);
    rays.reflected_color = dielectric ? bsdf_glass_color(bsdf) * f : bsdf_reflection_color(bsdf, cos_o);
    if (HAS(EFFECT_DISPERSION) && dielectric)
        rays.reflected_color *= dispersion_smooth_factor(bsdf, true, cos_o);
    if (dielectric && (bsdf->lobes & LOBE_MIRROR)) /* both reflections go the same way */
        rays.reflected_color += bsdf_reflection_color(bsdf, cos_o);
    if (bsdf_is_covered(bsdf))
        rays.reflected_color *= bsdf_cover(bsdf)->left;
    rays.refracts = false;
    const bool is_pane = HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE);
    if (f >= REAL(1.0) || is_pane) /* a mirror, or total reflection */
        return rays;
    rays.refracted = fresnel_refract(wo_world, n, cos_o, cos_t, bsdf->eta);
    rays.refracts = !surface_reflects(surface, rays.refracted);
    rays.refracted_color = bsdf->transmission * bsdf_cross(bsdf, REAL(1.0) - f);
    if (HAS(EFFECT_DISPERSION))
        rays.refracted_color *= dispersion_smooth_factor(bsdf, false, cos_o);
    if (bsdf_is_covered(bsdf))
        rays.refracted_color *= cover_factors(bsdf, frame_to_local(&bsdf->frame, rays.refracted)).other;
    return rays;
}

#endif
