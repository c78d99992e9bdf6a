// SPDX-License-Identifier: Apache-2.0
// Recursive ray tracing (Whitted 1980): I = I_direct + k_s I_reflected + k_t I_refracted over a tree of rays, here with
// a stack. Simulates L(D|G)?S*E. The tree ends at surfaces that only scatter diffusely, at max_depth segments, at weights
// below min_contribution, and outside the scene.
#ifndef CLRT_INTEGRATORS_WHITTED_H
#define CLRT_INTEGRATORS_WHITTED_H

#include "direct.h"
#include "path/nan.h"
#include "pixel.h"

/* Levels whose rays are numbered one by one: a random number's address has room for 2^28 of them (sampler_address). */
#define WHITTED_NUMBERED_LEVELS 28u
#define WHITTED_FIRST_HASHED (1u << (WHITTED_NUMBERED_LEVELS - 1u))

typedef struct {
    Ray ray;
    real3 weight;
    uint segment; /* of the ray, from 1 */
    uint node;    /* number of the ray in the tree, whitted_node */
} WhittedRay;

/* The number of a ray's reflected (which = 0) or refracted (1) child, by which its random numbers are addressed. The first is
   1; children of n are 2n and 2n + 1 down to the last numbered level, then a hash of them on that level: a number that
   overflows would be the same for all deeper rays. */
static inline uint whitted_node(uint parent, uint which)
{
    const uint node = 2u * parent + which;
    return node < 2u * WHITTED_FIRST_HASHED
               ? node
               : WHITTED_FIRST_HASHED | (sampler_hash(node) & (WHITTED_FIRST_HASHED - 1u));
}

/* The child of a ray: same tree, one segment on. */
static inline WhittedRay whitted_child(const WhittedRay* parent, const Surface* surface, real3 wi, real3 weight,
                                       uint which)
{
    WhittedRay child;
    child.ray = surface_ray(surface, which == 0u, wi);
    child.weight = weight;
    child.segment = parent->segment + 1u;
    child.node = whitted_node(parent->node, which);
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

/* Spawns the reflected and the refracted ray; gives the new stack size. */
static inline uint whitted_spawn(const RenderParams* params, const WhittedRay* parent, const Surface* surface,
                                 const Bsdf* bsdf, real3 wo_world, WhittedRay* stack, uint top)
{
    const bool dielectric = HAS(EFFECT_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC);
    const bool mirror = (bsdf->lobes & LOBE_MIRROR) || (bsdf->flags & MATERIAL_WHITTED_MIRROR);
    if (!dielectric && !mirror)
        return top;
    const real3 n = bsdf->frame.z;
    const real cos_o = clamp(bsdf->wo.z, REAL(0.0), REAL(1.0));
    real cos_t = REAL(0.0);
    const real f = dielectric ? fresnel_dielectric(cos_o, bsdf->eta, &cos_t) : REAL(1.0);

    const real3 reflected = REAL(2.0) * cos_o * n - wo_world;
    if (surface_reflects(surface, reflected)) {
        const real3 color = dielectric ? bsdf->specular * f : bsdf_reflection_color(bsdf, cos_o);
        top = whitted_push(params, whitted_child(parent, surface, reflected, parent->weight * color, 0u), stack, top);
    }
    if (f >= REAL(1.0)) /* a mirror, or total reflection */
        return top;
    const real3 refracted = fresnel_refract(wo_world, n, cos_o, cos_t, bsdf->eta);
    if (surface_reflects(surface, refracted))
        return top;
    const real3 color = bsdf->transmission * ((REAL(1.0) - f) * bsdf->eta * bsdf->eta);
    return whitted_push(params, whitted_child(parent, surface, refracted, parent->weight * color, 1u), stack, top);
}

static CLRT_NOINLINE real3 whitted_sample(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                          Ray ray, PixelRays* rays)
{
    real3 radiance = (real3)(REAL(0.0));
    WhittedRay stack[WHITTED_MAX_DEPTH + 1];
    uint top = 1u;
    stack[0].ray = ray;
    stack[0].weight = (real3)(REAL(1.0));
    stack[0].segment = 1u;
    stack[0].node = 1u;
    while (top != 0u) {
        const WhittedRay current = stack[--top];
        const real3 wo = -current.ray.direction;
        if (current.segment > 1u)
            ++rays->secondary;

        /* Find the surface, or the light outside the scene. */
        Hit hit = visible_hit(scene, params, sampler, current.node, &current.ray);
        TRACE_HIT(scene, current.segment, current.node, &current.ray, &hit);
        TRACE_VECTOR(scene, TRACE_THROUGHPUT, current.weight);
        nan_carry(scene, nan_of_vector(current.weight), &radiance);
        if (hit.triangle == NO_INDEX) {
            rays->missed += current.segment == 1u ? 1u : 0u;
            if (nan_carry(scene, nan_of_miss(&hit), &radiance))
                continue;
            const real3 sky =
                lights_outside(scene, params, current.segment, current.ray.direction, REAL(0.0), KINDS_ALL);
            radiance += current.weight * sky;
            TRACE_VECTOR(scene, TRACE_SKY, sky);
            TRACE_VECTOR(scene, TRACE_ADDED, current.weight * sky);
            continue;
        }
        const Surface surface = visible_surface(scene, params, &current.ray, &hit);
        TRACE_SURFACE(scene, &surface);
        if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX) {
            const real3 emitted = material_emitted(scene, &surface);
            radiance += current.weight * emitted;
            TRACE_VECTOR(scene, TRACE_EMITTED, emitted);
            TRACE_VECTOR(scene, TRACE_ADDED, current.weight * emitted);
        }
        if (current.segment >= params->max_depth) {
            /* It would have been lit, at least. */
            if (scene->materials[surface.material].lobes != 0u) {
                film_count_cut(current.weight, rays);
                TRACE_CHOICE(scene, TRACE_CUT, 1u);
            }
            continue;
        }

        /* Light it, then follow reflection and refraction. */
        const Bsdf bsdf = material_bsdf(scene, &surface, wo);
        TRACE_VECTOR(scene, TRACE_NORMAL_S, bsdf.frame.z);
        nan_carry(scene, nan_of_vector(surface.normal_g + bsdf.wo), &radiance);
        const bool highlight = !(bsdf.flags & MATERIAL_WHITTED_MIRROR);
        const real3 direct = direct_light(scene, params, sampler, current.node, &surface, &bsdf, highlight, rays);
        radiance += current.weight * direct;
        TRACE_VECTOR(scene, TRACE_ADDED, current.weight * direct);
        top = whitted_spawn(params, &current, &surface, &bsdf, wo, stack, top);
        TRACE_CHOICE(scene, TRACE_WAITING, top);
    }
    return radiance;
}

static inline void whitted_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples, uint count,
                                    PixelRays* rays)
{
    for (uint k = 0; k < count; ++k)
        samples[k].radiance = whitted_sample(scene, params, &samples[k].sampler, samples[k].ray, rays);
}

#endif
