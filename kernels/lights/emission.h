// SPDX-License-Identifier: Apache-2.0
// Where paths from the lights start: a light, a point and a direction, chosen in proportion to power, and the
// densities of that choice. A light at infinity sends parallel rays through a disc across the sphere that
// holds the scene.
#ifndef CLRT_LIGHTS_EMISSION_H
#define CLRT_LIGHTS_EMISSION_H

#include "lights.h"

/* A ray that leaves a light. Densities are per area and steradian; of a point per steradian, of a sun without
   a disc per area: of what there is to choose. */
typedef struct {
    Ray ray;         /* starts off the light; its direction is of unit length */
    real3 power;     /* emitted radiance times cosine over density, the choice of the light included */
    real3 point;     /* on the light; of one at infinity where the ray starts */
    real3 normal_g;  /* of an emissive triangle, on the side that shines */
    real cosine;     /* of the ray on an emissive triangle; 1 of other lights */
    real pdf;        /* as power has it; 0: nothing was found */
    uint light;      /* its number (light_choice.h) */
    bool is_distant; /* at infinity */
    bool is_delta;   /* no ray meets it */
} Emission;

/* The random numbers of one: words that choose the light and the point, and the direction's. */
typedef struct {
    uint2 words;
    uint alias_word;
    real2 direction;
} EmissionNumbers;

static inline LightKinds emission_kinds(const RenderParams* params)
{
    const LightKinds kinds = {(real)params->emit_emitter, (real)params->emit_environment,
                              (real)params->emit_light};
    return kinds;
}

/* Density of a point on the disc through which light at infinity comes. */
static inline real emission_disc_pdf_a(const RenderParams* params)
{
    const real radius = (real)params->emission_radius;
    return REAL_INVERSE_PI / (radius * radius);
}

/* The part of an emitter's rays that leaves on one side. */
static inline real emission_side_share(const Scene* scene, uint material)
{
    return (scene->materials[material].flags & MATERIAL_EMITS_BOTH_SIDES) ? REAL(0.5) : REAL(1.0);
}

/* Density of the ray that leaves an emissive triangle at a point of cosine `cosine`. */
static inline real emission_triangle_pdf(const Scene* scene, const RenderParams* params, uint emitter,
                                         real cosine)
{
    const uint material = scene->triangles[scene->emitters[emitter].triangle].material;
    return (real)params->emit_emitter * (real)scene->emitters[emitter].pdf_a *
           emission_side_share(scene, material) * cosine * REAL_INVERSE_PI;
}

/* Density of the ray that comes from the sky in direction -wi. */
static inline real emission_sky_pdf(const Scene* scene, const RenderParams* params, real3 wi)
{
    const real pdf_w = HAS(EFFECT_ENVIRONMENT_MAP) && params->environment_width != 0u
                           ? environment_map_pdf_w(scene, params, wi)
                           : REAL(0.25) * REAL_INVERSE_PI;
    return (real)params->emit_environment * pdf_w * emission_disc_pdf_a(params);
}

/* 1 - cos of the cone in which a point light sends its rays: all around from within the sphere, else only to
   the sphere. */
static inline real emission_point_cone(const RenderParams* params, real3 position)
{
    const real radius = (real)params->emission_radius;
    const real square = vector_dot(position, position);
    if (!(square > radius * radius))
        return REAL(2.0);
    const real sine_squared = radius * radius / square;
    return sine_squared / (REAL(1.0) + real_root(REAL(1.0) - sine_squared));
}

/* Density of the ray that leaves a point or a sun: of a point towards the scene, of a sun with a disc within
   it. */
static inline real emission_delta_pdf(const Scene* scene, const RenderParams* params, uint index)
{
    global const Light* light = scene->lights + index;
    const real chosen = (real)params->emit_light * (real)light->probability;
    if (light->kind == LIGHT_POINT)
        return chosen * warp_cone_pdf_w(emission_point_cone(params, vector_from(light->vector)));
    const real disc = (real)light->one_minus_cos;
    return chosen * emission_disc_pdf_a(params) * (disc > REAL(0.0) ? warp_cone_pdf_w(disc) : REAL(1.0));
}

static inline Emission emission_none(uint light)
{
    Emission none;
    none.ray = ray_make((real3)(REAL(0.0)), (real3)(REAL(0.0), REAL(0.0), REAL(1.0)), REAL(0.0));
    none.power = none.point = none.normal_g = (real3)(REAL(0.0));
    none.cosine = REAL(1.0);
    none.pdf = REAL(0.0);
    none.light = light;
    none.is_distant = none.is_delta = false;
    return none;
}

/* From an emissive triangle: uniform over its area, by the cosine over the side that shines, or over one of
   both. */
static CLRT_NOINLINE Emission emission_of_triangle(const Scene* scene, const RenderParams* params,
                                                   const LightChoice* choice, real2 direction)
{
    Emission emission = emission_none(choice->light);
    global const Triangle* triangle = scene->triangles + scene->emitters[choice->light].triangle;
    global const Material* material = scene->materials + triangle->material;
    real3 p0, p1, p2;
    surface_corners(scene, triangle, &p0, &p1, &p2);
    const real3 normal = surface_cross(p1 - p0, p2 - p0);
    const real2 b = warp_triangle((real2)(sampler_unit(choice->word), choice->v));
    real side = surface_winding_is_reversed(scene, triangle, REAL(0.0), normal) ? REAL(-1.0) : REAL(1.0);
    if (material->flags & MATERIAL_EMITS_BOTH_SIDES) {
        side = direction.x < REAL(0.5) ? REAL(1.0) : REAL(-1.0);
        direction.x = REAL(2.0) * direction.x - (direction.x < REAL(0.5) ? REAL(0.0) : REAL(1.0));
    }
    emission.normal_g = vector_normalize(normal) * side;
    const Frame frame = frame_make(emission.normal_g);
    const real3 leaving = warp_cosine_hemisphere(direction);
    emission.cosine = leaving.z;
    emission.point = p0 + fma((real3)(b.x), p1 - p0, b.y * (p2 - p0));
    emission.pdf = emission_triangle_pdf(scene, params, choice->light, leaving.z);
    const real3 step = emission.normal_g * surface_offset_bound(p0, p1, p2);
    emission.ray = ray_make(emission.point + step, frame_to_world(&frame, leaving), REAL(0.0));
    float2 uv = (float2)(0.0f);
    if (HAS(EFFECT_TEXTURES) && triangle->t0 != NO_INDEX) {
        const float2 t0 = scene->uvs[triangle->t0];
        uv = t0 + (float)b.x * (scene->uvs[triangle->t1] - t0) + (float)b.y * (scene->uvs[triangle->t2] - t0);
    }
    real3 radiance = material_emission(scene, material, uv);
    if (HAS(EFFECT_CUT_OUT) && (material->flags & MATERIAL_CUT_OUT))
        radiance *= material_coverage(scene, material, uv);
    /* The cosine is in the density, too. */
    const real chosen = (real)params->emit_emitter * (real)scene->emitters[choice->light].pdf_a *
                       emission_side_share(scene, triangle->material);
    emission.power = radiance * (REAL_PI / chosen);
    return emission;
}

/* Light of this radiance (a delta sun's irradiance) from infinity in direction -wi, through a point of the
   disc. */
static inline void emission_from_afar(const RenderParams* params, real3 wi, real3 radiance, real2 u,
                                      Emission* emission)
{
    const Frame frame = frame_make(wi);
    const real2 on_disc = warp_disc(u);
    const real3 way = on_disc.x * frame.x + on_disc.y * frame.y + wi;
    emission->point = way * (real)params->emission_radius;
    emission->ray = ray_make(emission->point, -wi, REAL(0.0));
    emission->power = radiance / emission->pdf;
    emission->is_distant = true;
}

/* From the sky: a map's by its table, a constant one's from everywhere. */
static CLRT_NOINLINE Emission emission_of_sky(const Scene* scene, const RenderParams* params,
                                              const LightChoice* choice, real2 disc)
{
    Emission emission = emission_none(choice->light);
    LightSample sky = light_sample_none();
    if (HAS(EFFECT_ENVIRONMENT_MAP) && params->environment_width != 0u)
        sky = environment_map_sample(scene, params, choice->word, choice->alias_word, choice->v);
    else {
        sky.wi = warp_cone((real2)(sampler_unit(choice->word), choice->v), REAL(2.0));
        sky.pdf_w = warp_cone_pdf_w(REAL(2.0));
        sky.radiance = vector_from(params->environment);
    }
    emission.pdf = (real)params->emit_environment * sky.pdf_w * emission_disc_pdf_a(params);
    emission_from_afar(params, sky.wi, sky.radiance, disc, &emission);
    return emission;
}

/* From a point or a sun. */
static CLRT_NOINLINE Emission emission_of_delta(const Scene* scene, const RenderParams* params,
                                                const LightChoice* choice, real2 u)
{
    Emission emission = emission_none(choice->light);
    const uint index = choice->light - params->emitter_count;
    global const Light* light = scene->lights + index;
    const real3 vector = vector_from(light->vector);
    const real3 radiance = vector_from(light->emission);
    emission.pdf = emission_delta_pdf(scene, params, index);
    if (light->kind == LIGHT_POINT) {
        const real cone = emission_point_cone(params, vector);
        const Frame frame = frame_make(cone < REAL(2.0) ? vector_normalize(-vector)
                                                        : (real3)(REAL(0.0), REAL(0.0), REAL(1.0)));
        emission.point = vector;
        emission.ray = ray_make(vector, frame_to_world(&frame, warp_cone(u, cone)), REAL(0.0));
        emission.power = radiance / emission.pdf;
        emission.is_delta = true;
        return emission;
    }
    emission.is_delta = !(light->one_minus_cos > 0.0f);
    const Frame frame = frame_make(vector);
    const real2 within = (real2)(sampler_unit(choice->word), choice->v);
    const real3 wi = emission.is_delta
                         ? vector
                         : frame_to_world(&frame, warp_cone(within, (real)light->one_minus_cos));
    emission_from_afar(params, wi, radiance, u, &emission);
    return emission;
}

/* KIND_* of a light; 0: none was found. */
static inline uint emission_kind(const Scene* scene, const RenderParams* params, uint light)
{
    if (light == NO_INDEX)
        return 0u;
    if (light < params->emitter_count)
        return KIND_AREA;
    if (light == light_of_sky(params))
        return KIND_SKY;
    return scene->lights[light - params->emitter_count].kind == LIGHT_POINT ? KIND_POINT : KIND_SUN;
}

/* The numbers of a path, all in one net. */
static inline EmissionNumbers emission_numbers(const Sampler* sampler)
{
    EmissionNumbers numbers;
    numbers.words = sampler_pair_words(sampler, 0u, SAMPLE_FILM);
    const uint2 partner = sampler_partner_words(sampler, 0u, SAMPLE_FILM);
    numbers.direction = (real2)(sampler_unit(partner.x), sampler_unit(partner.y));
    numbers.alias_word = sampler_word(sampler, 0u, SAMPLE_LIGHT_ALIAS);
    return numbers;
}

/* Chooses a light, a point on it and a direction. */
static inline Emission emission_sample(const Scene* scene, const RenderParams* params,
                                       const EmissionNumbers* numbers)
{
    const LightChoice choice = light_choose_by_tables(scene, params, emission_kinds(params), numbers->words,
                                                      numbers->alias_word);
    if (HAS(EFFECT_AREA_LIGHT) && choice.light < params->emitter_count)
        return emission_of_triangle(scene, params, &choice, numbers->direction);
    if (HAS(EFFECT_ENVIRONMENT) && choice.light == light_of_sky(params))
        return emission_of_sky(scene, params, &choice, numbers->direction);
    if (HAS(EFFECT_DELTA_LIGHT) && choice.light != NO_INDEX)
        return emission_of_delta(scene, params, &choice, numbers->direction);
    return emission_none(NO_INDEX);
}

#endif
