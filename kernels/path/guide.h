// SPDX-License-Identifier: Apache-2.0
// Path guiding: directions are sampled where paths have found light before. Every cell of space (cell.h)
// has a distribution of directions (guide_bins.h), in proportion to radiance times BSDF times cosine as
// paths have met them, from either end. A direction is sampled by the BSDF or by the cell and weighted by the
// density of the mixture, so the estimate is unbiased whatever the cell has learnt (Mueller, Gross and Novak
// 2017). What paths find is summed while they are traced (guide_learn.h); the host makes the next
// distributions of the sums, between launches.
#ifndef CLRT_PATH_GUIDE_H
#define CLRT_PATH_GUIDE_H

#include "cell.h"
#include "guide_bins.h"
#include "scattering/bsdf.h"

/* Lobes sharper than this are sampled by themselves alone. So is rough glass: paths stay in it for long, and
   what guides do to their weights multiplies. */
#define GUIDE_SMALLEST_ALPHA REAL(0.15)
#define GUIDE_ROUGH_LOBES (LOBE_GLOSSY | LOBE_PANE)

/* A path that weighs more than four times what it would without guides, as one does that goes on where they
   seldom send it, is sampled by the BSDF alone from there on. Weights that multiply over many vertices are
   fireflies, and none of the samples that judge a guide may show them. */
#define GUIDE_SMALLEST_RATIO REAL(0.25)

/* Of those that random numbers are: 1 - 2^-24. */
#define GUIDE_LARGEST_NUMBER REAL(0.999999940395355224609375)

/* What a vertex knows of its cell. */
typedef struct {
    uint cell;     /* NO_INDEX: the vertex is not guided */
    uint bin;      /* of the sampled direction */
    real share;    /* probability of sampling a direction by the cell */
    real radiance; /* that paths find behind such vertices, the mean; 0: not known */
    real ratio;    /* density of the sampled direction over that without the guide */
} Guide;

/* Whether a material scatters widely enough to be guided. */
static inline bool guide_suits(const Bsdf* bsdf)
{
    return (HAS(EFFECT_MATTE) && (bsdf->lobes & LOBE_MATTE)) ||
           ((bsdf->lobes & GUIDE_ROUGH_LOBES) && fmin(bsdf->alpha_x, bsdf->alpha_y) >= GUIDE_SMALLEST_ALPHA);
}

/* What tells the density of directions at a vertex apart from its BSDF's, where that is asked for later. */
typedef struct {
#if PATH_GUIDE
    uint cell; /* NO_INDEX: the vertex is not guided */
    real share;
#else
    uint unused;
#endif
} GuideShare;

/* Of a vertex that is not guided. */
static inline Guide guide_none(void)
{
    const Guide none = {NO_INDEX, 0u, REAL(0.0), REAL(0.0), REAL(1.0)};
    return none;
}

#if PATH_GUIDE
/* The cell of the point that a ray has hit, on the side of its triangle. NO_INDEX: it has missed. A cell is
   far away in memory, and much is to do before it is asked: it is on the way from now on, with what sampling
   by the cell with these numbers would read. Of a triangle that moves the side is that of the shutter's
   opening: any rule will do that ray and hit decide. */
static inline uint guide_find_cell(const Scene* scene, const RenderParams* params, const Ray* ray,
                                   const Hit* hit, real2 direction_numbers)
{
    if (hit->triangle == NO_INDEX)
        return NO_INDEX;
    real3 p[3];
    surface_corners_at(scene, scene->triangles + hit->triangle, hit_instance(hit), REAL(0.0), p);
    const real3 normal = surface_cross(p[1] - p[0], p[2] - p[0]);
    const bool is_front = vector_dot(normal, ray->direction) <= REAL(0.0);
    const real3 position = fma((real3)(hit->t), ray->direction, ray->origin);
    const uint number =
        cell_at(scene->guide.links, (real)params->scene_extent, position, is_front ? normal : -normal);
    global const GuideCell* cell = scene->guide.cells + number;
    const uint subtree = 1u + (uint)(direction_numbers.x * (real)GUIDE_SUBTREE_LEAVES);
    CLRT_PREFETCH(cell);
    CLRT_PREFETCH(cell->splits + subtree * GUIDE_SUBTREE_LEAVES / 2u);
    return number;
}
#endif

/* The guide of a vertex in a cell. `ratio`: density of the path so far over that without guides. */
static inline Guide guide_at(const Scene* scene, uint cell, real ratio, const Bsdf* bsdf)
{
    Guide guide = guide_none();
#if PATH_GUIDE
    if (!guide_suits(bsdf))
        return guide;
    guide.cell = cell;
    guide.share = ratio < GUIDE_SMALLEST_RATIO ? REAL(0.0) : (real)scene->guide.cells[guide.cell].share;
    guide.radiance = (real)scene->guide.cells[guide.cell].radiance;
#endif
    return guide;
}

#if PATH_GUIDE
/* The density with which the cell samples a direction, and the direction's bin. */
static inline real guide_pdf_w(const Scene* scene, const Guide* guide, real3 wi, uint* number)
{
    const real3 point = bins_point(wi);
    const real2 place = bins_square(point) * (real)GUIDE_SIDE;
    const GuideBin bin = bins_find(scene->guide.cells + guide->cell, min((uint)place.x, GUIDE_SIDE - 1u),
                                   min((uint)place.y, GUIDE_SIDE - 1u));
    *number = bin.number;
    return bin_pdf_w(&bin, point);
}

/* The density of the mixture where the BSDF's is bsdf_pdf_w and the cell's is cell_pdf_w. */
static inline real guide_mixture(const Guide* guide, real bsdf_pdf_w, real cell_pdf_w)
{
    return fma(guide->share, cell_pdf_w - bsdf_pdf_w, bsdf_pdf_w);
}

#endif

/* What guide_density asks of a vertex with this guide. */
static inline GuideShare guide_share(const Guide* guide)
{
    GuideShare share;
#if PATH_GUIDE
    share.cell = guide->cell;
    share.share = guide->share;
#else
    share.unused = 0u;
#endif
    return share;
}

/* The density with which such a vertex samples a direction, where its BSDF's is bsdf_pdf_w. */
static inline real guide_density(const Scene* scene, const GuideShare* share, real3 wi, real bsdf_pdf_w)
{
#if PATH_GUIDE
    if (share->cell == NO_INDEX)
        return bsdf_pdf_w;
    Guide guide = guide_none();
    guide.cell = share->cell;
    guide.share = share->share;
    return guide_mixture(&guide, bsdf_pdf_w, guide_pdf_w(scene, &guide, wi, &guide.bin));
#else
    return bsdf_pdf_w;
#endif
}

#if PATH_GUIDE
/* Samples a direction by the cell; u in (0, 1)^2. */
static inline BsdfSample guide_sample_cell(const Scene* scene, const Bsdf* bsdf, real2 u, Guide* guide)
{
    const real scaled = u.x * (real)GUIDE_BINS;
    guide->bin = (uint)scaled;
    const GuideBin bin = bins_take(scene->guide.cells + guide->cell, guide->bin);
    const real3 point = bins_octahedron(bin_place(&bin, (real2)(scaled - (real)guide->bin, u.y)));
    const real pdf_w = bin_pdf_w(&bin, point);
    BsdfSample next;
    next.wi = point / vector_length(point);
    const BsdfValue value = bsdf_eval(bsdf, next.wi);
    next.pdf_w = value.pdf_w;
    const real mixture = guide_mixture(guide, value.pdf_w, pdf_w);
    guide->ratio = mixture / value.pdf_w;
    next.weight = value.value / mixture;
    next.reflects = bsdf_reflects(bsdf, next.wi);
    next.eta = next.reflects ? REAL(1.0) : bsdf_crossed_eta(bsdf);
    next.is_weighted = true;
    next.is_valid = value.pdf_w > REAL(0.0) && !vector_is_black(value.value);
    TRACE_SET(next.lobe, 0u);
    return next;
}
#endif

/* Samples a direction by the mixture. One number chooses between cell and BSDF, and what is left of it the
   lobe. The density that it says is that of the BSDF alone: emission that is met is weighted against light
   sampling as if nothing were guided, so that light sampling need not ask the cell. */
static inline BsdfSample guide_sample(const Scene* scene, const Bsdf* bsdf, real u_lobe, real2 u,
                                      Guide* guide)
{
#if PATH_GUIDE
    if (guide->cell == NO_INDEX)
        return bsdf_sample(bsdf, u_lobe, u);
    if (u_lobe < guide->share)
        return guide_sample_cell(scene, bsdf, u, guide);
    const real rest = REAL(1.0) - guide->share;
    BsdfSample next = bsdf_sample(bsdf, fmin((u_lobe - guide->share) / rest, GUIDE_LARGEST_NUMBER), u);
    if (next.pdf_w == REAL(0.0)) {
        guide->ratio = rest;
        next.weight /= rest;
        return next;
    }
    const real pdf_w = guide_pdf_w(scene, guide, next.wi, &guide->bin);
    guide->ratio = guide_mixture(guide, next.pdf_w, pdf_w) / next.pdf_w;
    next.weight /= guide->ratio;
    return next;
#else
    return bsdf_sample(bsdf, u_lobe, u);
#endif
}

#endif
