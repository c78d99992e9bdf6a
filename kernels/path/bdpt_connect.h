// SPDX-License-Identifier: Apache-2.0
// Inner connections (Veach and Guibas 1994): a vertex of the path from the eye is connected to a vertex of a
// path from a light, weighted against all other ways to find the same path (splat_weight.h).
//
// With x the eye's vertex, y the light's, d their distance, c the cosines by facets, f the densities per
// steradian at x and y towards each other and e, l what both paths carry (splat_weights_at), the weight is
//     1 / (1 + f_x c_y / d^2 l + f_y c_x / d^2 e).
// The squared distance of the geometry term goes into this sum: near vertices overflow nothing.
#ifndef CLRT_PATH_BDPT_CONNECT_H
#define CLRT_PATH_BDPT_CONNECT_H

#include "light_bent.h"
#include "light_vertices.h"
#include "splat_connect.h"

/* A vertex of the path from the eye. */
typedef struct {
    const Surface* surface;
    const Bsdf* bsdf;
    real3 wo;
    SplatWeights weights;
} EyeVertex;

/* A connection: the ray that must be free, and what then arrives. */
typedef struct {
    Ray shadow;
    real3 light;
#if FILM_MOMENTS
    real excess; /* all densities over those of hit and next-event estimation */
#endif
} InnerConnection;

/* A kept vertex as it was when the light path was there. */
static inline void bdpt_light_vertex(const Scene* scene, const KeptVertex* kept, real time,
                                     LightVertex* vertex)
{
    const Hit hit = light_vertices_hit(kept);
    const Ray ray = light_vertices_ray(kept, time);
    vertex->surface = surface_at(scene, &hit, &ray);
    light_vertex_complete(scene, -ray.direction, vertex);
}

/* The density of all other ways over that of a connection along wi, times the squared distance. `to_light`
   and `to_eye` are the densities per steradian of the vertices towards each other. */
static inline real bdpt_others(const EyeVertex* eye, const LightVertex* light, const SplatWeights* of_light,
                               real3 wi, real to_light, real to_eye)
{
    real others = to_light * splat_cosine(light->surface.normal_g, wi) *
                  splat_weights_at(&light->bsdf, -wi, of_light);
    if (splat_can_pass(eye->bsdf, eye->wo, wi))
        others += to_eye * splat_cosine(eye->surface->normal_g, wi) *
                  splat_weights_at(eye->bsdf, wi, &eye->weights);
    return others;
}

/* True if a path that comes to a vertex and leaves it along w carries one colour alone. */
static inline bool bdpt_is_alone(const Surface* surface, const Bsdf* bsdf, real3 w)
{
    return (surface_wave(surface) & WAVE_ALONE) || dispersion_splits(bsdf, surface_reflects(surface, w));
}

/* The weighted connection of two vertices, over the eye path's throughput; false where nothing can arrive. No
   path from a light comes to the eye's vertex where rays to it are lifted. */
static CLRT_NOINLINE bool bdpt_join(const Scene* scene, const EyeVertex* eye, const KeptVertex* kept,
                                    InnerConnection* connection)
{
    LightVertex light;
    bdpt_light_vertex(scene, kept, surface_time(eye->surface), &light);
    const real3 way = light.surface.position - eye->surface->position;
    const real square = vector_dot(way, way);
    if (square == REAL(0.0))
        return false;
    const real3 wi = way / real_sqrt(square);
    if (surface_is_lifted(eye->surface, surface_reflects(eye->surface, wi), wi))
        return false;
    const BsdfValue to_light = bsdf_eval(eye->bsdf, wi);
    if (vector_is_black(to_light.value))
        return false;
    const Hit hit = light_vertices_hit(kept);
    const BsdfValue to_eye = light_bent_eval(scene, &light, &hit, -wi);
    if (vector_is_black(to_eye.value))
        return false;
    const real others = bdpt_others(eye, &light, &kept->weights, wi, to_light.pdf_w, to_eye.pdf_w);
    connection->light = to_light.value * to_eye.value * vload3(0, kept->power) / (square + others);
    if (HAS(EFFECT_ATTENUATION)) {
        uint solid = solid_beside(scene, eye->surface, surface_reflects(eye->surface, wi));
        if (solid == NO_INDEX)
            solid = solid_beside(scene, &light.surface, surface_reflects(&light.surface, -wi));
        if (solid != NO_INDEX)
            connection->light *= solid_passes(scene, solid, real_sqrt(square));
    }
    /* Where both paths have dropped two colours for three times the third, one counts too often. */
    if (HAS(EFFECT_DISPERSION) && bdpt_is_alone(eye->surface, eye->bsdf, wi) &&
        bdpt_is_alone(&light.surface, &light.bsdf, -wi))
        connection->light /= REAL(3.0);
    connection->shadow = surface_shadow_ray(eye->surface, &light.surface, wi);
#if FILM_MOMENTS
    connection->excess = (square + others) / (to_light.pdf_w * splat_cosine(light.surface.normal_g, wi) *
                                              splat_weights_at(&light.bsdf, -wi, &kept->alone));
#endif
    return true;
}

#endif
