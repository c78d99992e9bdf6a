// SPDX-License-Identifier: Apache-2.0
// A vertex of a path from a light, and the rule that both ends keep about what light paths can do there.
//
// Paths from the eye bend shading normals that they would see from behind, and let coarse meshes reflect
// below the facet from points above it (geometry/surface.h). Neither has a counterpart from the other end.
// So light paths take sides by facets alone. Where paths from the eye find the same light, they alone find
// what is seen where either end would bend a normal; else light paths scatter there as paths from the eye do
// (light_bent.h).
#ifndef CLRT_PATH_LIGHT_VERTEX_H
#define CLRT_PATH_LIGHT_VERTEX_H

#include "lights/emission.h"
#include "vertex.h"

/* Whether paths from the eye find what light paths do, weighted against them (splat_weight.h). */
#ifndef SPLATS_ARE_WEIGHTED
#define SPLATS_ARE_WEIGHTED 0
#endif

typedef struct {
    Surface surface; /* flat: its rays start at the facet */
    Bsdf bsdf;       /* as seen from the light's side, carrying importance */
} LightVertex;

/* Whether shading normals may differ from the facet's. */
static inline bool light_vertex_is_bent(void) { return HAS(EFFECT_SMOOTH_NORMALS | EFFECT_NORMAL_MAP); }

/* True if neither the BSDF's shading normal is bent nor would be that of the same point as seen from
   direction w, by the plane's side that it is on; and if the corners' normals, by which curved facets take
   sides, have it on that side, too, whatever a map says. */
static inline bool light_vertex_is_seen(const Bsdf* bsdf, real3 w)
{
    if (!light_vertex_is_bent())
        return true;
    const real cosine = vector_dot(bsdf->frame.z, w);
    const bool is_above = vector_dot(bsdf->normal_g, w) >= REAL(0.0);
    const bool is_above_corners = vector_dot(bsdf->normal_s, w) > REAL(0.0);
    if (HAS(EFFECT_SMOOTH_NORMALS) && HAS(EFFECT_NORMAL_MAP) && is_above != is_above_corners)
        return false;
    return !(bsdf->flags & BSDF_BENT) && (is_above ? cosine : -cosine) >= MATERIAL_SMALLEST_COS;
}

/* Completes the vertex on its surface, which light has come to from wo. */
static inline void light_vertex_complete(const Scene* scene, real3 wo, LightVertex* vertex)
{
    vertex->surface.is_curved = false;
    material_set_bsdf(scene, &vertex->surface, wo, TRANSPORT_IMPORTANCE, &vertex->bsdf);
}

/* The vertex at the end of a light path's ray. */
static inline void light_vertex_set(const Scene* scene, const RenderParams* params, const Ray* ray, Hit* hit,
                                    LightVertex* vertex)
{
    vertex->surface = visible_surface(scene, params, ray, hit);
    light_vertex_complete(scene, -ray->direction, vertex);
    TRACE_VECTOR(scene, TRACE_NORMAL_S, vertex->bsdf.frame.z);
}

#endif
