// SPDX-License-Identifier: Apache-2.0
// An integrator for tests, in OpenCL C: paths from the eye to a lamp, and for each all ways in which
// bidirectional path tracing could have found it, weighted by the recursion and by the densities of all of
// them, multiplied out.
#pragma once

namespace clrt {

/// Stands in for bdpt_radiance. Red counts paths, green those whose weights do not sum to 1, blue those with
/// a weight that is not the oracle's.
inline constexpr const char* BDPT_ORACLE = R"(
#define ORACLE_MOST 8
#define ORACLE_TOLERANCE (sizeof(real) == 8 ? REAL(1e-6) : REAL(4e-3))

typedef struct {
    Hit hit;
    Surface surface;
    Bsdf bsdf;
    real3 wo, wi;
    real t, forward, reverse; /* distance to the vertex before; densities towards light and eye, 0: delta */
    bool passes;
    LightVertex light;
    SplatWeights of_eye, of_light;
} OracleVertex;

typedef struct {
    OracleVertex at[ORACLE_MOST + 1];
    uint last; /* on the lamp */
    Emission emission;
    real camera_pdf, light_pdf_w;
} OraclePath;

/* Samples a path to a lamp; false where there is none. */
static bool oracle_sample(const Scene* scene, const RenderParams* params, CameraSample* sample, OraclePath* path)
{
    Ray ray = sample->ray;
    for (uint segment = 1u; segment <= params->max_depth; ++segment) {
        OracleVertex* v = &path->at[segment - 1u];
        const PathNumbers numbers = numbers_make(&sample->sampler, segment, 0u);
        v->hit = vertex_hit(scene, params, &sample->sampler, segment, 0u, &ray, 0);
        if (v->hit.triangle == NO_INDEX)
            return false;
        v->surface = visible_surface(scene, params, &ray, &v->hit);
        v->t = v->hit.t;
        v->wo = -ray.direction;
        path->last = segment - 1u;
        if (v->surface.emitter != NO_INDEX)
            return segment > 1u && !vector_is_black(material_emitted(scene, &v->surface, v->wo));
        v->bsdf = vertex_bsdf(scene, &v->surface, v->wo);
        const BsdfSample next = bsdf_sample(&v->bsdf, numbers.lobe, numbers.direction);
        if (!next.is_valid)
            return false;
        v->wi = next.wi;
        v->forward = next.pdf_w;
        v->passes = splat_can_pass(&v->bsdf, v->wo, v->wi);
        ray = surface_ray(&v->surface, next.reflects, next.wi);
    }
    return false;
}

/* The recursion from the eye. */
static void oracle_from_eye(const RenderParams* params, const Sampler* sampler, OraclePath* path)
{
    SplatWeights weights = {REAL(0.0), REAL(0.0)};
    for (uint k = 0u; k <= path->last; ++k) {
        OracleVertex* v = &path->at[k];
        splat_eye_meets(params, sampler, k + 1u, v->t, &v->surface, v->wo, &weights);
        v->of_eye = weights;
        if (k == path->last)
            return;
        BsdfSample next;
        next.wi = v->wi;
        next.pdf_w = v->forward;
        next.reflects = surface_reflects(&v->surface, v->wi);
        splat_eye_leaves(&v->bsdf, v->wo, &next, &weights);
    }
}

/* The recursion from the lamp. */
static void oracle_from_light(const Scene* scene, const RenderParams* params, OraclePath* path)
{
    const OracleVertex* lamp = &path->at[path->last];
    path->emission = emission_none(lamp->surface.emitter);
    path->emission.normal_g = lamp->surface.normal_g;
    path->emission.point = lamp->surface.position;
    path->emission.cosine = vector_dot(lamp->surface.normal_g, lamp->wo);
    path->emission.pdf = emission_triangle_pdf(scene, params, lamp->surface.emitter, path->emission.cosine);
    SplatWeights weights;
    for (uint k = path->last; k-- > 0u;) {
        OracleVertex* v = &path->at[k];
        const Ray ray = ray_make((real3)(REAL(0.0)), -v->wi, surface_time(&v->surface));
        v->light.surface = surface_at(scene, &v->hit, &ray);
        light_vertex_complete(scene, v->wi, &v->light);
        if (k + 1u == path->last)
            splat_weights_begin(scene, params, &path->emission, &v->light, lamp->t, &weights);
        else
            splat_weights_go(path->at[k + 1u].t, &weights);
        splat_weights_meet(&v->light.surface, v->wi, &weights);
        v->of_light = weights;
        v->reverse = v->forward == REAL(0.0) ? REAL(0.0) : bsdf_eval(&v->light.bsdf, v->wo).pdf_w;
        splat_weights_leave(&v->light.bsdf, v->wo, v->reverse, &weights);
    }
    const LightView view = lights_view(&path->at[path->last - 1u].surface, bsdf_light_normal(&path->at[path->last - 1u].bsdf));
    path->light_pdf_w = path->at[path->last - 1u].forward == REAL(0.0) ? REAL(0.0) :
        splat_light_pdf(scene, params, &path->emission, &view);
}

/* Per area at vertex k, of a density per steradian at a neighbour; a delta lobe's is 1. */
static real oracle_area(const OracleVertex* v, real3 w, real pdf_w, real t)
{
    return (pdf_w == REAL(0.0) ? REAL(1.0) : pdf_w) * fabs(vector_dot(v->surface.normal_g, w)) / (t * t);
}

/* The weight of strategy `s` (0: hit, 1: next-event estimation, 2 + k: connection of vertices k - 1 and k, k = 0: splat)
   by the recursion; negative where it cannot be. */
static real oracle_recursion(const Scene* scene, const RenderParams* params, const OraclePath* path, uint s)
{
    const OracleVertex* before = &path->at[path->last - 1u];
    if (s == 0u) {
        Path eye;
        eye.pdf_w = before->forward;
        return splat_hit_weight(&eye, &path->at[path->last].of_eye, path->light_pdf_w, path->emission.pdf);
    }
    if (s == 1u) {
        if (before->forward == REAL(0.0))
            return REAL(-1.0);
        real splat = REAL(0.0);
        if (before->passes)
            splat = splat_weights_at(&before->bsdf, before->wi, &before->of_eye) *
                    splat_cosine(before->surface.normal_g, before->wi) *
                    emission_triangle_pdf(scene, params, path->emission.light, REAL(1.0));
        return path->light_pdf_w / (path->light_pdf_w + before->forward + splat);
    }
    const uint k = s - 2u;
    const OracleVertex* y = &path->at[k];
    for (uint i = k; i < path->last; ++i)
        if (!path->at[i].passes)
            return REAL(-1.0);
    if (y->forward == REAL(0.0))
        return REAL(-1.0);
    if (k == 0u)
        return splat_weight(params, &y->light, y->wo, path->camera_pdf, &y->of_light);
    const OracleVertex* x = &path->at[k - 1u];
    if (x->forward == REAL(0.0))
        return REAL(-1.0);
    const EyeVertex eye = {&x->surface, &x->bsdf, x->wo, x->of_eye};
    const real others = bdpt_others(&eye, &y->light, &y->of_light, x->wi, x->forward, y->reverse);
    return y->t * y->t / (y->t * y->t + others);
}

/* The density of the path by a strategy, over the area of its vertices. */
static real oracle_density(const RenderParams* params, const OraclePath* path, uint s)
{
    const uint last = path->last;
    const uint first_light = s == 0u ? last + 1u : s == 1u ? last : s - 2u;
    real density = REAL(1.0);
    for (uint k = 0u; k <= last; ++k) {
        const OracleVertex* v = &path->at[k];
        if (k < first_light)
            density *= k == 0u ? path->camera_pdf * fabs(vector_dot(v->surface.normal_g, v->wo))
                               : oracle_area(v, v->wo, path->at[k - 1u].forward, v->t);
        else if (k < last) {
            const OracleVertex* next = &path->at[k + 1u];
            if (k + 1u < last)
                density *= oracle_area(v, v->wi, next->reverse, next->t);
            else
                density *= path->emission.pdf * fabs(vector_dot(v->surface.normal_g, v->wi)) / (next->t * next->t);
        } else if (s == 1u)
            density *= path->light_pdf_w * path->emission.cosine / (v->t * v->t);
    }
    return first_light == 0u ? density * splat_path_count(params) : density;
}

static CLRT_NOINLINE void oracle_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples,
                                          uint count, PixelRays* rays)
{
    OraclePath path;
    for (uint i = 0; i < count; ++i) {
        if (!oracle_sample(scene, params, &samples[i], &path))
            continue;
        const Surface* first = &path.at[0].surface;
        const real2 lens = sampler_pair(&samples[i].sampler, 0u, SAMPLE_LENS);
        path.camera_pdf = camera_project_at(params, first->position, lens, surface_time(first)).pdf_a;
        oracle_from_eye(params, &samples[i].sampler, &path);
        oracle_from_light(scene, params, &path);
        real weights[ORACLE_MOST + 2], densities[ORACLE_MOST + 2], sum = REAL(0.0), whole = REAL(0.0);
        for (uint s = 0u; s < path.last + 2u; ++s) {
            weights[s] = oracle_recursion(scene, params, &path, s);
            densities[s] = weights[s] < REAL(0.0) ? REAL(0.0) : oracle_density(params, &path, s);
            sum += fmax(weights[s], REAL(0.0));
            whole += densities[s];
        }
        bool is_wrong = false;
        for (uint s = 0u; s < path.last + 2u; ++s)
            is_wrong |= !(fabs(fmax(weights[s], REAL(0.0)) - densities[s] / whole) < ORACLE_TOLERANCE);
        const bool is_no_sum = !(fabs(sum - REAL(1.0)) < ORACLE_TOLERANCE);
        samples[i].radiance = vector_make(REAL(1.0), is_no_sum ? REAL(1.0) : REAL(0.0), is_wrong ? REAL(1.0) : REAL(0.0));
    }
}
)";

} // namespace clrt
