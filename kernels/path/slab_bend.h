// SPDX-License-Identifier: Apache-2.0
// Lamps behind plane-parallel slabs of clear glass (slab.h). The path from a vertex to a point on the lamp
// has one direction outside the slabs, at an angle t to their normal, and is shifted within them: manifold
// next-event estimation (Hanika, Droske and Fascione 2015) by an equation of one unknown. With h the slabs'
// thickness together, n their index over that of what is around them and H the rest of the way along the
// normal, the way across it is
//     R(t) = H tan t + h sin t / (n^2 - sin^2 t)^(1/2),
// and the directions that lead to an area a of the lamp, whose normal has a cosine c to the path, fill
//     a c / (cos t (R / sin t) (dR / dt)),
// which is a c / d^2 where there is no glass.
//
// The straight segment tells which slabs to go through. It must meet nothing else: then there is a connection
// for each point that next-event estimation samples, and a path that is refracted there by chance can tell
// the density of it (multiple importance sampling, Veach 1997).
#ifndef CLRT_PATH_SLAB_BEND_H
#define CLRT_PATH_SLAB_BEND_H

#include "slab.h"

#if LAMPS_BEHIND_SLABS
/* A path and the connection to what it has met are the same if they leave the vertex within so many radians,
   and a connection has arrived if its end is seen within so many: other slabs, through which the bent segment
   went and the straight one did not, turn it by more. */
#define SLAB_SAME_DIRECTION REAL(1e-3)
/* But for these, over the distance: steps off facets, which shift rays, in steps off the surface at hand. */
#define SLAB_OFFSETS REAL(64.0)
/* Of Newton's method from the straight segment on: it comes nearer from one side, in the end by twice the
   digits a step. */
#define SLAB_BEND_STEPS 12

/* The slabs that a straight segment crosses. */
typedef struct {
    real3 normal;   /* of the first facet, towards where the segment begins */
    real thickness; /* together, along the normal */
    real index;
    uint facets;
} SlabStack;

/* How a connection leaves a vertex. */
typedef struct {
    real3 wi;
    real spread; /* cos t (R / sin t) (dR / dt) over the squared straight distance */
} SlabBend;

/* Takes a facet that the straight segment meets; false if it is not of a slab like those before it. */
static inline bool slab_stack_add(const Scene* scene, const Surface* surface, real* entered, SlabStack* stack)
{
    const real index = (real)MATERIAL_INDEX(scene->materials[surface->material]);
    if (stack->facets == 0u) {
        stack->normal = surface->normal_g;
        stack->index = index;
    }
    const bool enters = (stack->facets & 1u) == 0u;
    const real3 turn = surface->normal_g - stack->normal;
    if (surface->front != enters || index != stack->index ||
        !(vector_dot(turn, turn) <= SLAB_LARGEST_TURN * SLAB_LARGEST_TURN))
        return false;
    const real height = vector_dot(surface->position, stack->normal);
    if (enters)
        *entered = height;
    else
        stack->thickness += fabs(height - *entered);
    ++stack->facets;
    return true;
}

/* The slabs of at most `most` facets between a ray's origin and a point; false where anything else is. */
static CLRT_NOINLINE bool slab_find_stack(const Scene* scene, const RenderParams* params, uint most,
                                          const Ray* begun, real3 target, SlabStack* stack, PixelRays* rays)
{
    stack->normal = (real3)(REAL(0.0));
    stack->thickness = stack->index = REAL(0.0);
    stack->facets = 0u;
    Ray ray = *begun;
    ray_end_at(target, &ray);
    real entered = REAL(0.0);
    real3 unused = (real3)(REAL(1.0));
    for (;;) {
        const Hit hit = slab_next_hit(scene, params, &ray, &unused);
        ++rays->shadow;
        if (hit.triangle == NO_INDEX)
            return (stack->facets & 1u) == 0u && (stack->index > REAL(1.0) || stack->facets == 0u);
        if (stack->facets >= min(most, SLAB_MOST_FACETS) ||
            !slab_is_of(scene, scene->triangles[hit.triangle].material))
            return false;
        const Surface surface = surface_at(scene, &hit, &ray);
        if (!slab_stack_add(scene, &surface, &entered, stack))
            return false;
        ray = surface_ray(&surface, false, ray.direction);
        ray_end_at(target, &ray);
    }
}

/* The connection through slabs along a way; false where they are thicker than it is high. */
static inline bool slab_bend(const SlabStack* stack, real3 way, SlabBend* bend)
{
    const real along = vector_dot(way, stack->normal);
    const real height = fabs(along), outside = height - stack->thickness;
    const real3 aside = way - along * stack->normal;
    const real across = vector_length(aside);
    if (!(outside > REAL(0.0)))
        return false;
    /* R is concave in the tangent: no step goes too far. */
    const real square = stack->index * stack->index, more = square - REAL(1.0);
    real tangent = across / height, root;
    for (int step = 0; step < SLAB_BEND_STEPS; ++step) {
        root = real_sqrt(fma(more * tangent, tangent, square));
        const real reached = tangent * (outside + stack->thickness / root);
        const real slope = outside + stack->thickness * square / (root * root * root);
        tangent += (across - reached) / slope;
    }
    root = real_sqrt(fma(more * tangent, tangent, square));
    const real ratio = REAL(1.0) / root, one = real_sqrt(fma(tangent, tangent, REAL(1.0)));
    /* cos t (R / sin t) and (dR / dt), in the tangent: 1 / cos t is `one`. */
    const real first = outside + stack->thickness * ratio;
    const real second = one * one * (outside + stack->thickness * square * ratio * ratio * ratio);
    bend->spread = first * second / vector_dot(way, way);
    const real3 forward = stack->normal * (along > REAL(0.0) ? REAL(1.0) : REAL(-1.0));
    bend->wi = across > REAL(0.0) ? (forward + aside * (tangent / across)) / one : forward;
    return true;
}

/* True if a vertex may be connected through slabs on one side: on the far side of a curved facet the plane
   does not tell what is in front of it. */
static inline bool slab_can_begin(const Surface* surface, bool reflects)
{
    return !(HAS(EFFECT_SMOOTH_NORMALS) && surface->is_curved && !reflects);
}

/* The largest square of a turn, or of a miss over the distance, by which directions are the same. */
static inline real slab_same_square(real offset, real distance)
{
    const real angle = SLAB_SAME_DIRECTION + SLAB_OFFSETS * offset / distance;
    return angle * angle;
}

/* True if a connection leaves a vertex on the same side of its facet as the straight segment does: `facet` is
   its normal there. */
static inline bool slab_is_ahead(real3 facet, real3 straight, real3 bent)
{
    return vector_dot(straight, facet) > REAL(0.0) && vector_dot(bent, facet) > REAL(0.0);
}

/* Follows a ray through so many facets; false if it meets anything else, or leaves them turned. */
static CLRT_NOINLINE bool slab_follow(const Scene* scene, const RenderParams* params, uint facets, Ray* ray,
                                      real3* share, PixelRays* rays)
{
    const real3 before = ray->direction;
    uint solid = NO_INDEX;
    SlabChain chain;
    slab_begin(&chain);
    while (chain.facets < facets) {
        const Hit hit = slab_next_hit(scene, params, ray, share);
        ++rays->shadow;
        if (hit.triangle == NO_INDEX || !slab_is_of(scene, scene->triangles[hit.triangle].material) ||
            !slab_cross(scene, &hit, ray, &solid, &chain, share))
            return false;
    }
    return slab_is_straight(&chain, before, ray->direction);
}
#endif

#endif
