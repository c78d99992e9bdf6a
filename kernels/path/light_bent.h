// SPDX-License-Identifier: Apache-2.0
// How a light path scatters. Beside paths from the eye (SPLATS_ARE_WEIGHTED) it leaves to them what they see
// by bent normals. Alone it finds what they see by bent normals too: the BSDF is that of the point as seen
// from the direction that has been chosen, the eye's side. Such directions may be below the horizon of the
// normal about which lobes are sampled, so some are sampled about the facet's own.
#ifndef CLRT_PATH_LIGHT_BENT_H
#define CLRT_PATH_LIGHT_BENT_H

#include "light_vertex.h"

/* Share of directions that are sampled about the facet's normal. Of those above the facet, by their cosine,
   (1 - c) / 2 are below the horizon of a normal at an angle of cosine c. */
static inline real light_bent_share(const Bsdf* bsdf)
{
    if (SPLATS_ARE_WEIGHTED || !light_vertex_is_bent() || !bsdf_has_smooth_lobe(bsdf))
        return REAL(0.0);
    return REAL(0.5) * (REAL(1.0) - real_unit(vector_dot(bsdf->frame.z, bsdf->normal_g)));
}

/* True if some lobe with a density lets light through. */
static inline bool light_bent_passes(const Bsdf* bsdf)
{
    return HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBES_GLASS);
}

/* A direction about the facet's normal, on either side where light passes; u_side chooses it. */
static inline real3 light_bent_about_facet(const Bsdf* bsdf, real u_side, real2 u)
{
    const Frame facet = frame_make(bsdf->normal_g);
    const real3 w = frame_to_world(&facet, warp_cosine_hemisphere(u));
    return light_bent_passes(bsdf) && u_side < REAL(0.5) ? -w : w;
}

/* Its density. */
static inline real light_bent_facet_pdf_w(const Bsdf* bsdf, real3 w)
{
    const real cosine = vector_dot(bsdf->normal_g, w);
    return light_bent_passes(bsdf) ? REAL(0.5) * warp_cosine_hemisphere_pdf_w(fabs(cosine))
                                   : warp_cosine_hemisphere_pdf_w(cosine);
}

/* The vertex's surface as a path that comes from direction w meets it, flat. */
static CLRT_NOINLINE Surface light_bent_surface(const Scene* scene, const LightVertex* vertex, const Hit* hit,
                                                real3 w)
{
    const Surface* surface = &vertex->surface;
    if (surface_reflects(surface, w))
        return *surface;
    Ray back = ray_make(surface->position, -w, surface_time(surface));
    ray_set_wave(surface_wave(surface), &back);
#if CLRT_EFFECTS & EFFECT_NESTED
    back.nest = surface->beyond;
#endif
    Surface other_side = surface_at(scene, hit, &back);
    other_side.is_curved = false;
    return other_side;
}

/* BSDF times cosine as seen from w, but scattering importance there as bsdf_eval does. */
static CLRT_NOINLINE real3 light_bent_value(const Scene* scene, const LightVertex* vertex, const Hit* hit,
                                            real3 w)
{
    const real3 wo = frame_to_world(&vertex->bsdf.frame, vertex->bsdf.wo);
    const real3 normal_g = vertex->bsdf.normal_g;
    const real arriving = fabs(vector_dot(normal_g, wo));
    if (arriving == REAL(0.0) || !(light_bent_passes(&vertex->bsdf) || bsdf_reflects(&vertex->bsdf, w)))
        return (real3)(REAL(0.0));
    const Surface surface = light_bent_surface(scene, vertex, hit, w);
    const Bsdf bsdf = material_bsdf(scene, &surface, w, TRANSPORT_RADIANCE);
    return bsdf_eval(&bsdf, wo).value * (fabs(vector_dot(normal_g, w)) / arriving);
}

/* True where direction w is left to paths from the eye, or to nobody: delta lobes of bent normals, of which
   mirrors send nothing and glass what it lets through at grazing incidence. `pdf_w`: 0 of a delta lobe. */
static inline bool light_bent_leaves(const LightVertex* vertex, real3 w, real pdf_w)
{
    return (SPLATS_ARE_WEIGHTED || pdf_w == REAL(0.0)) && !light_vertex_is_seen(&vertex->bsdf, w);
}

/* BSDF times cosine towards the eye along w, and the density of sampling it. */
static CLRT_NOINLINE BsdfValue light_bent_eval(const Scene* scene, const LightVertex* vertex, const Hit* hit,
                                               real3 w)
{
    const Bsdf* bsdf = &vertex->bsdf;
    if (light_bent_leaves(vertex, w, REAL(1.0)))
        return bsdf_value_none();
    BsdfValue eval = bsdf_eval(bsdf, w);
    const real share = light_bent_share(bsdf);
    if (share == REAL(0.0))
        return eval;
    eval.pdf_w = fma(share, light_bent_facet_pdf_w(bsdf, w), (REAL(1.0) - share) * eval.pdf_w);
    if (!light_vertex_is_seen(bsdf, w))
        eval.value = light_bent_value(scene, vertex, hit, w);
    return eval;
}

/* Weight and density of direction next->wi, which has been chosen. */
static inline void light_bent_weigh(const Scene* scene, const LightVertex* vertex, const Hit* hit,
                                    BsdfSample* next)
{
    const BsdfValue eval = light_bent_eval(scene, vertex, hit, next->wi);
    next->reflects = bsdf_reflects(&vertex->bsdf, next->wi);
    next->pdf_w = eval.pdf_w;
    next->weight = eval.pdf_w == REAL(0.0) ? (real3)(REAL(0.0)) : eval.value / eval.pdf_w;
    next->is_valid = !vector_is_black(next->weight);
}

/* Samples a direction, as bsdf_sample does. */
static CLRT_NOINLINE BsdfSample light_bent_sample(const Scene* scene, const LightVertex* vertex,
                                                  const Hit* hit, real u_lobe, real2 u)
{
    const Bsdf* bsdf = &vertex->bsdf;
    const real share = light_bent_share(bsdf);
    const bool is_of_facet = u_lobe < share;
    BsdfSample next =
        bsdf_sample(bsdf, is_of_facet ? u_lobe / share : (u_lobe - share) / (REAL(1.0) - share), u);
    if (is_of_facet) {
        next.wi = light_bent_about_facet(bsdf, u_lobe / share, u);
        light_bent_weigh(scene, vertex, hit, &next);
    } else if (share == REAL(0.0) || next.pdf_w == REAL(0.0)) {
        next.weight /= REAL(1.0) - share;
        next.is_valid = next.is_valid && !light_bent_leaves(vertex, next.wi, next.pdf_w);
    } else if (bsdf_eval(bsdf, next.wi).pdf_w == REAL(0.0))
        next.is_valid = false; /* on the other side of the plane than of the normal */
    else
        light_bent_weigh(scene, vertex, hit, &next);
    return next;
}

#endif
