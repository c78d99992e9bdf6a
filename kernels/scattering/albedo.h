// SPDX-License-Identifier: Apache-2.0
// What GGX microfacets lose when light is followed to its first facet only, and what Schlick's Fresnel adds
// to them: directional albedos of the lobes in bsdf_glossy.h and bsdf_dielectric.h, from tables.
// tools/fit_albedo.py integrates them and explains the coordinates. The tables lose rather too little than
// too much, by their error: nothing made from them adds light.
#ifndef CLRT_SCATTERING_ALBEDO_H
#define CLRT_SCATTERING_ALBEDO_H

#include "albedo_dielectric_table.h"
#include "albedo_reflection_table.h"
#include "albedo_stretched_table.h"
#include "numerics/vector.h"

/* The roughness of a lobe in the tables' coordinates. */
typedef struct {
    real alpha;        /* sqrt(alpha_x alpha_y) */
    real root;         /* coordinate of alpha: its fourth root from the smallest one's to 1 */
    real aspect;       /* coordinate of the narrower alpha over the wider one; 0: both are equal */
    real wide, narrow; /* the two alphas, the wider first, */
    bool is_wide_x;    /* and whether it is along x */
} AlbedoRoughness;

/* Of one direction: the share that its first facet does not send on, and the part of the rest that a
   reflectance (1 - cos)^5 sends back. */
typedef struct {
    real loss;
    real schlick;
} Albedo;

/* A place between the nodes of an axis. */
typedef struct {
    uint node;
    real part; /* of the way to the next node */
} AlbedoPlace;

static inline AlbedoPlace albedo_place(real coordinate, uint nodes)
{
    const real along = clamp(coordinate, REAL(0.0), REAL(1.0)) * (real)(nodes - 1u);
    AlbedoPlace place;
    place.node = min((uint)along, nodes - 2u);
    place.part = along - (real)place.node;
    return place;
}

static inline real albedo_mix(real a, real b, real part) { return fma(part, b - a, a); }

/* Interpolates codes along the last axis, the last two, three, four. `first` is the index of the lowest
   corner. */
static inline real albedo_line(constant ushort* codes, uint first, AlbedoPlace x)
{
    return albedo_mix((real)codes[first], (real)codes[first + 1u], x.part);
}

static inline real albedo_plane(constant ushort* codes, uint first, uint row, AlbedoPlace y, AlbedoPlace x)
{
    return albedo_mix(albedo_line(codes, first, x), albedo_line(codes, first + row, x), y.part);
}

static inline real albedo_block(constant ushort* codes, uint first, uint slice, uint row, AlbedoPlace z,
                                AlbedoPlace y, AlbedoPlace x)
{
    return albedo_mix(albedo_plane(codes, first, row, y, x), albedo_plane(codes, first + slice, row, y, x),
                      z.part);
}

/* A cosine beside a roughness alpha. */
typedef struct {
    real cosine, alpha;
    real inverse; /* 1 / (cosine + alpha) */
} AlbedoAngle;

static inline AlbedoAngle albedo_angle(const AlbedoRoughness* rough, real3 w)
{
    const real cosine = fmin(fabs(w.z), REAL(1.0));
    const AlbedoAngle angle = {cosine, rough->alpha, REAL(1.0) / (cosine + rough->alpha)};
    return angle;
}

/* Its coordinate: c^(3/4) with c = cos (1 + alpha) / (cos + alpha). */
static inline real albedo_coordinate(const AlbedoAngle* angle)
{
    const real root = real_sqrt(angle->cosine * (REAL(1.0) + angle->alpha) * angle->inverse);
    return root * real_sqrt(root);
}

/* h -> the loss z^2 h with z = alpha / (cos + alpha). */
static inline real albedo_loss(real h, const AlbedoAngle* angle)
{
    const real z = angle->alpha * angle->inverse;
    return z * z * h;
}

static inline AlbedoRoughness albedo_roughness(real alpha_x, real alpha_y)
{
    AlbedoRoughness rough;
    rough.is_wide_x = alpha_x >= alpha_y;
    rough.wide = fmax(alpha_x, alpha_y);
    rough.narrow = fmin(alpha_x, alpha_y);
    const bool is_round = alpha_x == alpha_y;
    rough.alpha = clamp(is_round ? alpha_x : real_sqrt(alpha_x * alpha_y), ALBEDO_SMALLEST_ALPHA, REAL(1.0));
    const real smallest = real_sqrt(real_sqrt(ALBEDO_SMALLEST_ALPHA));
    rough.root = (real_sqrt(real_sqrt(rough.alpha)) - smallest) / (REAL(1.0) - smallest);
    rough.aspect = REAL(0.0);
    if (!is_round)
        rough.aspect = (REAL(1.0) - real_sqrt(real_sqrt(rough.narrow / rough.wide))) /
                       (REAL(1.0) - real_sqrt(real_sqrt(ALBEDO_SMALLEST_ASPECT)));
    return rough;
}

/* Loss and Schlick's part from h, k and the cosine. */
static inline Albedo albedo_of(real h, real k, const AlbedoAngle* angle)
{
    Albedo albedo;
    albedo.loss = albedo_loss(h, angle);
    const real m = clamp(REAL(1.0) - fma(angle->alpha, k, angle->cosine), REAL(0.0), REAL(1.0));
    const real m2 = m * m;
    albedo.schlick = (REAL(1.0) - albedo.loss) * (m2 * m2 * m);
    return albedo;
}

/* Reflection by stretched microfacets: the tables have two axes more, the aspect and the roughness along the
   azimuth. */
static CLRT_NOINLINE Albedo albedo_stretched(const AlbedoRoughness* rough, real3 w)
{
    const AlbedoAngle angle = albedo_angle(rough, w);
    const real across = fma(w.x, w.x, w.y * w.y);
    const real wide = rough->wide * (rough->is_wide_x ? w.x : w.y);
    const real narrow = rough->narrow * (rough->is_wide_x ? w.y : w.x);
    /* Straight up every azimuth is as good as another. */
    const real along =
        across > REAL(0.0) ? real_sqrt(fma(wide, wide, narrow * narrow) / across) : rough->narrow;
    const AlbedoPlace aspect = albedo_place(rough->aspect, ALBEDO_STRETCHED_ASPECTS);
    const AlbedoPlace spread =
        albedo_place((along - rough->narrow) / (rough->wide - rough->narrow), ALBEDO_STRETCHED_SPREADS);
    const AlbedoPlace y = albedo_place(rough->root, ALBEDO_STRETCHED_ALPHAS);
    const AlbedoPlace x = albedo_place(albedo_coordinate(&angle), ALBEDO_STRETCHED_COSINES);
    const uint row = ALBEDO_STRETCHED_COSINES, slice = row * ALBEDO_STRETCHED_ALPHAS;
    const uint block = slice * ALBEDO_STRETCHED_SPREADS;
    const uint first = aspect.node * block + spread.node * slice + y.node * row + x.node;
    const real h =
        albedo_mix(albedo_block(ALBEDO_STRETCHED_H, first, slice, row, spread, y, x),
                   albedo_block(ALBEDO_STRETCHED_H, first + block, slice, row, spread, y, x), aspect.part);
    const real k =
        albedo_mix(albedo_block(ALBEDO_STRETCHED_K, first, slice, row, spread, y, x),
                   albedo_block(ALBEDO_STRETCHED_K, first + block, slice, row, spread, y, x), aspect.part);
    return albedo_of(fma(h, ALBEDO_STRETCHED_H_STEP, ALBEDO_STRETCHED_H_LOW),
                     fma(k, ALBEDO_STRETCHED_K_STEP, ALBEDO_STRETCHED_K_LOW), &angle);
}

/* Where in the tables of round facets an angle is. */
typedef struct {
    uint first;
    AlbedoPlace y, x;
} AlbedoCell;

static inline AlbedoCell albedo_cell(const AlbedoRoughness* rough, const AlbedoAngle* angle)
{
    AlbedoCell cell;
    cell.y = albedo_place(rough->root, ALBEDO_REFLECTION_ALPHAS);
    cell.x = albedo_place(albedo_coordinate(angle), ALBEDO_REFLECTION_COSINES);
    cell.first = cell.y.node * ALBEDO_REFLECTION_COSINES + cell.x.node;
    return cell;
}

static inline real albedo_reflection_h(const AlbedoCell* cell)
{
    return fma(albedo_plane(ALBEDO_REFLECTION_H, cell->first, ALBEDO_REFLECTION_COSINES, cell->y, cell->x),
               ALBEDO_REFLECTION_H_STEP, ALBEDO_REFLECTION_H_LOW);
}

/* Reflection of light from a local direction. */
static inline Albedo albedo_reflection(const AlbedoRoughness* rough, real3 w)
{
    if (rough->aspect != REAL(0.0))
        return albedo_stretched(rough, w);
    const AlbedoAngle angle = albedo_angle(rough, w);
    const AlbedoCell cell = albedo_cell(rough, &angle);
    const uint row = ALBEDO_REFLECTION_COSINES;
    const real k = fma(albedo_plane(ALBEDO_REFLECTION_K, cell.first, row, cell.y, cell.x),
                       ALBEDO_REFLECTION_K_STEP, ALBEDO_REFLECTION_K_LOW);
    return albedo_of(albedo_reflection_h(&cell), k, &angle);
}

/* The loss alone. */
static inline real albedo_reflection_loss(const AlbedoRoughness* rough, real3 w)
{
    if (rough->aspect != REAL(0.0))
        return albedo_stretched(rough, w).loss;
    const AlbedoAngle angle = albedo_angle(rough, w);
    const AlbedoCell cell = albedo_cell(rough, &angle);
    return albedo_loss(albedo_reflection_h(&cell), &angle);
}

/* Interpolates means along alpha, and along alpha and another axis. */
static inline real albedo_mean_line(constant float* means, uint first, AlbedoPlace y)
{
    return albedo_mix((real)means[first], (real)means[first + 1u], y.part);
}

static inline real albedo_mean_plane(constant float* means, AlbedoPlace z, AlbedoPlace y)
{
    const uint first = z.node * ALBEDO_MEAN_ALPHAS + y.node;
    return albedo_mix(albedo_mean_line(means, first, y),
                      albedo_mean_line(means, first + ALBEDO_MEAN_ALPHAS, y), z.part);
}

/* The same of light from everywhere, weighted by its cosine. */
static inline Albedo albedo_reflection_mean(const AlbedoRoughness* rough)
{
    const AlbedoPlace y = albedo_place(rough->root, ALBEDO_MEAN_ALPHAS);
    Albedo mean;
    if (rough->aspect != REAL(0.0)) {
        const AlbedoPlace z = albedo_place(rough->aspect, ALBEDO_STRETCHED_ASPECTS);
        mean.loss = albedo_mean_plane(ALBEDO_STRETCHED_MEAN_LOSS, z, y);
        mean.schlick = albedo_mean_plane(ALBEDO_STRETCHED_MEAN_B, z, y);
    } else {
        mean.loss = albedo_mean_line(ALBEDO_REFLECTION_MEAN_LOSS, y.node, y);
        mean.schlick = albedo_mean_line(ALBEDO_REFLECTION_MEAN_B, y.node, y);
    }
    mean.loss *= rough->alpha * rough->alpha;
    return mean;
}

/* The coordinate of a relative index: the root of the contrast |eta - 1| / (eta + 1). */
static inline real albedo_contrast(real eta)
{
    return real_sqrt(fabs(eta - REAL(1.0)) / ((eta + REAL(1.0)) * ALBEDO_LARGEST_CONTRAST));
}

/* Between the first contrasts, indices that differ by less than 1.4 %, the loss bends more than the table
   follows: head-on at alpha 1 it gave 0.011 for 0.008. This share is taken off where the indices are equal,
   less and less up to the next node. */
#define ALBEDO_DIELECTRIC_EXCESS REAL(0.25)

/* What a dielectric boundary neither reflects nor refracts of light with this cosine; eta: index on the
   light's side over the index on the other. */
static inline real albedo_dielectric_loss(const AlbedoRoughness* rough, real eta, real cos_w)
{
    const AlbedoPlace z = albedo_place(albedo_contrast(eta), ALBEDO_DIELECTRIC_CONTRASTS);
    const AlbedoPlace y = albedo_place(rough->root, ALBEDO_DIELECTRIC_ALPHAS);
    const AlbedoAngle angle = {cos_w, rough->alpha, REAL(1.0) / (cos_w + rough->alpha)};
    const AlbedoPlace x = albedo_place(albedo_coordinate(&angle), ALBEDO_DIELECTRIC_COSINES);
    const uint row = ALBEDO_DIELECTRIC_COSINES, slice = row * ALBEDO_DIELECTRIC_ALPHAS;
    const uint first = z.node * slice + y.node * row + x.node;
    const real h = eta > REAL(1.0) ? fma(albedo_block(ALBEDO_INSIDE_H, first, slice, row, z, y, x),
                                         ALBEDO_INSIDE_H_STEP, ALBEDO_INSIDE_H_LOW)
                                   : fma(albedo_block(ALBEDO_OUTSIDE_H, first, slice, row, z, y, x),
                                         ALBEDO_OUTSIDE_H_STEP, ALBEDO_OUTSIDE_H_LOW);
    const real excess = z.node == 0u ? ALBEDO_DIELECTRIC_EXCESS * (REAL(1.0) - z.part) : REAL(0.0);
    return albedo_loss(h, &angle) * (REAL(1.0) - excess);
}

/* Its mean. */
static inline real albedo_dielectric_mean_loss(const AlbedoRoughness* rough, real eta)
{
    const AlbedoPlace z = albedo_place(albedo_contrast(eta), ALBEDO_DIELECTRIC_CONTRASTS);
    const AlbedoPlace y = albedo_place(rough->root, ALBEDO_MEAN_ALPHAS);
    const real mean = eta > REAL(1.0) ? albedo_mean_plane(ALBEDO_INSIDE_MEAN_LOSS, z, y)
                                      : albedo_mean_plane(ALBEDO_OUTSIDE_MEAN_LOSS, z, y);
    return mean * rough->alpha * rough->alpha;
}

#endif
