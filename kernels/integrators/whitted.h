// SPDX-License-Identifier: Apache-2.0
// Recursive ray tracing (Whitted 1980): I = I_direct + k_s I_reflected + k_t I_refracted over a tree of rays,
// here with a stack. Simulates L(D|G)?S*E. The tree ends at surfaces that only scatter diffusely, at
// max_depth segments, at weights below min_contribution, and outside the scene.
#ifndef CLRT_INTEGRATORS_WHITTED_H
#define CLRT_INTEGRATORS_WHITTED_H

#include "direct.h"
#include "pixel.h"
#include "tree.h"

typedef struct {
    Ray ray;
    real3 weight;
    uint segment; /* of the ray, from 1 */
    uint node;    /* number of the ray in the tree, tree_number */
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    uint solid; /* as in Path */
#endif
} WhittedRay;

/* The reflected (which = 0) or refracted (1) child of a ray: same tree, one segment on. */
static inline WhittedRay whitted_child(const Scene* scene, const WhittedRay* parent, const Surface* surface,
                                       const Bsdf* bsdf, real3 wi, real3 weight, uint which)
{
    WhittedRay child;
    child.ray = surface_ray(surface, which == 0u, wi);
    dispersion_leave(which == 1u && dispersion_of(bsdf) != WAVE_NONE, &child.ray);
    child.weight = weight;
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    child.solid = solid_beside(scene, surface, which == 0u);
#endif
    child.segment = parent->segment + 1u;
    child.node = tree_number(parent->node, 2u, which);
    return child;
}

/* Puts a ray on the stack if it can still matter. */
static inline uint whitted_push(const RenderParams* params, WhittedRay child, WhittedRay* stack, uint top)
{
    if (vector_is_below(child.weight, (real)params->min_contribution) || vector_is_zero(child.weight))
        return top;
    stack[top] = child;
    return top + 1u;
}

/* Lets the ray pass a pane; gives the new stack size. */
static inline uint whitted_pass(const Scene* scene, const RenderParams* params, const WhittedRay* parent,
                                const Surface* surface, WhittedRay* stack, uint top)
{
    if (!HAS(EFFECT_THIN_WALL) || !(scene->materials[surface->material].lobes & LOBE_PANE))
        return top;
    const Bsdf bsdf = material_bsdf(scene, surface, -parent->ray.direction, TRANSPORT_RADIANCE);
    WhittedRay behind = *parent;
    behind.ray = surface_ray(surface, false, parent->ray.direction);
    behind.weight *= bsdf_pane_passes(&bsdf);
    behind.node = tree_number(parent->node, 2u, 1u);
    return whitted_push(params, behind, stack, top);
}

/* Spawns the reflected and the refracted ray; gives the new stack size. */
static inline uint whitted_spawn_children(const Scene* scene, const RenderParams* params,
                                          const WhittedRay* parent, const Surface* surface, const Bsdf* bsdf,
                                          real3 wo_world, WhittedRay* stack, uint top)
{
    const bool is_pane = HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE);
    const bool dielectric = is_pane || (HAS(EFFECT_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC));
    const bool mirror = (bsdf->lobes & LOBE_MIRROR) || (bsdf->flags & MATERIAL_WHITTED_MIRROR);
    if (!dielectric && !mirror && !(bsdf->lobes & LOBE_COAT))
        return top;
    SmoothRays rays = tree_smooth_rays(surface, bsdf, wo_world, dielectric);
    if (HAS(EFFECT_COAT) && (bsdf->lobes & LOBE_COAT) && !(bsdf->flags & BSDF_INSIDE)) {
        /* The coat is a mirror too; where nothing below is one, it is the only one. */
        rays.reflected_color = (dielectric || mirror ? rays.reflected_color : (real3)(REAL(0.0))) +
                               (real3)(REAL(1.0) - bsdf_cover(bsdf)->coat_left);
    }
    if (rays.reflects) {
        const real3 weight = parent->weight * rays.reflected_color;
        top = whitted_push(params, whitted_child(scene, parent, surface, bsdf, rays.reflected, weight, 0u),
                           stack, top);
    }
    if (rays.refracts) {
        const real3 weight = parent->weight * rays.refracted_color;
        top = whitted_push(params, whitted_child(scene, parent, surface, bsdf, rays.refracted, weight, 1u),
                           stack, top);
    }
    return top;
}

/* The same for a surface that is lit; the rays that wait then are part of the record. */
static inline uint whitted_spawn(const Scene* scene, const RenderParams* params, const WhittedRay* parent,
                                 const Surface* surface, const Bsdf* bsdf, WhittedRay* stack, uint top)
{
    const uint waiting =
        whitted_spawn_children(scene, params, parent, surface, bsdf, -parent->ray.direction, stack, top);
    TRACE_CHOICE(scene, TRACE_WAITING, waiting);
    return waiting;
}

/* Finds where a ray of the tree ends. */
static inline Hit whitted_hit(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                              WhittedRay* current, real3* radiance)
{
    const Hit hit = vertex_hit(scene, params, sampler, current->segment, current->node, &current->ray, 0);
    TRACE_VECTOR(scene, TRACE_THROUGHPUT, current->weight);
    nan_carry(scene, nan_of_vector(current->weight), radiance);
    return hit;
}

/* Adds the light from outside the scene. */
static inline void whitted_escape(const Scene* scene, const RenderParams* params, const WhittedRay* current,
                                  const Hit* hit, real3* radiance, PixelRays* rays)
{
    rays->missed += current->segment == 1u ? 1u : 0u;
    if (nan_carry(scene, nan_of_miss(hit), radiance))
        return;
    const real3 sky = vertex_sky(scene, params, current->segment, 0, &current->ray, REAL(0.0), KINDS_ALL);
    vertex_add(scene, current->weight * sky, radiance);
}

/* Counts a ray that max_depth ends: its surface would have been lit, at least. */
static inline void whitted_cut(const Scene* scene, const WhittedRay* current, const Surface* surface,
                               PixelRays* rays)
{
    if (scene->materials[surface->material].lobes == 0u)
        return;
    film_count_cut(current->weight, rays);
    TRACE_CHOICE(scene, TRACE_CUT, 1u);
}

/* Handles the end of a ray: adds the light there, and puts the rays that reflection and refraction send on
   upon the stack; gives its new size. */
static inline uint whitted_vertex(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                  WhittedRay* current, WhittedRay* stack, uint top, real3* radiance,
                                  PixelRays* rays)
{
    Hit hit = whitted_hit(scene, params, sampler, current, radiance);
    if (hit.triangle == NO_INDEX) {
#if CLRT_EFFECTS & EFFECT_ATTENUATION
        solid_escape(scene, current->solid, &current->weight);
#endif
        whitted_escape(scene, params, current, &hit, radiance, rays);
        return top;
    }
    const real3 wo = -current->ray.direction;
    const Surface surface = visible_surface(scene, params, &current->ray, &hit);
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    solid_arrive(scene, current->solid, &surface, hit.t, &current->weight);
#endif
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX)
        vertex_add(scene, current->weight * material_emitted(scene, &surface, wo), radiance);
    top = whitted_pass(scene, params, current, &surface, stack, top);
    if (current->segment >= params->max_depth) {
        whitted_cut(scene, current, &surface, rays);
        return top;
    }
    const Bsdf bsdf = vertex_bsdf(scene, &surface, wo);
    nan_carry(scene, nan_of_vector(surface.normal_g + bsdf.wo), radiance);
    const bool highlight = !(bsdf.flags & MATERIAL_WHITTED_MIRROR);
    const real3 direct =
        direct_light(scene, params, sampler, current->node, &surface, &bsdf, highlight, rays);
    vertex_add(scene, current->weight * direct, radiance);
    return whitted_spawn(scene, params, current, &surface, &bsdf, stack, top);
}

static CLRT_NOINLINE real3 whitted_sample(const Scene* scene, const RenderParams* params,
                                          const Sampler* sampler, Ray ray, PixelRays* rays)
{
    real3 radiance = (real3)(REAL(0.0));
    WhittedRay stack[WHITTED_MAX_DEPTH + 1];
    uint top = 1u;
    stack[0].ray = ray;
    stack[0].weight = (real3)(REAL(1.0));
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    stack[0].solid = NO_INDEX;
#endif
    stack[0].segment = 1u;
    stack[0].node = 1u;
    while (top != 0u) {
        WhittedRay current = stack[--top];
        rays->secondary += current.segment > 1u ? 1u : 0u;
        top = whitted_vertex(scene, params, sampler, &current, stack, top, &radiance, rays);
    }
    return radiance;
}

static inline void whitted_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples,
                                    uint count, PixelRays* rays)
{
    for (uint k = 0; k < count; ++k)
        samples[k].radiance = whitted_sample(scene, params, &samples[k].sampler, samples[k].ray, rays);
}

#endif
