// SPDX-License-Identifier: Apache-2.0
// A material's constants and maps -> the BSDF at a surface point.
#ifndef CLRT_SCATTERING_MATERIAL_H
#define CLRT_SCATTERING_MATERIAL_H

#include "bsdf.h"
#include "geometry/surface.h"
#include "geometry/texture.h"

/* Smallest cosine between wo and a shading normal: an interpolated or mapped normal that wo does not see is
   bent towards wo until it does, by an angle that no picture shows. */
#define MATERIAL_SMALLEST_COS REAL(1e-3)

/* Below this a mapped alpha is raised: the microfacet formulas keep seven digits down to it. */
#define MATERIAL_SMALLEST_ALPHA REAL(1e-4)

/* Coverage in [0, 1]: 0 lets everything pass. */
static inline real material_coverage(const Scene* scene, global const Material* material, Uv uv)
{
    real coverage = (real)MATERIAL_COVERAGE(*material);
    if (HAS(EFFECT_TEXTURES) && material->map_coverage != NO_INDEX)
        coverage *= texture_scalar(scene, material->map_coverage, uv, UV_NO_AREA);
    return real_unit(coverage);
}

/* True if the material shines on this side. */
static inline bool material_emits(global const Material* material, bool front)
{
    return front || (material->flags & MATERIAL_EMITS_BOTH_SIDES);
}

/* Below this a map is stretched so far that its slope no longer matters; keeps the step to the next texel
   finite. */
#define MATERIAL_SMALLEST_MAP_SCALE 1e-6f

/* The normal of a bump map (Blinn 1978): heights at the point and one texel further along u and v. */
static inline real3 material_bump_normal(const Scene* scene, global const Material* material,
                                         const Surface* surface, real3 n)
{
    global const Texture* texture = scene->textures + material->map_bump;
    const float du =
        1.0f / ((float)texture->width * fmax(fabs(texture->scale_u), MATERIAL_SMALLEST_MAP_SCALE));
    const float dv =
        1.0f / ((float)texture->height * fmax(fabs(texture->scale_v), MATERIAL_SMALLEST_MAP_SCALE));
    const Uv uv = surface->uv;
    const real height = texture_scalar(scene, material->map_bump, uv, UV_NO_AREA);
    const real along_u = texture_scalar(scene, material->map_bump, uv + uv_make(du, 0.0f), UV_NO_AREA);
    const real along_v = texture_scalar(scene, material->map_bump, uv + uv_make(0.0f, dv), UV_NO_AREA);
    const real scale = (real)material->bump_scale;
    /* Displaced tangents; their cross product is the new normal. */
    const real3 tu = surface->tangent + n * (scale * (along_u - height) / (real)du);
    const real3 tv = surface->bitangent + n * (scale * (along_v - height) / (real)dv);
    const real3 bumped = vector_cross(tu, tv);
    const real length_squared = vector_dot(bumped, bumped);
    if (length_squared == REAL(0.0))
        return n;
    /* Mirrored texture coordinates turn the cross product round. */
    const real side = vector_dot(bumped, n) < REAL(0.0) ? REAL(-1.0) : REAL(1.0);
    return bumped * (side / real_sqrt(length_squared));
}

/* The normal of a tangent-space normal map. */
static inline real3 material_mapped_normal(const Scene* scene, global const Material* material,
                                           const Surface* surface, real3 n)
{
    const real3 rgb = convert_real3(texture_lookup(scene, material->map_normal, surface->uv, UV_NO_AREA).xyz);
    const real3 m = REAL(2.0) * rgb - (real3)(REAL(1.0));
    const Frame frame = frame_make_tangent(n, surface->tangent);
    /* Green grows with v, also where the texture coordinates are mirrored. */
    const real handed = vector_dot(frame.y, surface->bitangent) < REAL(0.0) ? REAL(-1.0) : REAL(1.0);
    const real strength = material->map_bump == NO_INDEX ? (real)material->bump_scale : REAL(1.0);
    const real3 mapped = strength * (m.x * frame.x + m.y * handed * frame.y) + m.z * n;
    const real length_squared = vector_dot(mapped, mapped);
    return length_squared == REAL(0.0) ? n : mapped / real_sqrt(length_squared);
}

/* The shading normal, interpolated and mapped, on the plane's side that wo is on. */
static inline real3 material_normal(const Scene* scene, global const Material* material,
                                    const Surface* surface)
{
    real3 n = surface->normal_s;
    const bool has_tangent = !vector_is_zero(surface->tangent);
    if (HAS(EFFECT_NORMAL_MAP) && has_tangent) {
        /* Maps describe the front: seen from behind it is the same surface. */
        const real side = surface->front ? REAL(1.0) : REAL(-1.0);
        if (material->map_bump != NO_INDEX)
            n = side * material_bump_normal(scene, material, surface, side * n);
        if (material->map_normal != NO_INDEX)
            n = side * material_mapped_normal(scene, material, surface, side * n);
    }
    return n;
}

/* True where wo would see the back of a shading normal that is not the plane's. */
static inline bool material_is_bent(const Surface* surface, real3 n, real3 wo)
{
    return HAS(EFFECT_SMOOTH_NORMALS | EFFECT_NORMAL_MAP) && vector_dot(n, wo) < MATERIAL_SMALLEST_COS &&
           !vector_is_zero(n - surface->normal_g);
}

/* A normal that is bent until wo sees it. */
static inline real3 material_bent(real3 n, real3 wo)
{
    return vector_normalize(n + (MATERIAL_SMALLEST_COS - vector_dot(n, wo)) * wo);
}

/* A map's reflectance at the surface point: of a picture, of the triangle's vertices, or of both, multiplied.
   Pictures with values above 1, and -mm, could make a surface reflect more than it gets; a NaN stays one. */
static inline real3 material_reflectance(const Scene* scene, uint map, const Surface* surface)
{
    global const Texture* texture = scene->textures + map;
    real3 color = (real3)(REAL(1.0));
    if (texture->format != TEXEL_VERTEX) {
        color = texture_color(scene, map, surface->uv, surface_uv_area(surface));
        color = color > (real3)(REAL(1.0)) ? (real3)(REAL(1.0)) : color;
    }
    if (texture->vertex_word != 0u)
        color *= surface_vertex_color(scene, surface, texture->vertex_word);
    return color;
}

/* A constant times its map. */
static inline real material_scaled(const Scene* scene, float constant_part, uint map, Uv uv)
{
    const real value = (real)constant_part;
    return HAS(EFFECT_TEXTURES) && map != NO_INDEX
               ? value * real_unit(texture_scalar(scene, map, uv, UV_NO_AREA))
               : value;
}

/* Weight and alpha of a material's coat at uv. */
static inline real2 material_coat(const Scene* scene, uint material, Uv uv)
{
    global const MaterialExtension* extension = scene->extensions + material;
    const real root = material_scaled(scene, 1.0f, extension->map_coat_roughness, uv);
    return (real2)(material_scaled(scene, extension->coat, extension->map_coat, uv),
                   fmax((real)extension->coat_alpha * root * root, MATERIAL_SMALLEST_ALPHA));
}

/* Splits off the glass of a material, whose base colour is still `matte`: metal, then glass of weight w in
   what is no metal, then the rest (Cycles' principled order). The matte base that is left is scaled by its
   share. Gives the metallic part of the rest. */
static inline real material_part_glass(const Scene* scene, global const Material* material,
                                       const Surface* surface, real metallic, Bsdf* bsdf)
{
    global const MaterialExtension* extension = scene->extensions + surface->material;
    const real weight = material_scaled(scene, EXTENSION_TRANSMISSION(*extension),
                                        extension->map_transmission, surface->uv);
    const real3 base = bsdf->matte;
    const bool is_pane = (material->lobes & LOBE_PANE) != 0u;
    bsdf->glass = (REAL(1.0) - metallic) * weight;
    bsdf->transmission = bsdf->glass * (is_pane ? base : real_sqrt(base));
    return bsdf->glass < REAL(1.0) ? metallic / (REAL(1.0) - bsdf->glass) : REAL(0.0);
}

/* Reads what lies above the surface. */
static inline void material_cover(const Scene* scene, global const Material* material, const Surface* surface,
                                  Bsdf* bsdf)
{
    bsdf_cover(bsdf)->coat = REAL(0.0);
    bsdf_cover(bsdf)->sheen = (real3)(REAL(0.0));
    global const MaterialExtension* extension = scene->extensions + surface->material;
    if (HAS(EFFECT_COAT) && (material->lobes & LOBE_COAT)) {
        const real2 coat = material_coat(scene, surface->material, surface->uv);
        bsdf_cover(bsdf)->coat = coat.x;
        bsdf_cover(bsdf)->coat_alpha = coat.y;
    }
    if (HAS(EFFECT_SHEEN) && (material->lobes & LOBE_SHEEN)) {
        bsdf_cover(bsdf)->sheen = vector_from(extension->sheen);
        if (HAS(EFFECT_TEXTURES) && extension->map_sheen != NO_INDEX)
            bsdf_cover(bsdf)->sheen *= material_reflectance(scene, extension->map_sheen, surface);
        const real root = material_scaled(scene, 1.0f, extension->map_sheen_roughness, surface->uv);
        bsdf_cover(bsdf)->sheen_alpha =
            fmax((real)EXTENSION_SHEEN_ALPHA(*extension) * root * root, SHEEN_SMALLEST_ALPHA);
    }
}

/* The texel of a map of anisotropy where the material has one; 0 where not. */
static inline float4 material_anisotropy(const Scene* scene, const Surface* surface)
{
    const uint map = scene->extensions[surface->material].map_anisotropy;
    return HAS(EFFECT_TEXTURES) && map != NO_INDEX ? texture_lookup(scene, map, surface->uv, UV_NO_AREA)
                                                   : (float4)(0.0f);
}

/* A highlight is stretched to 1 : 10 at most. */
#define MATERIAL_LEAST_ASPECT REAL(0.1)

/* Stretches a highlight by its map: across the direction it keeps its alpha (KHR_materials_anisotropy). */
static CLRT_NOINLINE void material_stretch(const Scene* scene, const Surface* surface, Bsdf* bsdf)
{
    if (scene->extensions[surface->material].map_anisotropy == NO_INDEX || bsdf->alpha_x == REAL(0.0))
        return;
    const real strength = (real)scene->extensions[surface->material].anisotropy *
                          real_unit((real)material_anisotropy(scene, surface).z);
    bsdf->alpha_x = fma(strength * strength, REAL(1.0) - bsdf->alpha_y, bsdf->alpha_y);
    bsdf->alpha_y = fmax(bsdf->alpha_y, MATERIAL_LEAST_ASPECT * bsdf->alpha_x);
}

/* The direction along which highlights are stretched. */
static inline real3 material_tangent(const Scene* scene, global const Material* material,
                                     const Surface* surface, real3 n)
{
    if (!HAS(EFFECT_ROTATION) || !(material->flags & MATERIAL_TURNED))
        return surface->tangent;
    global const MaterialExtension* extension = scene->extensions + surface->material;
    const Frame frame = frame_make_tangent(n, surface->tangent);
    const real handed = vector_dot(frame.y, surface->bitangent) < REAL(0.0) ? REAL(-1.0) : REAL(1.0);
    real2 turn = (real2)((real)extension->turn_cos, (real)extension->turn_sin);
    if (HAS(EFFECT_TEXTURES) && extension->map_anisotropy != NO_INDEX) {
        const float4 texel = material_anisotropy(scene, surface);
        const real2 way = REAL(2.0) * (real2)((real)texel.x, (real)texel.y) - (real2)(REAL(1.0));
        turn = (real2)(turn.x * way.x - turn.y * way.y, turn.x * way.y + turn.y * way.x);
    }
    const real3 tangent = turn.x * frame.x + (handed * turn.y) * frame.y;
    return vector_is_zero(tangent) ? frame.x : tangent;
}

/* Indices of a solid for the colours; all the same where it does not disperse. */
static inline real3 material_indices(const Scene* scene, uint material)
{
    const real index = (real)MATERIAL_INDEX(scene->materials[material]);
    return scene->materials[material].flags & MATERIAL_DISPERSES
               ? dispersion_indices(index, (real)scene->extensions[material].spread)
               : (real3)(index);
}

/* The solid that is there outside that whose surface it is; NO_INDEX: air. */
static inline uint material_outside(const Scene* scene, const Surface* surface)
{
    return nest_takes(scene, surface->material)
               ? nest_top(scene, surface_nest(surface, surface->front))
               : NO_INDEX;
}

/* Sets the index ratios of the colours, and that of the wave among them, where they differ. */
static CLRT_NOINLINE void material_disperse(const Scene* scene, const Surface* surface, uint outside,
                                            Bsdf* bsdf)
{
#if CLRT_EFFECTS & EFFECT_DISPERSION
    const uint wave = surface_wave(surface);
    const bool disperses =
        (scene->materials[surface->material].flags & MATERIAL_DISPERSES) ||
        (outside != NO_INDEX && (scene->materials[outside].flags & MATERIAL_DISPERSES));
    if (!disperses || wave == WAVE_NONE)
        return;
    const real3 indices = material_indices(scene, surface->material);
    const real3 others = outside == NO_INDEX ? (real3)(REAL(1.0)) : material_indices(scene, outside);
    bsdf->rare.etas = surface->front ? others / indices : indices / others;
    bsdf->eta = dispersion_component(wave, bsdf->rare.etas);
    bsdf->flags |= wave << BSDF_WAVE_SHIFT;
#endif
}

/* Sets the index ratio. */
static inline void material_refraction(const Scene* scene, global const Material* material,
                                       const Surface* surface, Bsdf* bsdf)
{
    const real index = (real)MATERIAL_INDEX(*material);
    const bool is_pane = HAS(EFFECT_THIN_WALL) && (material->lobes & LOBE_PANE);
    const bool from_air = is_pane || (HAS(EFFECT_REFRACTION) && surface->front);
    const uint outside = material_outside(scene, surface);
    const real other =
        outside == NO_INDEX ? REAL(1.0) : (real)MATERIAL_INDEX(scene->materials[outside]);
    bsdf->eta = from_air ? other / index : index / other;
    if (HAS(EFFECT_DISPERSION) && (material->lobes & LOBE_DIELECTRIC))
        material_disperse(scene, surface, outside, bsdf);
}

/* Reads colours and roughness, maps included. */
static inline void material_parameters(const Scene* scene, global const Material* material,
                                       const Surface* surface, Bsdf* bsdf)
{
    real metallic = (real)MATERIAL_METALLIC(*material);
    real roughness = REAL(1.0);
    if (HAS(EFFECT_TEXTURES)) {
        const UvArea uv_area = surface_uv_area(surface);
        if (material->map_matte != NO_INDEX)
            bsdf->matte *= material_reflectance(scene, material->map_matte, surface);
        if (material->map_specular != NO_INDEX)
            bsdf->specular *= material_reflectance(scene, material->map_specular, surface);
        if (material->map_metallic != NO_INDEX)
            metallic *= real_unit(texture_scalar(scene, material->map_metallic, surface->uv, uv_area));
        if (material->map_roughness != NO_INDEX)
            roughness = real_unit(texture_scalar(scene, material->map_roughness, surface->uv, uv_area));
    }
    if (HAS(EFFECT_PART_GLASS) && (material->flags & MATERIAL_PART_GLASS))
        metallic = material_part_glass(scene, material, surface, metallic, bsdf);
    if (material->flags & MATERIAL_METALLIC_ROUGHNESS) {
        bsdf->specular = vector_mix(bsdf->specular, bsdf->matte, metallic);
        bsdf->matte *= REAL(1.0) - metallic;
    }
    if (HAS(EFFECT_PART_GLASS) && (material->flags & MATERIAL_PART_GLASS))
        bsdf->matte *= REAL(1.0) - bsdf->glass;
    /* What is smooth stays so, whatever its map: only alpha calls for the effects of rough lobes. */
    if (roughness != REAL(1.0) && material->roughness_sqrt_x > 0.0f) {
        const real x = (real)material->roughness_sqrt_x * roughness;
        const real y = (real)material->roughness_sqrt_y * roughness;
        bsdf->alpha_x = x * x < MATERIAL_SMALLEST_ALPHA ? MATERIAL_SMALLEST_ALPHA : x * x;
        bsdf->alpha_y = y * y < MATERIAL_SMALLEST_ALPHA ? MATERIAL_SMALLEST_ALPHA : y * y;
    }
    if (HAS(EFFECT_ROTATION) && HAS(EFFECT_TEXTURES) && (material->flags & MATERIAL_TURNED))
        material_stretch(scene, surface, bsdf);
}

/* Emitted radiance at uv, both sides alike, towards a direction of this cosine on the facet; the caller knows
   the side. A coat above dims it by what it sends back inward (KHR_materials_clearcoat): along the facet's
   normal, which every way to find a light knows, be it met, sampled or left. */
static inline real3 material_emission(const Scene* scene, uint index, Uv uv, real cos_o)
{
    global const Material* material = scene->materials + index;
    real3 emission = vector_from(material->emission);
    if (HAS(EFFECT_TEXTURES) && material->map_emission != NO_INDEX)
        emission *= texture_color(scene, material->map_emission, uv, UV_NO_AREA);
    if (HAS(EFFECT_COAT) && (material->lobes & LOBE_COAT)) {
        const real2 coat = material_coat(scene, index, uv);
        const real cosine = fmin(fabs(cos_o), REAL(1.0));
        const real sine = real_sqrt(fma(-cosine, cosine, REAL(1.0)));
        emission *= cover_film_left(coat.x, coat.y, vector_make(sine, REAL(0.0), cosine));
    }
    return emission;
}

/* Radiance that the surface emits towards wo. */
static inline real3 material_emitted(const Scene* scene, const Surface* surface, real3 wo)
{
    const real3 emitted = material_emits(scene->materials + surface->material, surface->front)
                              ? material_emission(scene, surface->material, surface->uv,
                                                  vector_dot(surface->normal_g, wo))
                              : (real3)(REAL(0.0));
    TRACE_VECTOR(scene, TRACE_EMITTED, emitted);
    return emitted;
}

/* Builds the BSDF of a surface point as wo sees it, for radiance or importance (TRANSPORT_*). */
CLRT_GIVES_STRUCT void material_set_bsdf(const Scene* scene, const Surface* surface, real3 wo, uint transport,
                                         Bsdf* bsdf)
{
    global const Material* material = scene->materials + surface->material;
    bsdf->matte = vector_from(material->matte);
    bsdf->specular = vector_from(material->specular);
    bsdf->transmission = vector_from(material->transmission);
    bsdf->alpha_x = (real)material->alpha_x;
    bsdf->alpha_y = (real)material->alpha_y;
    bsdf->exponent = (real)MATERIAL_EXPONENT(*material);
    bsdf->lobes = material->lobes;
    bsdf->fresnel = material->fresnel;
    bsdf->flags = material->flags | transport;
    bsdf->normal_g = surface->normal_g;
    bsdf->normal_s = surface->normal_s;
    bsdf->is_curved = surface->is_curved;
    material_refraction(scene, material, surface, bsdf);
    material_parameters(scene, material, surface, bsdf);
    if (HAS(EFFECT_COAT | EFFECT_SHEEN) && (material->lobes & (LOBE_COAT | LOBE_SHEEN))) {
        material_cover(scene, material, surface, bsdf);
        bsdf->flags |= !surface->front && (material->lobes & LOBE_DIELECTRIC) ? BSDF_INSIDE : 0u;
    }
    if (HAS(EFFECT_MEASURED) && (material->lobes & LOBE_MEASURED))
        bsdf_set_measured(bsdf, scene->measured + scene->extensions[surface->material].measured);
    real3 n = material_normal(scene, material, surface);
    if (material_is_bent(surface, n, wo)) {
        n = material_bent(n, wo);
        bsdf->flags |= BSDF_BENT;
    }
    /* Only stretched highlights need to know where u grows. */
    bsdf->frame = bsdf->alpha_x != bsdf->alpha_y
                      ? frame_make_tangent(n, material_tangent(scene, material, surface, n))
                      : frame_make(n);
    bsdf->wo = frame_to_local(&bsdf->frame, wo);
    bsdf_energy_set(bsdf);
    bsdf_choose_lobes(bsdf);
}

/* The same as a value. Kept in another struct, it would be in private memory twice. */
CLRT_GIVES_STRUCT Bsdf material_bsdf(const Scene* scene, const Surface* surface, real3 wo, uint transport)
{
    Bsdf bsdf;
    material_set_bsdf(scene, surface, wo, transport, &bsdf);
    return bsdf;
}

/* The same for callers that few rays come to: out of line everywhere, so that they share one body. */
static CLRT_NOINLINE void material_set_bsdf_apart(const Scene* scene, const Surface* surface, real3 wo,
                                                  uint transport, Bsdf* bsdf)
{
    material_set_bsdf(scene, surface, wo, transport, bsdf);
}

#endif
