// SPDX-License-Identifier: Apache-2.0
// The point of a surface that a ray has hit: position with its error bound, normals, texture coordinates.
#ifndef CLRT_GEOMETRY_SURFACE_H
#define CLRT_GEOMETRY_SURFACE_H

#include "emitter_part.h"
#include "instance.h"
#include "nest.h"
#include "ray.h"
#include "scene.h"
#include "shared/flat_facet.h"
#include "uv.h"

typedef struct {
    real3 position;   /* on the triangle */
    real3 normal_g;   /* unit, of the plane, on wo's side */
    real3 normal_s;   /* unit, for shading, on wo's side */
    real3 tangent;    /* direction of growing texture u; any length, 0 without texture coordinates */
    real3 bitangent;  /* direction of growing texture v */
    real3 bulge;      /* from position to the curved surface that the corner normals describe, on wo's side;
                         0 where flat */
    Uv uv;
    real b1, b2;      /* barycentric weights of corners 1 and 2, */
    uint triangle;    /* of this triangle */
    real offset;      /* bound of position's distance to the plane that the triangle test sees */
    uint emitter;     /* index into the emitters, NO_INDEX for a dark triangle */
    uint material;
    bool is_curved;   /* the corner normals describe a surface that bulges over the plane to wo's side */
    bool is_near_edge; /* the point was drawn in from an edge */
    bool front;       /* wo is on the front side (winding, or vn where given) */
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    real time;        /* of the ray that has hit it */
#endif
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    real width;       /* of the ray's cone here, across the ray, */
    real spread;      /* and its solid angle (ray_cone.h) */
    UvArea uv_area;   /* of its footprint, in texture coordinates; surface_uv_area */
#endif
#if CLRT_EFFECTS & EFFECT_DISPERSION
    uint wave;        /* of that ray */
#endif
#if CLRT_EFFECTS & EFFECT_NESTED
    Nest inside, beyond; /* solids on the ray's side, and on the other */
#endif
} Surface;

/* A position or a normal at a time of the shutter's opening; `moves` has its way until it closes. */
static inline real3 surface_moved(const Scene* scene, global const float4* starts, global const float4* moves,
                                  uint i, real time)
{
    const real3 start = vector_from(starts[i]);
    return scene_moves(scene) ? fma((real3)(time), vector_from(moves[i]), start) : start;
}

/* Corner positions at a time: the same bits as the triangle test's. `instance`: that of the hit. */
static inline void surface_corners_at(const Scene* scene, global const Triangle* triangle, uint instance,
                                      real time, real3* p)
{
    if (HAS(EFFECT_INSTANCES) && instance != 0u) {
        global const Instance* placed = scene->instances + instance;
        p[0] = instance_point(placed, vector_from(scene->positions[triangle->v0]));
        p[1] = instance_point(placed, vector_from(scene->positions[triangle->v1]));
        p[2] = instance_point(placed, vector_from(scene->positions[triangle->v2]));
        return;
    }
    p[0] = surface_moved(scene, scene->positions, scene->position_moves, triangle->v0, time);
    p[1] = surface_moved(scene, scene->positions, scene->position_moves, triangle->v1, time);
    p[2] = surface_moved(scene, scene->positions, scene->position_moves, triangle->v2, time);
}

/* Corner normals at a time, of a triangle that has some: unit vectors on the straight way between two, 0
   where it leads through 0. */
static inline void surface_normals_at(const Scene* scene, global const Triangle* triangle, uint instance,
                                      real time, real3* n)
{
    if (HAS(EFFECT_INSTANCES) && instance != 0u) {
        global const Instance* placed = scene->instances + instance;
        n[0] = instance_normal(placed, vector_from(scene->normals[triangle->n0]));
        n[1] = instance_normal(placed, vector_from(scene->normals[triangle->n1]));
        n[2] = instance_normal(placed, vector_from(scene->normals[triangle->n2]));
        return;
    }
    n[0] = surface_moved(scene, scene->normals, scene->normal_moves, triangle->n0, time);
    n[1] = surface_moved(scene, scene->normals, scene->normal_moves, triangle->n1, time);
    n[2] = surface_moved(scene, scene->normals, scene->normal_moves, triangle->n2, time);
    for (int i = 0; i < 3 && scene_moves(scene); ++i) {
        const real length = vector_length(n[i]);
        n[i] = length > REAL(0.0) ? n[i] / length : n[i];
    }
}

/* -1 where an instance is mirrored, and its triangles' winding with it; else 1. */
static inline real surface_instance_side(const Scene* scene, uint instance)
{
    return HAS(EFFECT_INSTANCES) && instance != 0u ? (real)scene->instances[instance].side : REAL(1.0);
}

/* The object that a hit is on. */
static inline uint surface_object(const Scene* scene, const Hit* hit)
{
    if (HAS(EFFECT_INSTANCES) && hit_instance(hit) != 0u)
        return scene->instances[hit_instance(hit)].object;
    return scene->triangles[hit->triangle].object;
}

/* Corner positions of a triangle that does not move and is no instance's, as no lamp does or is. */
static inline void surface_corners(const Scene* scene, global const Triangle* triangle, real3* p0, real3* p1,
                                   real3* p2)
{
    *p0 = vector_from(scene->positions[triangle->v0]);
    *p1 = vector_from(scene->positions[triangle->v1]);
    *p2 = vector_from(scene->positions[triangle->v2]);
}

/* Edges are multiplied by this power of two, 2^28, before their products: so the square of a normal neither
   underflows for the smallest triangles that floats describe nor overflows for the largest (edges from 5e-17
   to 4). */
#define SURFACE_EDGE_SCALE REAL(268435456.0)

/* A triangle's normal by its edges, not of unit length: twice the area times SURFACE_EDGE_SCALE squared. */
static inline real3 surface_cross(real3 e1, real3 e2)
{
    return vector_cross(e1 * SURFACE_EDGE_SCALE, e2 * SURFACE_EDGE_SCALE);
}

/* Largest extent along an axis. */
static inline real surface_extent(real3 p0, real3 p1, real3 p2)
{
    return vector_max_component(fmax(p0, fmax(p1, p2)) - fmin(p0, fmin(p1, p2)));
}

/* How far a point on the triangle must move along the normal so that a ray leaving it cannot meet the
   triangle's own plane again. With u = 2^-24, M the largest |coordinate| and E the largest extent of the
   triangle:
   - the point p0 + (b1 e1 + b2 e2) is off the plane by its last rounding, u M per axis, and by rounding of
     edges, products and sums, at most 4 u E per axis;
   - moving it rounds once more: u M;
   - the next ray's test sees corners sheared with an error of 6 u E on either axis across the ray where
     divisions are exact, 10 u E where they are within 2.5 units in the last place (box.h), and along it the
     rounding of the depths, u E, and of their weighted sum, 5 u E.
   That is u (2 M + 14 E) on two axes and u (2 M + 10 E) on the third. Along the normal it is at most the
   length of this vector, u (3.5 M + 22.2 E), so delta = u (4 M + 24 E) is enough. */
static inline real surface_offset_bound(real3 p0, real3 p1, real3 p2)
{
    const real3 lower = fmin(p0, fmin(p1, p2));
    const real3 upper = fmax(p0, fmax(p1, p2));
    const real largest = vector_max_component(fmax(fabs(lower), fabs(upper)));
    return FLOAT_ROUNDING * fma(REAL(4.0), largest, REAL(24.0) * surface_extent(p0, p1, p2));
}

/* How far from a triangle's edges its points are kept, in offset bounds: more than the one by which they move
   along the normal, for walls that meet at less than a right angle. */
#define SURFACE_INSET REAL(2.0)

/* True if a point may be nearer to an edge than `margin`. Its distance from the edge across corner i is b_i
   times twice the area (`across` is the length of surface_cross) over the edge's length, which is at most
   sqrt(3) times the extent. */
static inline bool surface_is_near_edge(const Hit* hit, real extent, real across, real margin)
{
    const real nearest = min(REAL(1.0) - hit->b1 - hit->b2, min(hit->b1, hit->b2));
    return nearest * across < margin * extent * (REAL(1.7320509) * SURFACE_EDGE_SCALE * SURFACE_EDGE_SCALE);
}

/* Moves a point of the triangle's plane, relative to corner 0, to `margin` inside the edges that it is nearer
   to: by rounding it may lie beyond an edge, and so behind a wall that meets the triangle there, where a ray
   that leaves it gets out. Moving off one edge leads towards the next at acute corners, so all are visited
   six times. */
static CLRT_NOINLINE real3 surface_inset(real3 point, real3 e1, real3 e2, real3 normal, real margin)
{
    const real3 corners[4] = {(real3)(REAL(0.0)), e1, e2, (real3)(REAL(0.0))};
    for (int i = 0; i < 18; ++i) {
        const real3 corner = corners[i % 3];
        const real3 inward = vector_normalize(surface_cross(normal, corners[i % 3 + 1] - corner));
        point += inward * max(margin - vector_dot(point - corner, inward), REAL(0.0));
    }
    return point;
}

/* Interpolates texture coordinates and their derivatives along the surface. */
static inline void surface_uv(const Scene* scene, global const Triangle* triangle, real b1, real b2, real3 e1,
                              real3 e2, Surface* surface)
{
    if (triangle->t0 == NO_INDEX)
        return;
    surface->uv = uv_at(scene, triangle, b1, b2);
    if (!HAS(EFFECT_NORMAL_MAP | EFFECT_GLOSSY | EFFECT_ROUGH_REFRACTION | EFFECT_THIN_WALL))
        return;
    Uv d1, d2;
    uv_edges(scene, triangle, &d1, &d2);
    /* Solve e1 = d1.u tangent + d1.v bitangent, e2 alike; no tangent where the map is degenerate. */
    const real det = real_difference_of_products(d1.x, d2.y, d1.y, d2.x);
    if (det == REAL(0.0))
        return;
    surface->tangent = ((real)d2.y * e1 - (real)d1.y * e2) / det;
    surface->bitangent = ((real)d1.x * e2 - (real)d2.x * e1) / det;
}

/* Corner normals that are all within this angle of the plane's are those of a flat triangle. Where its plane
   hides a light that its shading normals see, it adds at most 0.01 of what it would head-on. */
#define SURFACE_FLAT_COS ((real)FLAT_FACET_COS)

/* Interpolated shading normal, and the displacement to the curved surface: the point is projected on the
   tangent planes of the corners, and the projections are interpolated (Hanika 2021, Ray Tracing Gems II, ch.
   4). Without it coarse meshes shade themselves near the terminator. A displacement that leads below the
   plane or the shading normal's horizon, as corner normals that contradict each other give, is none. */
static inline void surface_smooth(const Scene* scene, global const Triangle* triangle, uint instance,
                                  real time, const real3* p, real b1, real b2, Surface* surface)
{
    if (!HAS(EFFECT_SMOOTH_NORMALS) || triangle->n0 == NO_INDEX)
        return;
    real3 n[3];
    surface_normals_at(scene, triangle, instance, time, n);
    const real3 n0 = n[0], n1 = n[1], n2 = n[2];
    const real b0 = REAL(1.0) - b1 - b2;
    const real3 sum = b0 * n0 + b1 * n1 + b2 * n2;
    const real length_squared = vector_dot(sum, sum);
    /* Corner normals that cancel describe no direction: keep the plane's. */
    if (length_squared <= REAL_ROUNDING)
        return;
    const real side = surface->front ? REAL(1.0) : REAL(-1.0);
    surface->normal_s = sum * (side / real_sqrt(length_squared));
    const real3 up = surface->normal_g * side;
    const real nearest = fmin(vector_dot(n0, up), fmin(vector_dot(n1, up), vector_dot(n2, up)));
    if (nearest >= SURFACE_FLAT_COS)
        return;
    const real3 lift = b0 * fmin(vector_dot(surface->position - p[0], n0) * side, REAL(0.0)) * n0 +
                       b1 * fmin(vector_dot(surface->position - p[1], n1) * side, REAL(0.0)) * n1 +
                       b2 * fmin(vector_dot(surface->position - p[2], n2) * side, REAL(0.0)) * n2;
    const real3 bulge = -lift * side;
    surface->is_curved =
        vector_dot(bulge, surface->normal_g) > REAL(0.0) && vector_dot(bulge, surface->normal_s) > REAL(0.0);
    surface->bulge = surface->is_curved ? bulge : (real3)(REAL(0.0));
}

/* True where the given normals say that the winding's normal points inward. */
static inline bool surface_winding_is_reversed(const Scene* scene, global const Triangle* triangle,
                                               uint instance, real time, real3 normal)
{
    if (triangle->n0 == NO_INDEX)
        return false;
    real3 n[3];
    surface_normals_at(scene, triangle, instance, time, n);
    return vector_dot(n[0] + n[1] + n[2], normal) < REAL(0.0);
}

/* The area of the footprint of the ray's cone, in texture coordinates: 0 where lookups are not filtered. */
static inline UvArea surface_uv_area(const Surface* surface)
{
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    return surface->uv_area;
#else
    return UV_NO_AREA;
#endif
}

/* Below this a surface is seen edge-on: footprints grow no longer. */
#define SURFACE_SMALLEST_FOOTPRINT_COS REAL(1e-3)

/* Where the cone of a ray that has come to a distance t meets the triangle; `across`: the length of
   surface_cross. */
static inline void surface_set_footprint(const Scene* scene, global const Triangle* triangle, const Ray* ray,
                                         real t, real across, Surface* surface)
{
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    surface->spread = ray->spread;
    surface->width = ray->width + real_sqrt(ray->spread) * t;
    surface->uv_area = UV_NO_AREA;
    if (surface->width == REAL(0.0) || triangle->t0 == NO_INDEX || !(across > REAL(0.0)))
        return;
    const real cosine = fmax(fabs(vector_dot(surface->normal_g, ray->direction)),
                             SURFACE_SMALLEST_FOOTPRINT_COS);
    const real part = surface->width * surface->width * (SURFACE_EDGE_SCALE * SURFACE_EDGE_SCALE) /
                      (across * cosine); /* of twice the triangle's area */
    Uv d1, d2;
    uv_edges(scene, triangle, &d1, &d2);
#if CLRT_EFFECTS & EFFECT_SECOND_UV
    surface->uv_area = (UvArea)((float)(part * fabs(real_difference_of_products(d1.x, d2.y, d1.y, d2.x))),
                                (float)(part * fabs(real_difference_of_products(d1.z, d2.w, d1.w, d2.z))));
#else
    surface->uv_area = (float)(part * fabs(real_difference_of_products(d1.x, d2.y, d1.y, d2.x)));
#endif
#endif
}

/* Reconstructs the surface where a ray has hit it; wo points back along the ray. The position comes from the
   barycentric weights, not from the distance, so its error depends on the triangle's size and place alone. */
CLRT_GIVES_STRUCT Surface surface_at(const Scene* scene, const Hit* hit, const Ray* ray)
{
    const real3 wo = -ray->direction;
    global const Triangle* triangle = scene->triangles + hit->triangle;
    const uint instance = hit_instance(hit);
    real3 p[3];
    const real time = ray_time(ray);
    surface_corners_at(scene, triangle, instance, time, p);
    const real3 e1 = p[1] - p[0];
    const real3 e2 = p[2] - p[0];
    const real3 cross = surface_cross(e1, e2);
    const real across = vector_length(cross);
    /* The edges of a needle may become parallel when they are rounded: then no direction is better than
       wo. */
    const real3 normal =
        across > REAL(0.0) ? cross / across * surface_instance_side(scene, instance) : wo;
    const real side = vector_dot(normal, wo) < REAL(0.0) ? REAL(-1.0) : REAL(1.0);

    Surface surface;
    surface.offset = surface_offset_bound(p[0], p[1], p[2]);
    real3 point = fma((real3)(hit->b1), e1, hit->b2 * e2);
    const real margin = SURFACE_INSET * surface.offset;
    surface.is_near_edge =
        across > REAL(0.0) && surface_is_near_edge(hit, surface_extent(p[0], p[1], p[2]), across, margin);
    if (surface.is_near_edge)
        point = surface_inset(point, e1, e2, normal * surface_instance_side(scene, instance), margin);
    surface.position = p[0] + point;
    surface.normal_g = normal * side;
    surface.normal_s = surface.normal_g;
    surface.tangent = (real3)(REAL(0.0));
    surface.bitangent = (real3)(REAL(0.0));
    surface.bulge = (real3)(REAL(0.0));
    surface.is_curved = false;
    surface.uv = (Uv)(0.0f);
    surface.b1 = hit->b1;
    surface.b2 = hit->b2;
    surface.triangle = hit->triangle;
    surface.emitter = emitter_part_hit(scene, triangle->emitter, hit->b1, hit->b2);
    surface.material = triangle->material;
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    surface.time = ray->time;
#endif
#if CLRT_EFFECTS & EFFECT_DISPERSION
    surface.wave = ray->wave;
#endif
    surface.front =
        (side > REAL(0.0)) != surface_winding_is_reversed(scene, triangle, instance, time, normal);
#if CLRT_EFFECTS & EFFECT_NESTED
    surface.inside = ray->nest;
    surface.beyond = nest_beyond(scene, ray->nest, surface.material, surface.front);
#endif
    if (HAS(EFFECT_TEXTURES | EFFECT_GLOSSY | EFFECT_ROUGH_REFRACTION | EFFECT_THIN_WALL))
        surface_uv(scene, triangle, hit->b1, hit->b2, e1, e2, &surface);
    surface_smooth(scene, triangle, instance, time, p, hit->b1, hit->b2, &surface);
    surface_set_footprint(scene, triangle, ray, hit->t, across, &surface);
    return surface;
}

/* Interpolates colours of the vertices, three floats each from a texel word on. Equal ones stay what they
   are. */
static CLRT_NOINLINE real3 surface_vertex_color(const Scene* scene, const Surface* surface, uint first_word)
{
    global const Triangle* triangle = scene->triangles + surface->triangle;
    global const float* colors = (global const float*)scene->texel_words + first_word;
    const real3 c0 = convert_real3(vload3(triangle->v0, colors));
    const real3 c1 = convert_real3(vload3(triangle->v1, colors));
    const real3 c2 = convert_real3(vload3(triangle->v2, colors));
    return fmax(c0 + surface->b1 * (c1 - c0) + surface->b2 * (c2 - c0), (real3)(REAL(0.0)));
}

/* The one decision of sides: true if direction w is on wo's side of a surface, above its plane or, where
   corner normals describe a curved surface that bulges over the plane, above the interpolated normal's
   horizon. Maps have no say: they shade, but no ray gets through a wall by them. */
static inline bool surface_side(real3 normal_g, real3 normal_s, bool is_curved, real3 w)
{
    if (HAS(EFFECT_SMOOTH_NORMALS) && is_curved && vector_dot(w, normal_s) > REAL(0.0))
        return true;
    return vector_dot(w, normal_g) >= REAL(0.0);
}

static inline bool surface_reflects(const Surface* surface, real3 w)
{
    return surface_side(surface->normal_g, surface->normal_s, surface->is_curved, w);
}

/* True if a ray on the given side starts on the curved surface: it leads below the plane, where the facet
   would hide all from it. Every other ray starts at the plane, where paths from a light arrive, so that both
   find the same light there. */
static inline bool surface_is_lifted(const Surface* surface, bool reflects, real3 w)
{
    return HAS(EFFECT_SMOOTH_NORMALS) && surface->is_curved && reflects &&
           vector_dot(w, surface->normal_g) < REAL(0.0);
}

/* How far a ray along w is inside of the curved surface: up to there it is above the plane. 0 of a ray that
   starts at the plane. */
static inline real surface_lift(const Surface* surface, bool reflects, real3 w)
{
    if (!surface_is_lifted(surface, reflects, w))
        return REAL(0.0);
    return vector_dot(surface->bulge, surface->normal_g) / -vector_dot(w, surface->normal_g);
}

/* Where a ray leaves the surface, by its side (surface_reflects) and direction: off the plane by the error
   bound, or from the curved surface. */
static inline real3 surface_origin(const Surface* surface, bool reflects, real3 w)
{
    const real3 step = surface->normal_g * (reflects ? surface->offset : -surface->offset);
    return surface_is_lifted(surface, reflects, w) ? surface->position + surface->bulge + step
                                                   : surface->position + step;
}

/* The time of the ray that has hit the surface (ray_time). */
static inline real surface_time(const Surface* surface)
{
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    return surface->time;
#else
    return REAL(0.0);
#endif
}

/* The wave of the ray that has hit the surface (ray_wave). */
static inline uint surface_wave(const Surface* surface)
{
#if CLRT_EFFECTS & EFFECT_DISPERSION
    return surface->wave;
#else
    return WAVE_NONE;
#endif
}

/* The solids on one side of the surface. */
static inline Nest surface_nest(const Surface* surface, bool reflects)
{
#if CLRT_EFFECTS & EFFECT_NESTED
    return reflects ? surface->inside : surface->beyond;
#else
    return nest_empty();
#endif
}

/* The ray that goes on from the surface to either side, at the same time, as the same wave
   and with the same cone. */
static inline Ray surface_ray(const Surface* surface, bool reflects, real3 direction)
{
    Ray ray = ray_make(surface_origin(surface, reflects, direction), direction, surface_time(surface));
    ray_set_wave(surface_wave(surface), &ray);
#if CLRT_EFFECTS & EFFECT_NESTED
    ray.nest = surface_nest(surface, reflects);
#endif
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    ray.width = surface->width;
    ray.spread = surface->spread;
#endif
    return ray;
}

/* The segment from one surface to another, wi its direction where it starts. */
static inline Ray surface_shadow_ray(const Surface* from, const Surface* to, real3 wi)
{
    Ray ray = surface_ray(from, surface_reflects(from, wi), wi);
    ray_end_at(surface_origin(to, surface_reflects(to, -wi), -wi), &ray);
    return ray;
}

#endif
