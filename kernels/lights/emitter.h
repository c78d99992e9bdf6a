// SPDX-License-Identifier: Apache-2.0
// Emissive triangles: chosen by a table or by the tree, sampled by solid angle where they look large, else by
// area.
#ifndef CLRT_LIGHTS_EMITTER_H
#define CLRT_LIGHTS_EMITTER_H

#include "light_sample.h"
#include "scattering/material.h"
#include "spherical_triangle.h"

/* Density per steradian at distance d of a density per area; cos_l is the cosine on the light. */
static inline real emitter_pdf_w(real pdf_a, real distance_squared, real cos_l)
{
    return pdf_a * distance_squared / cos_l;
}

/* Density per steradian where the point is uniform in the triangle's solid angle. */
static inline real emitter_pdf_of_angle(real pdf_a, real3 normal, real solid_angle)
{
    const real area = vector_length(normal) * (REAL(0.5) / (SURFACE_EDGE_SCALE * SURFACE_EDGE_SCALE));
    return pdf_a * area / solid_angle;
}

/* Index of the emitter that a word and an alias word choose by the table. */
static inline uint emitter_choose(const Scene* scene, const RenderParams* params, uint word, uint alias_word)
{
    const uint slot = warp_index(word, params->emitter_count);
    return alias_word < scene->emitters[slot].threshold ? slot : scene->emitters[slot].alias;
}

/* A point on an emitter that was chosen with probability pdf_a over its area. */
CLRT_GIVES_STRUCT LightSample emitter_sample_chosen(const Scene* scene, uint chosen, real pdf_a,
                                                    real3 position, real2 u)
{
    LightSample sample = light_sample_none();
    global const Emitter* emitter = scene->emitters + chosen;
    global const Triangle* triangle = scene->triangles + emitter->triangle;
    real3 p0, p1, p2;
    surface_corners(scene, triangle, &p0, &p1, &p2);
    const real3 e1 = p1 - p0;
    const real3 e2 = p2 - p0;
    const real3 normal = surface_cross(e1, e2);
    const EmitterShare share = emitter_part_of(scene, chosen);
    real3 q0 = p0, q1 = p1, q2 = p2, part_normal = normal;
    emitter_part_corners(&share, &q0, &q1, &q2, &part_normal);
    real2 b = warp_triangle(u);
    real solid_angle = REAL(0.0);
    if (spherical_triangle_is_near(q0 - position, q1 - q0, q2 - q0, part_normal)) {
        const SphericalTriangle seen =
            spherical_triangle_make(q0 - position, q1 - position, q2 - position, part_normal);
        solid_angle = seen.solid_angle;
        if (solid_angle > REAL(0.0))
            b = spherical_triangle_sample(&seen, u);
    }
    b = emitter_part_weights(&share, b);
    const real3 point = p0 + fma((real3)(b.x), e1, b.y * e2);
    const real3 way = point - position;
    const real facing = -vector_dot(way, normal);
    const bool front =
        (facing > REAL(0.0)) != surface_winding_is_reversed(scene, triangle, 0u, REAL(0.0), normal);
    global const Material* material = scene->materials + triangle->material;
    const bool shines = facing != REAL(0.0) && material_emits(material, front);
    if (!shines && !real_is_nan(facing))
        return sample;
    /* The shadow ray ends off the triangle by its error bound, or up to sqrt(3) times that. */
    const real step = surface_offset_bound(p0, p1, p2) / vector_max_abs(normal);
    sample.target = point + normal * copysign(step, facing);
    sample.triangle = emitter->triangle;
    const real distance = vector_length(way);
    sample.wi = way / distance;
    sample.is_distant = false;
    sample.is_delta = false;
    /* facing is cos_l times the lengths of way and normal. */
    sample.pdf_w = solid_angle > REAL(0.0) ? emitter_pdf_of_angle(pdf_a, part_normal, solid_angle)
                                           : pdf_a * distance * distance *
                                                 (distance * vector_length(normal) / fabs(facing));
    const Uv uv = uv_at(scene, triangle, b.x, b.y);
    sample.radiance = material_emission(scene, triangle->material, uv,
                                        facing / (distance * vector_length(normal)));
    /* What a cut-out leaves of itself: rays that hit it by chance are passed as often. */
    if (HAS(EFFECT_CUT_OUT) && (material->flags & MATERIAL_CUT_OUT))
        sample.radiance *= material_coverage(scene, material, uv);
    return sample;
}

/* Chooses a triangle by the table and a point on it. `word` gives the index and, by its rest, the point's
   first coordinate; v is the second. */
static inline LightSample emitter_sample(const Scene* scene, const RenderParams* params, real3 position,
                                         uint word, uint alias_word, real v)
{
    const uint chosen = emitter_choose(scene, params, word, alias_word);
    const real2 u = (real2)(warp_rest(word, params->emitter_count, alias_word), v);
    return emitter_sample_chosen(scene, chosen, (real)scene->emitters[chosen].pdf_a, position, u);
}

/* Density with which emitter_sample_chosen at `from` finds the direction to a point of an emitter that was
   hit at distance t. */
static CLRT_NOINLINE real emitter_hit_pdf_w(const Scene* scene, const Surface* surface, real pdf_a,
                                            real3 from, real t, real3 wo)
{
    global const Emitter* emitter = scene->emitters + surface->emitter;
    real3 p0, p1, p2;
    surface_corners(scene, scene->triangles + emitter->triangle, &p0, &p1, &p2);
    real3 normal = surface_cross(p1 - p0, p2 - p0);
    const EmitterShare share = emitter_part_of(scene, surface->emitter);
    emitter_part_corners(&share, &p0, &p1, &p2, &normal);
    if (spherical_triangle_is_near(p0 - from, p1 - p0, p2 - p0, normal)) {
        const SphericalTriangle seen = spherical_triangle_make(p0 - from, p1 - from, p2 - from, normal);
        if (seen.solid_angle > REAL(0.0))
            return emitter_pdf_of_angle(pdf_a, normal, seen.solid_angle);
    }
    const real cos_l = vector_dot(surface->normal_g, wo);
    return cos_l > REAL(0.0) ? emitter_pdf_w(pdf_a, t * t, cos_l) : REAL(0.0);
}

/* The same for a ray that started above `from`, on a curved surface (light_from_curved). */
static CLRT_NOINLINE real emitter_lifted_pdf_w(const Scene* scene, const Surface* surface, real pdf_a,
                                               real3 from, real t, real3 wo)
{
    const real3 way = surface->position - from;
    const real distance = vector_length(way);
    const real ratio = light_density_ratio(-t * wo, way, surface->normal_g);
    if (!(ratio > REAL(0.0) && ratio < REAL_FAR))
        return REAL(0.0);
    return ratio * emitter_hit_pdf_w(scene, surface, pdf_a, from, distance, way / -distance);
}

/* Whether a ray may see a lamp at distance t by a lobe with a density. `lift`: surface_lift of the ray. Lamps
   above the facet's plane are seen from the facet alone, or they would be seen twice. */
static inline bool emitter_is_met(real lift, real t)
{
    return !HAS(EFFECT_SMOOTH_NORMALS) || lift == REAL(0.0) || t > lift;
}

/* Density of having sampled, from `from`, the lamp that such a ray has met. */
static inline real emitter_met_pdf_w(const Scene* scene, const Surface* surface, real pdf_a, real3 from,
                                     real lift, real t, real3 wo)
{
    return HAS(EFFECT_SMOOTH_NORMALS) && lift > REAL(0.0)
               ? emitter_lifted_pdf_w(scene, surface, pdf_a, from, t, wo)
               : emitter_hit_pdf_w(scene, surface, pdf_a, from, t, wo);
}

#endif
