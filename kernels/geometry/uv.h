// SPDX-License-Identifier: Apache-2.0
// Texture coordinates of the points of triangles: u and v, and a second pair where a material's textures do
// not all read the same. The first pair gives the directions along which normal maps and highlights lie.
#ifndef CLRT_GEOMETRY_UV_H
#define CLRT_GEOMETRY_UV_H

#include "scene.h"

/* The first pair in xy, the second in zw; likewise the areas of a footprint in both. */
#if CLRT_EFFECTS & EFFECT_SECOND_UV
typedef float4 Uv;
typedef float2 UvArea;
#else
typedef float2 Uv;
typedef float UvArea;
#endif

/* The area where lookups are at a point. */
#define UV_NO_AREA ((UvArea)(0.0f))

/* The same u and v in all pairs. */
static inline Uv uv_make(float u, float v)
{
#if CLRT_EFFECTS & EFFECT_SECOND_UV
    return (Uv)(u, v, u, v);
#else
    return (Uv)(u, v);
#endif
}

/* What a texture reads. */
static inline float2 uv_of(global const Texture* texture, Uv uv)
{
#if CLRT_EFFECTS & EFFECT_SECOND_UV
    return texture->channel & TEXTURE_SECOND_UV ? uv.zw : uv.xy;
#else
    return uv;
#endif
}

/* The area of the footprint in what a texture reads. */
static inline float uv_area_of(global const Texture* texture, UvArea area)
{
#if CLRT_EFFECTS & EFFECT_SECOND_UV
    return texture->channel & TEXTURE_SECOND_UV ? area.y : area.x;
#else
    return area;
#endif
}

/* At a corner, by its index into the arrays. */
static inline Uv uv_corner(const Scene* scene, uint i)
{
#if CLRT_EFFECTS & EFFECT_SECOND_UV
    return (Uv)(scene->uvs[i], scene->has_second_uvs ? scene->second_uvs[i] : (float2)(0.0f));
#else
    return scene->uvs[i];
#endif
}

/* Along the edges from corner 0 to corners 1 and 2 of a triangle that has some. */
static inline void uv_edges(const Scene* scene, global const Triangle* triangle, Uv* d1, Uv* d2)
{
    const Uv t0 = uv_corner(scene, triangle->t0);
    *d1 = uv_corner(scene, triangle->t1) - t0;
    *d2 = uv_corner(scene, triangle->t2) - t0;
}

/* At the point of a triangle with these barycentric weights of corners 1 and 2; 0 where it has none. */
static inline Uv uv_at(const Scene* scene, global const Triangle* triangle, real b1, real b2)
{
    if (!HAS(EFFECT_TEXTURES) || triangle->t0 == NO_INDEX)
        return (Uv)(0.0f);
    Uv d1, d2;
    uv_edges(scene, triangle, &d1, &d2);
    return uv_corner(scene, triangle->t0) + (float)b1 * d1 + (float)b2 * d2;
}

#endif
