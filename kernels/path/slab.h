// SPDX-License-Identifier: Apache-2.0
// Plane-parallel slabs of clear glass, such as panes that have a thickness. Each of their facets bends light,
// but behind both it goes on in the direction that it had, only shifted. So what comes from outside the scene
// in a direction reaches a point behind slabs by a path that leaves the point in that same direction: the
// connection of manifold next-event estimation (Hanika, Droske and Fascione 2015), which for light at infinity
// needs no search here, and whose Jacobian is 1.
//
// Of light that crosses a chain of facets so, next-event estimation at the vertex before the chain is one way
// to find it, and a path that is refracted at every facet by chance is the other (multiple importance
// sampling, Veach 1997). Light paths leave it to them: a chain is told from both its ends by the same rule, so
// splats and inner connections do without what begins with one. Which materials make slabs, the host has
// found (src/scene/slabs.h); whether connections cross them, it says in RenderParams.
//
// Facets are parallel as far as their corners are written: light may come out turned by SLAB_LARGEST_TURN,
// and a connection takes it from the direction that it began in.
#ifndef CLRT_PATH_SLAB_H
#define CLRT_PATH_SLAB_H

#include "film/film.h"
#include "vertex.h"

/* Whether the integrator connects vertices through slabs. */
#ifndef CONNECTS_THROUGH_SLABS
#define CONNECTS_THROUGH_SLABS 0
#endif

/* Whether there are lamps that next-event estimation finds behind slabs (slab_bend.h): said where the program
   is built. */
#ifndef LAMPS_BEHIND_SLABS
#define LAMPS_BEHIND_SLABS 0
#endif

#define HAS_SLABS                                                                                            \
    (CONNECTS_THROUGH_SLABS && HAS(EFFECT_REFRACTION) &&                                                     \
     (LAMPS_BEHIND_SLABS || HAS(EFFECT_ENVIRONMENT | EFFECT_DELTA_LIGHT)))

/* Directions before and behind a chain are the same within so many radians, a fiftieth of the sun's radius:
   facets of panes are parallel but for the roundings of their corners. */
#define SLAB_LARGEST_TURN REAL(1e-4)
/* Behind a chain is what was before it, air or whatever it is, but for so much of its index. */
#define SLAB_LARGEST_INDEX_RATIO REAL(1e-4)
/* Facets in a row. */
#define SLAB_FEWEST_FACETS 2u
#define SLAB_MOST_FACETS 16u
#define SLAB_NO_CHAIN 0xffffffffu

/* True if next-event estimation samples the sky: an even one is left to paths, but where it is seen through
   portals. */
static inline bool slab_sky_is_sampled(const RenderParams* params)
{
    return params->choose_environment > 0.0f;
}

#if HAS_SLABS
/* Facets that a path has crossed, one after the other and nothing else between them. */
typedef struct {
    real eta;    /* product of the index ratios */
    uint facets; /* their number; SLAB_NO_CHAIN: something else has been met */
} SlabChain;

static inline void slab_begin(SlabChain* chain)
{
    chain->eta = REAL(1.0);
    chain->facets = 0u;
}

static inline void slab_end(SlabChain* chain) { chain->facets = SLAB_NO_CHAIN; }

/* True if the material's facets belong to slabs. */
static inline bool slab_is_of(const Scene* scene, uint material)
{
    return (scene->materials[material].flags & MATERIAL_SLAB) != 0u;
}

/* The path leaves a surface by a delta lobe. `eta`: the index ratio that it crosses. */
static inline void slab_leave(const Scene* scene, const Surface* surface, bool reflects, real eta,
                              SlabChain* chain)
{
    if (reflects || chain->facets >= SLAB_MOST_FACETS || !slab_is_of(scene, surface->material))
        slab_end(chain);
    else {
        chain->eta *= eta;
        ++chain->facets;
    }
}

/* True if a chain is of slabs. `before`, `behind`: its directions there. */
static inline bool slab_is_straight(const SlabChain* chain, real3 before, real3 behind)
{
    if (chain->facets < SLAB_FEWEST_FACETS || chain->facets == SLAB_NO_CHAIN)
        return false;
    const real3 turn = behind - before;
    return vector_dot(turn, turn) <= SLAB_LARGEST_TURN * SLAB_LARGEST_TURN &&
           fabs(chain->eta - REAL(1.0)) <= SLAB_LARGEST_INDEX_RATIO;
}

/* The same of the chain that a path has come through, where connections cross slabs. */
static inline bool slab_is_behind(const RenderParams* params, const SlabChain* chain, real3 before,
                                  real3 behind)
{
    return (params->path_choices & SLABS_ARE_CROSSED) && slab_is_straight(chain, before, behind);
}

/* The direction behind a facet, which is of smooth glass in air and nothing else, and its index ratio;
   multiplies what passes. The ratio's square, which scales radiance, is left out: over slabs it cancels. */
static inline real3 slab_refract(const Scene* scene, const Surface* surface, real3 wo, real* eta,
                                 real3* share)
{
    global const Material* glass = scene->materials + surface->material;
    const real index = (real)MATERIAL_INDEX(*glass);
    *eta = surface->front ? REAL(1.0) / index : index;
    const real cos_o = clamp(vector_dot(wo, surface->normal_g), REAL(0.0), REAL(1.0));
    real cos_t;
    const real f = fresnel_dielectric(cos_o, *eta, &cos_t);
    *share *= vector_from(glass->transmission) * (REAL(1.0) - f);
    return fresnel_refract(wo, surface->normal_g, cos_o, cos_t, *eta);
}

/* The next surface along a ray that cut-outs and panes without a thickness do not let it pass; multiplies by
   what those before it do. */
static inline Hit slab_next_hit(const Scene* scene, const RenderParams* params, const Ray* ray, real3* share)
{
    Hit after = hit_none(REAL(0.0));
    for (;;) {
        const Hit hit = scene_closest_hit(scene, params, ray, &after);
        if (!HAS(EFFECTS_PASSED) || hit.triangle == NO_INDEX ||
            slab_is_of(scene, scene->triangles[hit.triangle].material))
            return hit;
        const Crossing crossing = visibility_crossing(scene, &hit, ray, true);
        if (vector_is_black(crossing.share))
            return hit;
        *share *= crossing.share;
        after = hit;
    }
}

/* Takes a ray through the facet that it has met, if its chain may go on. `solid`: that the ray goes through. */
static inline bool slab_cross(const Scene* scene, const Hit* hit, Ray* ray, uint* solid, SlabChain* chain,
                              real3* share)
{
    const Surface surface = surface_at(scene, hit, ray);
    solid_arrive(scene, *solid, &surface, hit->t, share);
    real eta;
    const real3 wi = slab_refract(scene, &surface, -ray->direction, &eta, share);
    slab_leave(scene, &surface, false, eta, chain);
    *ray = surface_ray(&surface, false, wi);
    *solid = solid_beside(scene, &surface, false);
    return chain->facets != SLAB_NO_CHAIN;
}

/* The share of light that reaches the end of a shadow ray, or its origin from infinity, straight or through
   slabs of at most `most` facets, 0 where there is an end; and their number. 0 where anything else is in
   between, NaNs where a coverage is one. */
static CLRT_NOINLINE real3 slab_share(const Scene* scene, const RenderParams* params, uint most,
                                      const Ray* towards, uint* facets, PixelRays* rays)
{
    *facets = 0u;
    const real3 straight = visible_passage(scene, params, towards).share;
    if (!(params->path_choices & SLABS_ARE_CROSSED) || most < SLAB_FEWEST_FACETS || !vector_is_black(straight))
        return straight;
    const real3 nothing = (real3)(REAL(0.0));
    real3 share = (real3)(REAL(1.0));
    Ray ray = *towards;
    uint solid = NO_INDEX;
    SlabChain chain;
    slab_begin(&chain);
    while (vector_max_component(share) > REAL(0.0)) {
        const Hit hit = slab_next_hit(scene, params, &ray, &share);
        ++rays->shadow;
        if (hit.triangle == NO_INDEX) {
            *facets = chain.facets;
            return slab_is_behind(params, &chain, towards->direction, ray.direction) ? share : nothing;
        }
        if (chain.facets >= most || !slab_is_of(scene, scene->triangles[hit.triangle].material))
            return nothing;
        if (!slab_cross(scene, &hit, &ray, &solid, &chain, &share))
            return nothing;
    }
    return share;
}
#endif

/* The share of light that reaches the end of a shadow ray straight on. */
static inline real3 slab_straight_share(const Scene* scene, const RenderParams* params, const Ray* ray)
{
#if HAS_SLABS
    uint facets;
    return slab_share(scene, params, 0u, ray, &facets, 0);
#else
    return visible_share(scene, params, ray);
#endif
}

#endif
