// SPDX-License-Identifier: Apache-2.0
// The lobe of a measured isotropic BRDF: opaque, both sides alike. Values are interpolated between the
// middles of the table's cells, by the half and difference angles, which do not tell the two directions
// apart: the lobe is reciprocal to the last bit. Directions are sampled by a mixture of half vectors, by
// cells of their angle whose probabilities are what they send to the eye (src/scene/measured_sampling.cpp),
// and of a cosine lobe, which leaves nothing out. Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_MEASURED_H
#define CLRT_SCATTERING_BSDF_MEASURED_H

#include "bsdf_types.h"
#include "numerics/halves.h"
#include "numerics/real_functions.h"
#include "numerics/warp.h"

/* Where a pair of directions lies in a table. */
typedef struct {
    real half_root;  /* sqrt(angle of the half vector over a right angle) */
    real difference; /* angle of either direction to the half vector over a right angle */
    real azimuth;    /* of the directions about the half vector over pi, from the plane of the normal */
} MeasuredPlace;

/* Between two cells of an axis. */
typedef struct {
    uint low, high;
    real part; /* of the way to the higher one */
} MeasuredStep;

/* The view's tables below and above that of wo. */
typedef struct {
    global const MeasuredView* low;
    global const MeasuredView* high;
    real part;
} MeasuredViews;

static inline bool bsdf_measured_is_delta(const Bsdf* bsdf) { return false; }

/* The place of a half vector of this sine and cosine to the normal. */
static inline real measured_half_root(real sine, real cosine)
{
    return real_sqrt(real_atan2(sine, cosine) * (REAL(2.0) * REAL_INVERSE_PI));
}

/* From the directions' sum and difference, so that neither small nor right angles lose digits. */
static inline MeasuredPlace measured_place(real3 wo, real3 wi)
{
    const real3 sum = wo + wi, apart = wi - wo;
    const real3 h = vector_normalize(sum);
    const real sine = real_sqrt(fma(h.x, h.x, h.y * h.y));
    const real2 along =
        sine > REAL(0.0) ? (real2)(h.x / sine, h.y / sine) : (real2)(REAL(1.0), REAL(0.0));
    const real x = h.z * (along.x * apart.x + along.y * apart.y) - sine * apart.z;
    const real y = along.x * apart.y - along.y * apart.x;
    /* Half a turn further is the same pair in the other order. */
    const bool is_other = y < REAL(0.0) || (y == REAL(0.0) && x < REAL(0.0));
    MeasuredPlace place;
    place.half_root = measured_half_root(sine, h.z);
    place.difference =
        real_atan2(vector_length(apart), vector_length(sum)) * (REAL(2.0) * REAL_INVERSE_PI);
    place.azimuth = (is_other ? real_atan2(-y, -x) : real_atan2(y, x)) * REAL_INVERSE_PI;
    return place;
}

/* Beyond the first and the last middle nothing changes. */
static inline MeasuredStep measured_step(real coordinate, uint count)
{
    const real along = clamp(fma(coordinate, (real)count, REAL(-0.5)), REAL(0.0), (real)(count - 1u));
    MeasuredStep step;
    step.low = (uint)along;
    step.high = min(step.low + 1u, count - 1u);
    step.part = along - (real)step.low;
    return step;
}

/* Beyond the last middle comes the first. */
static inline MeasuredStep measured_step_around(real coordinate, uint count)
{
    const real along = fma(coordinate, (real)count, REAL(-0.5));
    const real inside = along < REAL(0.0) ? along + (real)count : along;
    MeasuredStep step;
    step.low = min((uint)inside, count - 1u);
    step.high = step.low + 1u == count ? 0u : step.low + 1u;
    step.part = inside - (real)step.low;
    return step;
}

/* The BRDF, per steradian, for directions above the surface. */
static CLRT_NOINLINE real3 measured_value(const Bsdf* bsdf, real3 wo, real3 wi)
{
    global const MeasuredBrdf* table = bsdf_measured(bsdf);
    const MeasuredPlace place = measured_place(wo, wi);
    const MeasuredStep half_step = measured_step(place.half_root, table->half_count);
    const MeasuredStep difference = measured_step(place.difference, table->difference_count);
    const MeasuredStep azimuth = measured_step_around(place.azimuth, table->azimuth_count);
    real3 sum = (real3)(REAL(0.0));
    for (uint corner = 0u; corner < 8u; ++corner) {
        const bool a = (corner & 1u) != 0u, d = (corner & 2u) != 0u, h = (corner & 4u) != 0u;
        const real share = (a ? azimuth.part : REAL(1.0) - azimuth.part) *
                           (d ? difference.part : REAL(1.0) - difference.part) *
                           (h ? half_step.part : REAL(1.0) - half_step.part);
        const uint row = (h ? half_step.high : half_step.low) * table->difference_count +
                         (d ? difference.high : difference.low);
        const uint cell = row * table->azimuth_count + (a ? azimuth.high : azimuth.low);
        sum += share * halves_load(cell, (global const ushort*)(table + 1));
    }
    return sum * (real)table->scale;
}

static inline MeasuredViews measured_views(const Bsdf* bsdf)
{
    const AlbedoPlace place = albedo_place(real_sqrt(bsdf->wo.z), MEASURED_VIEWS);
    MeasuredViews views;
    views.low = bsdf_measured(bsdf)->views + place.node;
    views.high = views.low + 1;
    views.part = place.part;
    return views;
}

/* Share of the directions that the cosine lobe samples. */
static inline real measured_cosine_share(MeasuredViews views)
{
    return albedo_mix((real)MEASURED_COSINE_SHARE(*views.low), (real)MEASURED_COSINE_SHARE(*views.high),
                      views.part);
}

/* Density of bsdf_measured_sample; wi.z > 0. */
static inline real measured_pdf_w(const Bsdf* bsdf, real3 wi)
{
    const MeasuredViews views = measured_views(bsdf);
    const real3 sum = bsdf->wo + wi;
    const real length = vector_length(sum);
    const real half_root = measured_half_root(real_sqrt(fma(sum.x, sum.x, sum.y * sum.y)), sum.z);
    const uint cell = min((uint)(half_root * (real)MEASURED_CELLS), MEASURED_CELLS - 1u);
    const real density =
        albedo_mix((real)views.low->density[cell], (real)views.high->density[cell], views.part);
    /* The Jacobian of the reflection is 4 wo.h, and the sum is 2 wo.h long. */
    return fma(measured_cosine_share(views), warp_cosine_hemisphere_pdf_w(wi.z),
               density / (REAL(2.0) * length));
}

static inline real bsdf_measured_size(const Bsdf* bsdf)
{
    const MeasuredViews views = measured_views(bsdf);
    return vector_color_size(
        vector_mix(vector_from(views.low->albedo), vector_from(views.high->albedo), views.part));
}

/* Head-on, of light from everywhere. */
static inline real3 bsdf_measured_albedo(const Bsdf* bsdf)
{
    return vector_from(bsdf_measured(bsdf)->views[MEASURED_VIEWS - 1u].albedo);
}

static inline void bsdf_measured_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    if (!(bsdf->wo.z > REAL(0.0) && wi.z > REAL(0.0)))
        return;
    sum->value += measured_value(bsdf, bsdf->wo, wi) * wi.z;
    sum->pdf_w = fma(bsdf->choose[LOBE_ROW_MEASURED], measured_pdf_w(bsdf, wi), sum->pdf_w);
}

/* 1 - cos of the half angle at which a cell begins. */
static inline real measured_cell_edge(uint cell)
{
    const real root = (real)cell / (real)MEASURED_CELLS;
    const real sine = real_sin_cos_quarter(root * root * (REAL(0.25) * REAL_PI)).x;
    return REAL(2.0) * sine * sine;
}

/* A half vector, uniform within its cell. */
static inline real3 measured_sample_half(global const MeasuredView* view, real2 u)
{
    uint cell = 0u, last = MEASURED_CELLS - 1u;
    while (cell < last) {
        const uint middle = (cell + last) / 2u;
        if (u.x < (real)view->cumulative[middle])
            last = middle;
        else
            cell = middle + 1u;
    }
    const real before = cell == 0u ? REAL(0.0) : (real)view->cumulative[cell - 1u];
    const real width = (real)view->cumulative[cell] - before;
    const real within = width > REAL(0.0) ? (u.x - before) / width : REAL(0.5);
    const real one_minus_cos =
        albedo_mix(measured_cell_edge(cell), measured_cell_edge(cell + 1u), real_unit(within));
    const real sine = real_root(one_minus_cos * (REAL(2.0) - one_minus_cos));
    const real2 sc = real_sin_cos_turn(u.y);
    return vector_make(sine * sc.y, sine * sc.x, REAL(1.0) - one_minus_cos);
}

/* Where the half vector is none of a direction above the surface, z <= 0: none was found. */
static inline real3 bsdf_measured_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    TRACE_SET(sample->lobe, LOBE_MEASURED);
    const MeasuredViews views = measured_views(bsdf);
    const real cosine_share = measured_cosine_share(views);
    const real u_view = (choice.u - choice.before) / bsdf->choose[LOBE_ROW_MEASURED];
    if (u_view < cosine_share)
        return warp_cosine_hemisphere(u);
    const real low_share = (REAL(1.0) - views.part) * (REAL(1.0) - (real)MEASURED_COSINE_SHARE(*views.low));
    const bool is_low = u_view < cosine_share + low_share;
    const real3 h = measured_sample_half(is_low ? views.low : views.high, u);
    return REAL(2.0) * vector_dot(bsdf->wo, h) * h - bsdf->wo;
}

#endif
