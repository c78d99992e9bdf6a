// SPDX-License-Identifier: Apache-2.0
// Weights of three ways to find the same path: the path from the eye meets the light (a hit), its last vertex
// is connected to it (next-event estimation), or the path from the light is connected to the camera (a
// splat). Each weighs by the balance heuristic, its density over the sum of all three (Veach 1997, ch. 9).
//
// With x_0 the eye, x_n on the light, f_i and r_i the densities per steradian at x_i towards the light and
// back towards the eye, N light paths a pass, p_0 the camera's density of x_1 across the ray, p_emit that of
// the ray from the light and c the cosines on both ends of a segment, by facets,
//     splat / hit = N / (p_0 c_1) prod_{0 < i < n} r_{i+1} c_i / (f_i c'_{i+1}) p_emit / r_n,
// since squared distances cancel. Both ends carry this product along (Georgiev 2012, without inner
// connections): `closed` waits for the density of a vertex, `open` is the term of the path's first vertex,
// which has none to wait for. Where a delta lobe is sampled both densities are one delta function. Russian
// roulette is left out: a weight needs to be no more than the same function of the path from both ends.
//
// Where emission is aimed (lights/emission_aim.h) splats find caustics alone: paths whose vertex next to the
// light scatters by a delta lobe, which no connection finds, or is a sharp surface (splat_is_sharp) and not
// the one that the camera sees. All others are weighed as if there were no splats.
#ifndef CLRT_PATH_SPLAT_WEIGHT_H
#define CLRT_PATH_SPLAT_WEIGHT_H

#include "light_vertex.h"
#include "scattering/bsdf_reverse.h"

/* Whether inner vertices of both paths are connected too (path/bdpt_connect.h). Then every vertex that is not
   sampled by a delta lobe has an `open` term: of the connection to the one before it. */
#ifndef INNER_CONNECTIONS
#define INNER_CONNECTIONS 0
#endif

/* Of a path from the eye: splats and inner connections over what comes next. Of a path from a light: what
   paths from the eye find, and inner connections, over the splat that comes next. */
typedef struct {
    real open, closed;
#if EMISSION_IS_AIMED
    bool is_inner; /* a path's from the eye: its present vertex is not its first */
    bool is_shared; /* and splats find, too, what it finds behind the vertex that it has left by a density */
#endif
} SplatWeights;

/* Before the first vertex of a path from the eye, and where nothing but paths from the eye is weighed. */
static inline SplatWeights splat_weights_none(void)
{
    SplatWeights weights;
    weights.open = weights.closed = REAL(0.0);
#if EMISSION_IS_AIMED
    weights.is_inner = weights.is_shared = false;
#endif
    return weights;
}

/* Smaller cosines count as this in weights, so that what is divided by one can be multiplied by it. */
#define SPLAT_SMALLEST_COS REAL(1e-6)

/* Whether a surface's reflection is so narrow that it casts caustics though it has a density: a function of
   the point alone, the same from both ends. */
static inline bool splat_is_sharp(const Bsdf* bsdf)
{
    return HAS(EFFECT_GLOSSY) && (bsdf->lobes & (LOBE_GLOSSY | LOBES_GLASS)) == LOBE_GLOSSY &&
           fmax(bsdf->alpha_x, bsdf->alpha_y) <= (real)CASTER_LARGEST_ALPHA;
}

/* Of a direction and a surface, by its plane. */
static inline real splat_cosine(real3 normal_g, real3 w)
{
    return fmax(fabs(vector_dot(normal_g, w)), SPLAT_SMALLEST_COS);
}

/* Light paths a pass over the whole picture. */
static inline real splat_path_count(const RenderParams* params) { return (real)params->light_path_count; }

/* What the next segment begins with, but for its ends: the vertex has been left along wi, with density
   `pdf_w`, 0 for a delta lobe. */
static inline void splat_weights_leave(const Bsdf* bsdf, real3 wi, real pdf_w, SplatWeights* weights)
{
    const real cosine = splat_cosine(bsdf->normal_g, wi);
    if (pdf_w == REAL(0.0))
        weights->closed *= cosine;
    else {
        const real reverse = weights->closed == REAL(0.0) ? REAL(0.0) : bsdf_pdf_w_reverse(bsdf, wi);
        weights->closed = (weights->closed * reverse + weights->open) * cosine / pdf_w;
    }
    weights->open = INNER_CONNECTIONS && pdf_w > REAL(0.0) ? REAL(1.0) / pdf_w : REAL(0.0);
}

/* Both terms behind a vertex that is left along wi to a light or to the camera. */
static inline real splat_weights_at(const Bsdf* bsdf, real3 wi, const SplatWeights* weights)
{
    if (weights->closed == REAL(0.0))
        return weights->open;
    return fma(weights->closed, bsdf_pdf_w_reverse(bsdf, wi), weights->open);
}

/* Density with which next-event estimation at a vertex finds the point that a light path has come from: as
   LightSample's. */
static CLRT_NOINLINE real splat_light_pdf(const Scene* scene, const RenderParams* params,
                                          const Emission* emission, const LightView* view)
{
    if (HAS(EFFECT_AREA_LIGHT) && emission->light < params->emitter_count) {
        Surface light;
        light.emitter = emission->light;
        light.normal_g = emission->normal_g;
        const real3 way = view->position - emission->point;
        const real distance = vector_length(way);
        const real pdf_a = light_probability_of_emitter(scene, params, view, emission->light);
        return emitter_hit_pdf_w(scene, &light, pdf_a, view->position, distance, way / distance);
    }
    if (HAS(EFFECT_ENVIRONMENT) && emission->light == light_of_sky(params)) {
        if (!(params->choose_environment > 0.0f))
            return REAL(0.0);
        const real3 wi = -emission->ray.direction;
        return light_probability_of_sky(scene, params, view) *
               sky_pdf_w(scene, params, view, wi, environment_place(params, wi));
    }
    const uint index = emission->light - params->emitter_count;
    const real chosen = light_probability_of_delta(scene, params, view, index);
    global const Light* light = scene->lights + index;
    return delta_light_has_disc(light) ? chosen * warp_cone_pdf_w((real)light->one_minus_cos) : chosen;
}

/* A segment behind a path's first has the length t. */
static inline void splat_weights_go(real t, SplatWeights* weights)
{
    if (INNER_CONNECTIONS)
        weights->open *= t * t;
}

/* A segment has met a vertex. */
static inline void splat_weights_meet(const Surface* surface, real3 wo, SplatWeights* weights)
{
    const real cosine = splat_cosine(surface->normal_g, wo);
    weights->open /= cosine;
    weights->closed /= cosine;
}

/* A light path's first segment has met a vertex at distance t. */
static inline void splat_weights_begin(const Scene* scene, const RenderParams* params,
                                       const Emission* emission, const LightVertex* vertex, real t,
                                       SplatWeights* weights)
{
    weights->closed = emission->is_delta ? REAL(0.0) : emission->cosine / emission->pdf;
    weights->open = REAL(0.0);
    if (EMISSION_IS_AIMED ? !splat_is_sharp(&vertex->bsdf) : !bsdf_has_smooth_lobe(&vertex->bsdf))
        return;
    /* Of a point, emission has a density per steradian there, next-event estimation none. */
    const bool is_point = emission->is_delta && !emission->is_distant;
    const LightView view = lights_view(&vertex->surface, bsdf_light_normal(&vertex->bsdf));
    weights->open = splat_light_pdf(scene, params, emission, &view) *
                    (is_point ? t * t : emission->cosine) / emission->pdf;
}

/* Densities of hit and next-event estimation over that of a splat. */
static inline real splat_rivals(const RenderParams* params, const LightVertex* vertex, real3 wi, real pdf_a,
                                const SplatWeights* weights)
{
    const real density = pdf_a * splat_cosine(vertex->surface.normal_g, wi);
    return splat_weights_at(&vertex->bsdf, wi, weights) * (density / splat_path_count(params));
}

/* The weight of a splat: `pdf_a` is the camera's density across the ray (CameraConnection). */
static inline real splat_weight(const RenderParams* params, const LightVertex* vertex, real3 wi, real pdf_a,
                                const SplatWeights* weights)
{
    const real density = pdf_a * splat_cosine(vertex->surface.normal_g, wi);
    return REAL(1.0) /
           fma(splat_weights_at(&vertex->bsdf, wi, weights), density / splat_path_count(params), REAL(1.0));
}

#endif
