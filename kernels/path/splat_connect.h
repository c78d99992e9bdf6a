// SPDX-License-Identifier: Apache-2.0
// A path from the eye that shares its light with splats: what it meets and what it is connected to, weighted
// against light paths too (splat_weight.h).
#ifndef CLRT_PATH_SPLAT_CONNECT_H
#define CLRT_PATH_SPLAT_CONNECT_H

#include "camera/camera.h"
#include "connect.h"
#include "splat_weight.h"

/* True if a path from a light can pass the vertex the other way, from direction wi (light_vertex.h). */
static inline bool splat_can_pass(const Bsdf* bsdf, real3 wo, real3 wi)
{
    return light_vertex_is_seen(bsdf, wo) && light_vertex_is_seen(bsdf, wi);
}

/* A segment of a path from the eye, of length t, has met a surface. */
static inline void splat_eye_meets(const RenderParams* params, const Sampler* sampler, uint segment, real t,
                                   const Surface* surface, real3 wo, SplatWeights* weights)
{
    if (segment == 1u) {
        const real2 lens = sampler_pair(sampler, 0u, SAMPLE_LENS);
        const real pdf_a =
            camera_project_at(params, surface->position, lens, surface_time(surface)).pdf_a;
        weights->open = pdf_a > REAL(0.0) ? splat_path_count(params) / pdf_a : REAL(0.0);
        weights->closed = REAL(0.0);
    } else
        splat_weights_go(t, weights);
    splat_weights_meet(surface, wo, weights);
#if EMISSION_IS_AIMED
    weights->is_inner = segment > 1u;
#endif
}

/* Whether splats find, too, what is connected to the path's present vertex, or found behind it by a
   density. */
static inline bool splat_joins(const Bsdf* bsdf, const SplatWeights* weights)
{
#if EMISSION_IS_AIMED
    return weights->is_inner && splat_is_sharp(bsdf);
#else
    return true;
#endif
}

/* True if nothing but hits finds the light that arrives at the present vertex by delta lobes: neither it nor
   any vertex before can be connected to the camera or to the one before it. */
static inline bool splat_is_alone(const SplatWeights* weights)
{
    return weights->open == REAL(0.0) && weights->closed == REAL(0.0);
}

/* It leaves the vertex in a sampled direction. */
static inline void splat_eye_leaves(const Bsdf* bsdf, real3 wo, const BsdfSample* next, SplatWeights* weights)
{
    if (!splat_can_pass(bsdf, wo, next->wi))
        weights->open = weights->closed = REAL(0.0);
    splat_weights_leave(bsdf, next->wi, next->pdf_w, weights);
#if EMISSION_IS_AIMED
    weights->is_shared = splat_joins(bsdf, weights);
#endif
}

/* Whether splats may find the light at the end of a ray that leaves the last vertex by a density, 0 for a
   delta lobe: behind a path's second vertex the same for all paths that come to it. */
static inline bool splat_may_compete(real pdf_w, const SplatWeights* weights)
{
#if EMISSION_IS_AIMED
    return pdf_w == REAL(0.0) || weights->is_shared;
#else
    return true;
#endif
}

/* True if they do. */
static inline bool splat_competes(real pdf_w, const SplatWeights* weights)
{
    return splat_may_compete(pdf_w, weights) && weights->closed > REAL(0.0);
}

/* The same of light from outside, which next-event estimation finds too or does not. Behind slabs it is left
   to that (slab.h), if it does. */
static inline bool splat_may_compete_outside(const Path* path, bool is_connected_to,
                                             const SplatWeights* weights)
{
#if HAS_SLABS
    if (path->is_behind_slabs)
        return !is_connected_to;
#endif
    return splat_may_compete(path->pdf_w, weights);
}

static inline bool splat_competes_outside(const Path* path, bool is_connected_to, const SplatWeights* weights)
{
    return splat_may_compete_outside(path, is_connected_to, weights) && weights->closed > REAL(0.0);
}

/* The weight of a hit: `light_pdf_w` is the density of next-event estimation, `emission_pdf` that of the ray
   from the light. */
static inline real splat_hit_weight(const Path* path, const SplatWeights* weights, real light_pdf_w,
                                    real emission_pdf)
{
    const real connection = path->pdf_w > REAL(0.0) ? light_pdf_w / path->pdf_w : REAL(0.0);
    return REAL(1.0) / (REAL(1.0) + connection + weights->closed * emission_pdf);
}

/* Weighted emission of the surface that was hit. */
static inline real3 splat_emission(const Scene* scene, const RenderParams* params, const Surface* surface,
                                   const Path* path, real3 wo, const SplatWeights* weights)
{
    const real3 emitted = material_emitted(scene, surface, wo);
    real light_pdf_w = REAL(0.0);
    if (path->pdf_w > REAL(0.0)) {
        if (!emitter_is_met(path->lift, path->hit.t))
            return (real3)(REAL(0.0));
        const real pdf_a = light_probability_of_emitter(scene, params, &path->view, surface->emitter);
        light_pdf_w =
            emitter_met_pdf_w(scene, surface, pdf_a, path->view.position, path->lift, path->hit.t, wo);
    }
    real emission_pdf = REAL(0.0);
    if (splat_competes(path->pdf_w, weights))
        emission_pdf = emission_triangle_ray_pdf(scene, params, surface->emitter, surface->position,
                                                 surface->normal_g, wo);
    const real weight = splat_hit_weight(path, weights, light_pdf_w, emission_pdf);
    TRACE_NUMBER(scene, TRACE_LIGHT_PDF, light_pdf_w);
    TRACE_NUMBER(scene, TRACE_LIGHT_WEIGHT, weight);
    return emitted * weight;
}

/* Weighted light from outside the scene, behind the first segment. */
static CLRT_NOINLINE real3 splat_escape(const Scene* scene, const RenderParams* params, const Path* path,
                                        const SplatWeights* weights)
{
    const real3 wi = path->ray.direction;
    const LightView* view = &path->view;
    real3 radiance = (real3)(REAL(0.0));
    const bool sky_competes = splat_competes_outside(path, slab_sky_is_sampled(params), weights);
    const bool suns_compete = splat_competes_outside(path, true, weights);
    const real disc_pdf_a = sky_competes || suns_compete
                                ? emission_disc_ray_pdf_a(scene, params, path->ray.origin, wi)
                                : REAL(0.0);
    if (HAS(EFFECT_ENVIRONMENT)) {
        const real2 place = environment_place(params, wi);
        real light_pdf_w = REAL(0.0);
        if (path->pdf_w > REAL(0.0) && params->choose_environment > 0.0f)
            light_pdf_w =
                light_probability_of_sky(scene, params, view) * sky_pdf_w(scene, params, view, wi, place);
        radiance = environment_eval_at(scene, params, place) *
                   splat_hit_weight(path, weights, light_pdf_w,
                                    sky_competes ? emission_sky_pdf_w(scene, params, wi) * disc_pdf_a
                                                 : REAL(0.0));
    }
    for (uint i = 0; HAS(EFFECT_DELTA_LIGHT) && i < params->light_count; ++i) {
        if (!delta_light_covers(scene, i, wi))
            continue;
        real light_pdf_w = REAL(0.0);
        if (path->pdf_w > REAL(0.0))
            light_pdf_w = light_probability_of_delta(scene, params, view, i) *
                          warp_cone_pdf_w((real)scene->lights[i].one_minus_cos);
        radiance += vector_from(scene->lights[i].emission) *
                    splat_hit_weight(path, weights, light_pdf_w,
                                     suns_compete ? emission_sun_pdf_w(scene, params, i) * disc_pdf_a
                                                  : REAL(0.0));
    }
    return radiance;
}

/* Density of the ray from a sampled point on an emissive triangle to the surface, over the cosine there. */
static CLRT_NOINLINE real splat_triangle_pdf(const Scene* scene, const RenderParams* params,
                                             const LightSample* light)
{
    if (!EMISSION_IS_AIMED)
        return emission_triangle_pdf(scene, params, light->light, REAL(1.0));
    real3 p0, p1, p2;
    surface_corners(scene, scene->triangles + light->triangle, &p0, &p1, &p2);
    real3 normal = vector_normalize(surface_cross(p1 - p0, p2 - p0));
    if (vector_dot(normal, light->wi) > REAL(0.0))
        normal = -normal;
    return emission_triangle_ray_pdf(scene, params, light->light, light->target, normal, -light->wi) /
           splat_cosine(normal, light->wi);
}

/* Density of the ray from a sampled light to the surface, over the cosine on the light: of a point over the
   squared distance, so that it is per area across the ray as that of light at infinity is. */
static inline real splat_sample_pdf(const Scene* scene, const RenderParams* params, const Surface* surface,
                                    const LightSample* light)
{
    if (HAS(EFFECT_AREA_LIGHT) && light->light < params->emitter_count)
        return splat_triangle_pdf(scene, params, light);
    if (HAS(EFFECT_ENVIRONMENT) && light->light == light_of_sky(params))
        return emission_sky_pdf_w(scene, params, light->wi) *
               emission_disc_ray_pdf_a(scene, params, surface->position, light->wi);
    const uint index = light->light - params->emitter_count;
    if (light->is_distant)
        return emission_sun_pdf_w(scene, params, index) *
               emission_disc_ray_pdf_a(scene, params, surface->position, light->wi);
    const real3 way = light->target - surface->position;
    return emission_point_ray_pdf_w(scene, params, index, -light->wi) / vector_dot(way, way);
}

/* Samples a light and prepares the shadow ray to it, weighted against hits and splats. */
static inline void splat_connect(const Scene* scene, const RenderParams* params, const Surface* surface,
                                 const Bsdf* bsdf, real3 wo, const SplatWeights* weights, Path* path)
{
    if (!bsdf_has_smooth_lobe(bsdf))
        return;
    LightSample light = lights_sample(scene, params, surface, bsdf_light_normal(bsdf), path->numbers.light,
                                      path->numbers.alias);
    solid_dim_light(scene, surface, &light);
    light_record(scene, &light);
    nan_watch(scene, light.wi, &path->watched);
    if (light.pdf_w == REAL(0.0))
        return;
    const BsdfValue eval = bsdf_eval(bsdf, light.wi);
    const real3 arriving = eval.value * light.radiance;
    TRACE_VECTOR(scene, TRACE_LIGHT_BSDF, eval.value);
    TRACE_NUMBER(scene, TRACE_LIGHT_BSDF_PDF, eval.pdf_w);
    TRACE_CHOICE(scene, TRACE_CONNECTS, vector_is_black(arriving) ? 0u : 1u);
    if (vector_is_black(arriving))
        return;
    real splat = REAL(0.0);
    if (splat_joins(bsdf, weights) && splat_can_pass(bsdf, wo, light.wi))
        splat = splat_weights_at(bsdf, light.wi, weights) * splat_cosine(surface->normal_g, light.wi) *
                splat_sample_pdf(scene, params, surface, &light);
    const real hit = light.is_delta ? REAL(0.0) : eval.pdf_w;
    /* The weight over the density: 1 / (1 + hit / pdf + splat / pdf) / pdf. */
    path->connection = path->throughput * arriving / (light.pdf_w + hit + splat);
    TRACE_NUMBER(scene, TRACE_LIGHT_WEIGHT, light.pdf_w / (light.pdf_w + hit + splat));
    TRACE_VECTOR(scene, TRACE_CONNECTION, path->connection);
    path->shadow = light_shadow_ray(surface, &light);
    path_note_connection(scene, surface, &light, (light.pdf_w + hit) / (light.pdf_w + hit + splat), path);
}

#endif
