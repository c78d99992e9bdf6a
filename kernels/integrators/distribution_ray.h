// SPDX-License-Identifier: Apache-2.0
// The rays of a distribution tree: what each carries, and how a vertex branches.
#ifndef CLRT_INTEGRATORS_DISTRIBUTION_RAY_H
#define CLRT_INTEGRATORS_DISTRIBUTION_RAY_H

#include "lights/each_light.h"
#include "path/filter.h"
#include "path/vertex.h"
#include "pixel.h"
#include "tree.h"

/* Rays that can wait at once: of each level those beside the one that is followed. Two rays leave smooth
   glass, and the branches of all levels multiply to no more than those of the first (distribution_count), so
   the depth and the most rays of a branch are enough. The host gives it as a literal (waiting_defines);
   without, it is the largest. */
#ifndef DISTRIBUTION_WAITING
#define DISTRIBUTION_WAITING 128
#endif

/* Ways from a vertex, for tree_number. */
#define WAY_REFLECTED 0u
#define WAY_REFRACTED 1u
#define WAY_ROUGH 2u
#define WAY_PASSED 3u
#define WAY_COUNT 4u

/* A ray of the tree on its way. */
typedef struct {
    Ray ray;
    LightView view;          /* whence the surface that it left looked at lights; unused where pdf_w is 0 */
    real3 weight;            /* of what it meets in the sample's radiance */
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    uint solid; /* as in Path */
#endif
#if CLRT_EFFECTS & EFFECT_THIN_WALL
    real before; /* its length up to the pane that it has passed last */
#endif
    real pdf_w;              /* of its direction, times rough over shadow rays of the vertex that it left;
                                0 for camera rays and delta lobes */
    real lift;               /* surface_lift of the ray */
    uint segment;            /* from 1 */
    uint node;               /* number in the tree (tree_number) of the ray and those beside it, */
    uint index;              /* and of the sample that its random numbers are of (sampler_branch) */
    uint share;              /* rays that the sample has branched into on the way */
    uint state;              /* of the automaton, behind all vertices so far */
} TreeRay;

/* A vertex of the tree while it is handled. */
typedef struct {
    const TreeRay* path; /* that has found it */
    const Surface* surface;
    Bsdf* bsdf;
    Sampler sampler;
    AutomatonStep step; /* where there is a path filter */
    uint rough;         /* lobes of the BSDF that have a density and are not matte */
    uint rough_rays, shadow_rays;
} TreeVertex;

static inline TreeRay distribution_first(const Scene* scene, const CameraSample* sample)
{
    TreeRay path;
    path.ray = sample->ray;
    path.view.position = sample->ray.origin;
    path.view.normal = (real3)(REAL(0.0));
    path.weight = (real3)(REAL(1.0));
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    path.solid = NO_INDEX;
#endif
#if CLRT_EFFECTS & EFFECT_THIN_WALL
    path.before = REAL(0.0);
#endif
    path.pdf_w = REAL(0.0);
    path.lift = REAL(0.0);
    path.segment = path.node = path.share = 1u;
    path.index = sampler_reverse_bits(sample->sampler.index_reversed);
    path.state = automaton_start(scene);
    return path;
}

/* The kinds of light whose emission the ray may add. */
static inline uint distribution_accepted(const TreeRay* path)
{
    return automaton_accepted(path->state);
}

/* True if the light of a kind may end a path by way of lobes that write this letter. */
static inline bool distribution_accepts(const TreeVertex* vertex, uint letter, uint kind)
{
    return !HAS(EFFECT_PATH_FILTER) || (automaton_accepted(vertex->step.next[letter]) & kind) != 0u;
}

/* True if a ray by way of lobes that write this letter may find anything. */
static inline bool distribution_continues(const TreeVertex* vertex, uint letter)
{
    return !HAS(EFFECT_PATH_FILTER) || automaton_continues(vertex->step.next[letter]);
}

/* How many of the rays that are asked for a vertex gets: the fewer, the more its ray shares the sample with
   others, so that no level of the tree has more than the first. */
static inline uint distribution_count(uint asked, uint share) { return max(asked / share, 1u); }

/* A ray that leaves the vertex on one of its ways; all but what rough lobes set besides. */
static inline TreeRay distribution_child(const Scene* scene, const TreeVertex* vertex, bool reflects,
                                         real3 wi, real3 weight, uint way, uint letter)
{
    TreeRay child = *vertex->path;
    child.ray = surface_ray(vertex->surface, reflects, wi);
    dispersion_leave(dispersion_splits(vertex->bsdf, reflects), &child.ray);
    child.weight *= weight;
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    child.solid = solid_beside(scene, vertex->surface, reflects);
#endif
#if CLRT_EFFECTS & EFFECT_THIN_WALL
    child.before = REAL(0.0);
#endif
    child.pdf_w = REAL(0.0);
    child.lift = surface_lift(vertex->surface, reflects, wi);
    ++child.segment;
    child.node = tree_number(vertex->path->node, WAY_COUNT, way);
    child.state = HAS(EFFECT_PATH_FILTER) ? vertex->step.next[letter] : STATE_OF_EVERY_PATH;
    return child;
}

/* Puts a ray on the stack. One of small weight is left out by chance, and carries more where it is not: the
   mean stays (Arvo and Kirk 1990). */
static inline uint distribution_push(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                     TreeRay child, TreeRay* stack, uint top)
{
    const real smallest = (real)params->min_contribution;
    if (vector_is_zero(child.weight))
        return top;
    if (vector_is_below(child.weight, smallest)) {
        const real survival = vector_max_component(child.weight) / smallest;
        const Sampler own = sampler_at(sampler->key, child.index);
        const bool survives = sampler_number(&own, child.node, SAMPLE_ROULETTE) < survival;
        TRACE_NUMBER(scene, TRACE_SURVIVAL, survival);
        TRACE_CHOICE(scene, TRACE_SURVIVES, survives ? 1u : 0u);
        if (!survives)
            return top;
        child.weight /= survival;
    }
    stack[top] = child;
    return top + 1u;
}

/* The length of the ray up to a hit. */
static inline real distribution_length(const TreeRay* path, const Hit* hit)
{
#if CLRT_EFFECTS & EFFECT_THIN_WALL
    return path->before + hit->t;
#else
    return hit->t;
#endif
}

/* Lets the ray pass a pane: it stays what it is. */
static CLRT_NOINLINE uint distribution_pass(const Scene* scene, const RenderParams* params,
                                            const TreeRay* path, const Surface* surface, const Hit* hit,
                                            const Sampler* sampler, const Bsdf* bsdf, TreeRay* stack,
                                            uint top)
{
    if (!visibility_is_pane(scene, hit))
        return top;
    TreeRay behind = *path;
    behind.ray = surface_ray(surface, false, path->ray.direction);
    behind.weight *= bsdf_pane_passes(bsdf);
    behind.node = tree_number(path->node, WAY_COUNT, WAY_PASSED);
#if CLRT_EFFECTS & EFFECT_THIN_WALL
    behind.before = distribution_length(path, hit);
#endif
    return distribution_push(scene, params, sampler, behind, stack, top);
}

/* Spawns the rays that smooth lobes send on, one each. */
static CLRT_NOINLINE uint distribution_spawn_smooth(const Scene* scene, const RenderParams* params,
                                                    const TreeVertex* vertex, TreeRay* stack, uint top,
                                                    real3* radiance)
{
    const Bsdf* bsdf = vertex->bsdf;
    const uint smooth =
        bsdf->lobes & (uint)BSDF_LOBES & (LOBE_MIRROR | LOBES_GLASS) & ~vertex->rough;
    if (smooth == 0u)
        return top;
    const bool dielectric = (smooth & LOBES_GLASS) != 0u;
    const SmoothRays rays =
        tree_smooth_rays(vertex->surface, bsdf, -vertex->path->ray.direction, dielectric);
    /* Which has no side, and so would be no ray. */
    nan_carry(scene, nan_of_vector(rays.reflected), radiance);
    if (rays.reflects && distribution_continues(vertex, LETTER_MIRROR))
        top = distribution_push(scene, params, &vertex->sampler,
                                distribution_child(scene, vertex, true, rays.reflected, rays.reflected_color,
                                                   WAY_REFLECTED, LETTER_MIRROR),
                                stack, top);
    if (rays.refracts && distribution_continues(vertex, LETTER_REFRACTION))
        top = distribution_push(scene, params, &vertex->sampler,
                                distribution_child(scene, vertex, false, rays.refracted, rays.refracted_color,
                                                   WAY_REFRACTED, LETTER_REFRACTION),
                                stack, top);
    return top;
}

/* One of the rays that the rough lobes, which are all that the BSDF has left, send on. */
static inline uint distribution_spawn_one(const Scene* scene, const RenderParams* params,
                                          const TreeVertex* vertex, uint which, TreeRay* stack, uint top,
                                          real3* radiance)
{
    const TreeRay* path = vertex->path;
    const uint count = vertex->rough_rays;
    const Sampler branch = sampler_branch(&vertex->sampler, count, which);
    const uint2 choice = sampler_partner_words(&branch, path->node, SAMPLE_DIRECTION);
    const BsdfSample next = bsdf_sample(vertex->bsdf, sampler_unit(choice.x),
                                        sampler_pair(&branch, path->node, SAMPLE_DIRECTION));
    TRACE_CHOICE(scene, TRACE_LOBE, next.lobe);
    TRACE_VECTOR(scene, TRACE_WI, next.wi);
    TRACE_VECTOR(scene, TRACE_WEIGHT, next.weight);
    TRACE_NUMBER(scene, TRACE_PDF, next.pdf_w);
    TRACE_CHOICE(scene, TRACE_CONTINUES, next.is_valid ? 1u : 0u);
    if (nan_carry(scene, nan_of_vector(next.wi), radiance) || !next.is_valid)
        return top;
    TreeRay child = distribution_child(scene, vertex, next.reflects, next.wi, next.weight / (real)count,
                                       WAY_ROUGH, LETTER_GLOSSY);
    child.view = lights_view(vertex->surface, bsdf_light_normal(vertex->bsdf));
    child.pdf_w = next.pdf_w * ((real)count / (real)vertex->shadow_rays);
    child.index = path->index * count + which;
    child.share = path->share * count;
    ray_cone_scatter(params, &vertex->sampler, next.pdf_w, &child.ray);
    return distribution_push(scene, params, &vertex->sampler, child, stack, top);
}

/* Spawns the rays that rough lobes send on. The BSDF keeps no other lobe. */
static CLRT_NOINLINE uint distribution_spawn_rough(const Scene* scene, const RenderParams* params,
                                                   const TreeVertex* vertex, TreeRay* stack, uint top,
                                                   real3* radiance)
{
    if (vertex->rough == 0u || !distribution_continues(vertex, LETTER_GLOSSY))
        return top;
    vertex->bsdf->lobes = vertex->rough;
    for (uint which = 0u; which < vertex->rough_rays; ++which)
        top = distribution_spawn_one(scene, params, vertex, which, stack, top, radiance);
    return top;
}

#endif
