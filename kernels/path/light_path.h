// SPDX-License-Identifier: Apache-2.0
// A path from a light: it is followed like one from the eye, but carries importance's adjoint, power, and at
// every vertex that scatters other than as a delta function it is connected to the camera. What arrives
// there is splatted on the film. In builds with -DSPLATS_ARE_WEIGHTED=1 each splat is weighted against the
// ways in which paths from the eye find the same light (path/splat_weight.h). Where emission is aimed at
// casters (lights/emission_aim.h), only paths whose first vertex scatters by a delta lobe or is sharp go on.
#ifndef CLRT_PATH_LIGHT_PATH_H
#define CLRT_PATH_LIGHT_PATH_H

#include "camera/camera_splat.h"
#include "film/moments.h"
#include "film/splat.h"
#include "guide_learn.h"
#include "light_bent.h"
#include "light_vertices.h"
#include "roulette.h"
#include "slab.h"
#include "splat_weight.h"
#include "strategies.h"

/* First segment that it may end where inner vertices are connected, if it is not asked for before: a light
   path costs as much as one from the eye, and its late vertices add little that others do not. */
#define LIGHT_CONNECTED_ROULETTE_DEPTH 2u

/* Where splats go, and what became of them. */
typedef struct {
    global long* film; /* 0: they are only looked at */
    uint replicate;
    uint fault; /* under which counter the last bad one belongs; COUNT_WORDS: none was bad */
    real3 watched; /* sum of directions and normals, for NaNs among them */
    LightVertices* kept; /* 0: no vertex is */
} SplatSink;

/* A path on its way. */
typedef struct {
    Sampler sampler;
    Emission emission;
    Ray ray;          /* the segment to trace */
    real3 throughput; /* product of BSDF times cosine over pdf */
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    uint solid; /* as in Path */
#endif
#if HAS_SLABS
    SlabChain slabs; /* since it has begun at what connections through slabs find */
#endif
    SplatWeights weights;
#if PATH_GUIDE
    bool is_specular; /* it has been scattered by delta lobes alone */
#endif
#if FILM_MOMENTS
    SplatWeights alone; /* the same without inner connections */
    real survived;      /* the probability with which roulette has let it live so far */
#endif
} LightPath;

/* The random numbers of light path `number` of a replicate: all its paths, whichever pixel's samples they
   accompany, are one net. No pixel has these keys: pictures have fewer. */
static inline Sampler light_path_sampler(const RenderParams* params, uint replicate, ulong number)
{
    return sampler_make(params->seed, 0xffffffffu - (uint)(number >> 32), replicate, (uint)number);
}

/* The sampler of the pixel's sample whose path from the eye light path `number` is connected to. */
static inline Sampler light_path_eye_sampler(const RenderParams* params, uint replicate, ulong number)
{
    const ulong of_pass = (ulong)params->width * params->height;
    const uint pixel = (uint)(number % of_pass);
    return sampler_make(params->seed, pixel, replicate, (uint)(number / of_pass));
}

/* Gives a path the time and the wave of a sample. */
static inline void light_path_join(const Sampler* sampler, LightPath* path)
{
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    path->ray.time = sampler_pair(sampler, 0u, SAMPLE_TIME).x;
#endif
    ray_set_wave(ray_sampled_wave(sampler), &path->ray);
}

/* Starts a path; false where no light has been found. */
static inline bool light_path_begin(const Scene* scene, const RenderParams* params, LightPath* path)
{
    const EmissionNumbers numbers = emission_numbers(&path->sampler);
    path->emission = emission_sample(scene, params, &numbers);
    path->ray = path->emission.ray;
    light_path_join(&path->sampler, path);
    if (HAS(EFFECT_NESTED) && !path->emission.is_distant)
        visible_find_nest(scene, params, &path->ray);
    path->throughput = (real3)(REAL(1.0));
#if FILM_MOMENTS
    path->survived = REAL(1.0);
#endif
#if PATH_GUIDE
    path->is_specular = true;
#endif
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    path->solid = NO_INDEX;
#endif
#if HAS_SLABS
    slab_begin(&path->slabs);
    const bool is_sky = path->emission.light == light_of_sky(params);
    const bool is_lamp = LAMPS_BEHIND_SLABS && path->emission.light < params->emitter_count;
    if (!(path->emission.is_distant || is_lamp) || (is_sky && !slab_sky_is_sampled(params)))
        slab_end(&path->slabs);
#endif
    TRACE_CHOICE(scene, TRACE_LIGHT_KIND, emission_kind(scene, params, path->emission.light));
    TRACE_VECTOR(scene, TRACE_LIGHT_RADIANCE, path->emission.power);
    TRACE_NUMBER(scene, TRACE_LIGHT_PDF, path->emission.pdf);
    return path->emission.pdf != REAL(0.0) && !vector_is_black(path->emission.power);
}

/* A NaN where a connection has one, else 0; positions far beside the film may be infinite. */
static inline real light_path_nan_of(const CameraConnection* camera)
{
    const real numbers[] = {camera->film.x, camera->film.y, camera->pdf_a};
    real nan = nan_of_vector(camera->lens);
    for (uint i = 0u; i < 3u; ++i)
        nan += real_is_nan(numbers[i]) ? numbers[i] : REAL(0.0);
    return nan;
}

#if FILM_MOMENTS
/* Its throughput without roulette. */
static inline real light_path_size(const LightPath* path)
{
    return vector_max_component(path->throughput) * path->survived;
}
#endif

/* What a vertex sends to the camera: radiance as one of a pass's light paths brings it, and where to. */
typedef struct {
    real2 film;
    real3 radiance;
#if FILM_MOMENTS
    uint slot;
    real excess; /* all densities over those of hit and next-event estimation */
#endif
} LightSplat;

/* Connects the vertex to the camera; false where nothing arrives in the window. `segment` counts the path's
   segments up to the vertex. */
static CLRT_NOINLINE bool light_path_connect(const Scene* scene, const RenderParams* params, uint segment,
                                             const Hit* hit, const LightVertex* vertex, const LightPath* path,
                                             LightSplat* arriving, real3* watched, PixelRays* rays)
{
    const Surface* surface = &vertex->surface;
    const real2 lens = sampler_pair(&path->sampler, segment, SAMPLE_LENS);
    const CameraConnection camera =
        camera_project_at(params, surface->position, lens, surface_time(surface));
    *watched += light_path_nan_of(&camera);
    if (!(camera.pdf_a > REAL(0.0)))
        return false;
    const real3 way = camera.lens - surface->position;
    const real3 wi = vector_normalize(way);
    const BsdfValue eval = light_bent_eval(scene, vertex, hit, wi);
    TRACE_VECTOR(scene, TRACE_LIGHT_BSDF, eval.value);
    if (vector_is_black(eval.value))
        return false;
    const real per_pixel = camera.pdf_a / splat_path_count(params);
    real3 radiance = path->emission.power * path->throughput * eval.value * per_pixel;
    const uint solid = solid_beside(scene, surface, surface_reflects(surface, wi));
    if (HAS(EFFECT_ATTENUATION) && solid != NO_INDEX)
        radiance *= solid_passes(scene, solid, vector_length(way));
    if (SPLATS_ARE_WEIGHTED)
        radiance *= splat_weight(params, vertex, wi, camera.pdf_a, &path->weights);
    /* Positions outside the window ask for no shadow ray. */
    const real u = sampler_number(&path->sampler, segment, SAMPLE_SPLAT);
    const CameraSplat splat = camera_splat(params, camera.film, u);
    uint slot;
    if (!tile_slot_at(params, splat.film, &slot))
        return false;
    Ray shadow = surface_ray(surface, surface_reflects(surface, wi), wi);
    ray_end_at(camera.lens, &shadow);
    ++rays->shadow;
    arriving->film = splat.film;
    arriving->radiance = radiance * splat.weight * slab_straight_share(scene, params, &shadow);
    TRACE_VECTOR(scene, TRACE_CONNECTION, arriving->radiance);
#if FILM_MOMENTS
    arriving->slot = slot;
    arriving->excess = (REAL(1.0) + splat_rivals(params, vertex, wi, camera.pdf_a, &path->weights)) /
                       splat_rivals(params, vertex, wi, camera.pdf_a, &path->alone);
    arriving->excess *= roulette_rarity(segment + 1u, params->roulette_depth, REAL(1.0),
                                        light_path_size(path), path->survived);
#endif
    return true;
}

/* Splats what the vertex sends to the camera. */
static inline void light_path_splat(const Scene* scene, const RenderParams* params, uint segment,
                                    const Hit* hit, const LightVertex* vertex, const LightPath* path,
                                    SplatSink* sink, PixelRays* rays)
{
    LightSplat splat;
    if (!light_path_connect(scene, params, segment, hit, vertex, path, &splat, &sink->watched, rays))
        return;
    const uint fault = film_splat(params, sink->film, sink->replicate, &path->sampler, segment, splat.film,
                                  splat.radiance);
    if (fault != COUNT_WORDS)
        sink->fault = fault;
    else
        strategies_splat(params, sink->film, &path->sampler, segment, splat.film, splat.radiance);
#if FILM_MOMENTS
    moments_add_splat(params, sink->film, splat.slot, &path->sampler, segment, splat.radiance, splat.excess);
#endif
}

/* Ends paths of small throughput without bias. Where inner vertices are connected, those that weigh less than
   at first may be ended at once: with the threshold bdpt traces a fifth more rays and errs no less. */
static inline bool light_path_survives(const Scene* scene, const RenderParams* params, uint segment,
                                       LightPath* path)
{
    const uint latest = INNER_CONNECTIONS ? LIGHT_CONNECTED_ROULETTE_DEPTH : params->roulette_depth;
    if (segment < min(params->roulette_depth, latest))
        return true;
    const real size = vector_max_component(path->throughput);
    const real survival = roulette_survival(INNER_CONNECTIONS ? size * ROULETTE_THRESHOLD : size);
    const bool survives = !(sampler_number(&path->sampler, segment, SAMPLE_ROULETTE) >= survival);
    TRACE_CHOICE(scene, TRACE_SURVIVES, survives ? 1u : 0u);
    path->throughput /= survival;
#if FILM_MOMENTS
    path->survived *= survival;
#endif
    return survives;
}

/* Whether emission was aimed at what ends a path's segment: a delta lobe or a sharp surface there makes
   caustics, and nothing else is looked for. */
static inline bool light_path_is_at_caster(uint segment) { return EMISSION_IS_AIMED && segment == 1u; }

/* Whether paths from the eye are left to find what comes from outside where this one has, by lobes with a
   density at the surface that it has met (slab.h). */
static inline bool light_path_is_behind_slabs(const Scene* scene, const RenderParams* params,
                                              const Surface* met, const LightPath* path)
{
#if HAS_SLABS
    return path->emission.is_distant &&
           slab_is_behind(params, &path->slabs, path->emission.ray.direction, path->ray.direction) &&
           solid_beside(scene, met, true) == NO_INDEX;
#else
    return false;
#endif
}

/* Behind slabs the next-event estimation of path finds the lamp, too, where that of these integrators does
   not: for a pilot, with the density that it would have without the glass, which bends little. */
static inline void light_path_open_alone(const Scene* scene, const RenderParams* params,
                                         const LightVertex* vertex, LightPath* path)
{
#if FILM_MOMENTS && LAMPS_BEHIND_SLABS
    if (path->emission.light >= params->emitter_count || !bsdf_has_smooth_lobe(&vertex->bsdf) ||
        !slab_is_straight(&path->slabs, path->emission.ray.direction, path->ray.direction) ||
        solid_beside(scene, &vertex->surface, true) != NO_INDEX)
        return;
    const LightView view = lights_view(&vertex->surface, bsdf_light_normal(&vertex->bsdf));
    path->alone.open = splat_light_pdf(scene, params, &path->emission, &view) * path->emission.cosine /
                       (path->emission.pdf * splat_cosine(vertex->surface.normal_g, path->ray.direction));
#endif
}

/* The vertex at the end of a segment; false where nothing is scattered on. */
static inline bool light_path_meet(const Scene* scene, const RenderParams* params, uint segment, Hit* hit,
                                   LightPath* path, LightVertex* vertex, real3* watched)
{
    light_vertex_set(scene, params, &path->ray, hit, vertex);
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    solid_arrive(scene, path->solid, &vertex->surface, hit->t, &path->throughput);
#endif
    const real3 wo = -path->ray.direction;
    *watched += vertex->surface.position + vertex->surface.normal_g + vertex->bsdf.wo + vertex->bsdf.frame.z;
    if (vertex->bsdf.lobes == 0u)
        return false;
    if (SPLATS_ARE_WEIGHTED && !light_vertex_is_seen(&vertex->bsdf, wo))
        return false;
    if (SPLATS_ARE_WEIGHTED) {
        if (segment == 1u)
            splat_weights_begin(scene, params, &path->emission, vertex, hit->t, &path->weights);
        else
            splat_weights_go(hit->t, &path->weights);
        splat_weights_meet(&vertex->surface, wo, &path->weights);
#if FILM_MOMENTS
        if (segment == 1u)
            path->alone = path->weights;
        else
            splat_weights_meet(&vertex->surface, wo, &path->alone);
        light_path_open_alone(scene, params, vertex, path);
#endif
    }
    return true;
}

/* Leaves the vertex in a sampled direction; false where the path ends. */
static inline bool light_path_leave(const Scene* scene, const RenderParams* params, uint segment,
                                    const Hit* hit, const LightVertex* vertex, LightPath* path,
                                    real3* watched, PixelRays* rays)
{
    const Bsdf* bsdf = &vertex->bsdf;
    const real2 direction = sampler_pair(&path->sampler, segment, SAMPLE_DIRECTION);
    const uint2 choices = sampler_partner_words(&path->sampler, segment, SAMPLE_DIRECTION);
    const BsdfSample next = light_bent_sample(scene, vertex, hit, sampler_unit(choices.x), direction);
    *watched += next.wi;
    if (!next.is_valid)
        return false;
    if (next.pdf_w > REAL(0.0) &&
        ((light_path_is_at_caster(segment) && !splat_is_sharp(bsdf)) ||
         light_path_is_behind_slabs(scene, params, &vertex->surface, path)))
        return false;
    TRACE_CHOICE(scene, TRACE_LOBE, next.lobe);
    TRACE_VECTOR(scene, TRACE_WI, next.wi);
    path->throughput *= next.weight;
    TRACE_VECTOR(scene, TRACE_THROUGHPUT, path->throughput);
    if (!light_path_survives(scene, params, segment, path))
        return false;
    if (segment + 1u >= params->max_depth) {
        film_count_cut(path->throughput, rays);
        return false;
    }
    if (SPLATS_ARE_WEIGHTED)
        splat_weights_leave(bsdf, next.wi, next.pdf_w, &path->weights);
#if FILM_MOMENTS
    splat_weights_leave(bsdf, next.wi, next.pdf_w, &path->alone);
    path->alone.open = REAL(0.0);
#endif
#if HAS_SLABS
    if (next.pdf_w == REAL(0.0))
        slab_leave(scene, &vertex->surface, next.reflects, next.eta, &path->slabs);
    else
        slab_end(&path->slabs);
#endif
#if PATH_GUIDE
    path->is_specular = path->is_specular && next.pdf_w == REAL(0.0);
#endif
    path->ray = surface_ray(&vertex->surface, next.reflects, next.wi);
    dispersion_leave(dispersion_splits(bsdf, next.reflects), &path->ray);
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    path->solid = solid_beside(scene, &vertex->surface, next.reflects);
#endif
    return true;
}

/* Keeps the vertex for connections; `vertices` may be 0. */
static inline void light_path_keep(uint segment, const Hit* hit, const LightPath* path,
                                   LightVertices* vertices)
{
    KeptVertex* kept = light_vertices_keep(&path->sampler, segment, hit, &path->ray,
                                           path->emission.power * path->throughput, vertices);
    if (kept == 0)
        return;
    kept->weights = path->weights;
#if FILM_MOMENTS
    kept->alone = path->alone;
    kept->survived = path->survived;
    kept->size = light_path_size(path);
#endif
}

/* Teaches guides of paths from the eye whence the vertex is lit by mirrors and glass, if rays can meet the
   light. */
static inline void light_path_teach(const Scene* scene, const RenderParams* params, uint segment,
                                    const Hit* hit, const LightVertex* vertex, const LightPath* path)
{
#if PATH_GUIDE
    if (INNER_CONNECTIONS && segment > 1u && path->is_specular && !path->emission.is_delta &&
        guide_suits(&vertex->bsdf) && guide_teaches(params, &path->sampler))
        guide_learn_light(scene, params, &path->ray, hit, path->emission.power * path->throughput);
#endif
}

/* Handles the vertex at the end of a segment; false where the path ends. */
static CLRT_NOINLINE bool light_path_vertex(const Scene* scene, const RenderParams* params, uint segment,
                                            Hit* hit, LightPath* path, SplatSink* sink, PixelRays* rays)
{
    LightVertex vertex;
    if (!light_path_meet(scene, params, segment, hit, path, &vertex, &sink->watched))
        return false;
    if (bsdf_has_smooth_lobe(&vertex.bsdf) && !light_path_is_at_caster(segment) &&
        !light_path_is_behind_slabs(scene, params, &vertex.surface, path)) {
        light_path_splat(scene, params, segment, hit, &vertex, path, sink, rays);
        light_path_keep(segment, hit, path, sink->kept);
        light_path_teach(scene, params, segment, hit, &vertex, path);
    }
    return light_path_leave(scene, params, segment, hit, &vertex, path, &sink->watched, rays);
}

/* Follows light path `number` of the sink's replicate to its end. */
static CLRT_NOINLINE void light_path_trace(const Scene* scene, const RenderParams* params, ulong number,
                                           SplatSink* sink, PixelRays* rays)
{
    LightPath path;
    path.sampler = light_path_sampler(params, sink->replicate, number);
    if (!light_path_begin(scene, params, &path))
        return;
#if INNER_CONNECTIONS && (CLRT_EFFECTS & (EFFECT_MOTION_BLUR | EFFECT_DISPERSION))
    const Sampler eye = light_path_eye_sampler(params, sink->replicate, number);
    light_path_join(&eye, &path);
#endif
    for (uint segment = 1u; segment < params->max_depth; ++segment) {
        Hit hit = vertex_hit(scene, params, &path.sampler, segment, 0u, &path.ray, &path.throughput);
        ++rays->secondary;
        if (hit.triangle == NO_INDEX) {
            sink->watched += nan_of_miss(&hit);
            break;
        }
        if (!light_path_vertex(scene, params, segment, &hit, &path, sink, rays))
            break;
    }
    sink->watched += nan_of_vector(path.throughput + path.emission.power + path.emission.pdf);
}

#endif
