// SPDX-License-Identifier: Apache-2.0
// Where paths from the lights start: a light, a point and a direction, chosen in proportion to power, and the
// densities of that choice. A light at infinity sends parallel rays through a disc across the sphere that
// holds the scene. Where emission is aimed (emission_aim.h), directions and discs are those of the casters.
#ifndef CLRT_LIGHTS_EMISSION_H
#define CLRT_LIGHTS_EMISSION_H

#include "emission_pdf.h"

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

/* The direction from a point of an emissive triangle, once that and the side are chosen: by the cosine, */
static inline void emission_leave(const Scene* scene, const RenderParams* params, real2 u, Emission* emission)
{
    const Frame frame = frame_make(emission->normal_g);
    const real3 leaving = warp_cosine_hemisphere(u);
    emission->cosine = leaving.z;
    emission->pdf = emission_triangle_pdf(scene, params, emission->light, leaving.z);
    emission->ray = ray_make(emission->point, frame_to_world(&frame, leaving), REAL(0.0));
}

/* or aimed. */
static inline void emission_leave_aimed(const Scene* scene, const RenderParams* params, real2 u,
                                        Emission* emission)
{
    const AimOrigin origin = aim_origin(scene, params, emission->point, emission->normal_g);
    const real3 w = aim_direction(scene, params, &origin, u);
    emission->cosine = fmax(vector_dot(emission->normal_g, w), REAL(0.0));
    if (emission->cosine > REAL(0.0))
        emission->pdf = emission_triangle_ray_pdf(scene, params, emission->light, emission->point,
                                                  emission->normal_g, w);
    emission->ray = ray_make(emission->point, w, REAL(0.0));
}

/* From an emissive triangle: uniform over its area, by the cosine over the side that shines, or over one of
   both, or aimed. */
static CLRT_NOINLINE Emission emission_of_triangle(const Scene* scene, const RenderParams* params,
                                                   const LightChoice* choice, real2 direction)
{
    Emission emission = emission_none(choice->light);
    global const Triangle* triangle = scene->triangles + scene->emitters[choice->light].triangle;
    global const Material* material = scene->materials + triangle->material;
    real3 p0, p1, p2;
    surface_corners(scene, triangle, &p0, &p1, &p2);
    const real3 normal = surface_cross(p1 - p0, p2 - p0);
    const EmitterShare share = emitter_part_of(scene, choice->light);
    const real2 b =
        emitter_part_weights(&share, warp_triangle((real2)(sampler_unit(choice->word), choice->v)));
    real side = surface_winding_is_reversed(scene, triangle, 0u, REAL(0.0), normal) ? REAL(-1.0)
                                                                                     : REAL(1.0);
    if (material->flags & MATERIAL_EMITS_BOTH_SIDES) {
        side = direction.x < REAL(0.5) ? REAL(1.0) : REAL(-1.0);
        direction.x = REAL(2.0) * direction.x - (direction.x < REAL(0.5) ? REAL(0.0) : REAL(1.0));
    }
    emission.normal_g = vector_normalize(normal) * side;
    emission.point = p0 + fma((real3)(b.x), p1 - p0, b.y * (p2 - p0));
    if (EMISSION_IS_AIMED)
        emission_leave_aimed(scene, params, direction, &emission);
    else
        emission_leave(scene, params, direction, &emission);
    emission.ray.origin = emission.point + emission.normal_g * surface_offset_bound(p0, p1, p2);
    const Uv uv = uv_at(scene, triangle, b.x, b.y);
    real3 radiance = material_emission(scene, triangle->material, uv, emission.cosine);
    if (HAS(EFFECT_CUT_OUT) && (material->flags & MATERIAL_CUT_OUT))
        radiance *= material_coverage(scene, material, uv);
    /* Where emission is not aimed, the cosine is in the density, too. */
    emission.power = radiance * (EMISSION_IS_AIMED && emission.pdf > REAL(0.0)
                                     ? emission.cosine / emission.pdf
                                     : REAL_PI / emission_triangle_pdf_a(scene, params, choice->light));
    return emission;
}

/* Light of this radiance (a delta sun's irradiance) from infinity in direction -wi, chosen by a density
   `pdf_w`, through a point of the disc or of a caster's. */
static inline void emission_from_afar(const Scene* scene, const RenderParams* params, real3 wi, real pdf_w,
                                      real3 radiance, real2 u, Emission* emission)
{
    if (EMISSION_IS_AIMED) {
        const real3 point = aim_disc(scene, params, wi, u);
        emission->pdf = pdf_w * aim_disc_pdf_a(scene, params, point, wi);
        emission->point = point + wi * ((real)params->emission_radius - vector_dot(point, wi));
    } else {
        const Frame frame = frame_make(wi);
        const real2 on_disc = warp_disc(u);
        emission->pdf = pdf_w * emission_disc_pdf_a(params);
        emission->point =
            (on_disc.x * frame.x + on_disc.y * frame.y + wi) * (real)params->emission_radius;
    }
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
    emission_from_afar(scene, params, sky.wi, (real)params->emit_environment * sky.pdf_w, sky.radiance, disc,
                       &emission);
    return emission;
}

/* From a point light: within the cone that meets the scene or is its own, or aimed. */
static inline void emission_of_point(const Scene* scene, const RenderParams* params, uint index, real2 u,
                                     Emission* emission)
{
    global const Light* light = scene->lights + index;
    const real3 vector = vector_from(light->vector);
    const EmissionCone cone = emission_point_cone(params, light);
    const Frame frame = frame_make(cone.axis);
    const AimOrigin origin = aim_origin(scene, params, vector, (real3)(REAL(0.0)));
    const real3 w = EMISSION_IS_AIMED ? aim_direction(scene, params, &origin, u)
                                      : frame_to_world(&frame, warp_cone(u, cone.one_minus_cos));
    emission->pdf = emission_point_ray_pdf_w(scene, params, index, w);
    emission->point = vector;
    emission->ray = ray_make(vector, w, REAL(0.0));
    emission->power = vector_from(light->emission) / emission->pdf;
    if (HAS(EFFECT_SPOT))
        emission->power *= delta_light_falloff(light, w);
    emission->is_delta = true;
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
    if (light->kind == LIGHT_POINT) {
        emission_of_point(scene, params, index, u, &emission);
        return emission;
    }
    emission.is_delta = !(light->one_minus_cos > 0.0f);
    const Frame frame = frame_make(vector);
    const real2 within = (real2)(sampler_unit(choice->word), choice->v);
    const real3 wi = emission.is_delta
                         ? vector
                         : frame_to_world(&frame, warp_cone(within, (real)light->one_minus_cos));
    emission_from_afar(scene, params, wi, emission_sun_pdf_w(scene, params, index), radiance, u, &emission);
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
    if (EMISSION_IS_AIMED && params->caster_count == 0u)
        return emission_none(NO_INDEX);
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
