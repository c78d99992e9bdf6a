// SPDX-License-Identifier: Apache-2.0
// Path reuse (Bekaert, Sbert and Halton 2002): what a path has gathered behind its second vertex is light for
// the first vertices of the paths of other pixels, too. First is the vertex that has a lobe with a density
// where none before it has, so behind mirrors and glass as well; second is the one after it. For builds with
// -DPATH_REUSE=1.
//
// Let x_i be the first vertices of a group's paths and y_j the second ones, f_i the BSDF times cosine at x_i,
// p_i the density with which it samples the direction to y_j, by BSDF and guide, V_ij the share of light that
// gets from y_j to x_i, P_ij the probability with which paths do, c_ij the cosine at y_j over the squared
// distance, g_ij what a reflection above y_j lets pass, and L_j what path j has found to leave y_j below it,
// emission apart. The estimate of pixel i is
//     sum over j of  f_i c_ij g_ij V_ij L_j / sum over k of p_k c_kj P_kj,
// the balance heuristic (Veach 1997) over all paths that could have come to y_j. It has no bias, and no
// quotient is larger than the path's own but by that of two g. V and P are both 0 or 1 but for cut-outs and
// panes.
//
// L_j must be the same for all: y_j is on a surface with a matte lobe, L_j is what that sends
// (reuse_matte.h), y_j is seen from the side that path j has seen, and as many segments lead to x_i as to
// x_j, so that max_depth leaves both as many behind. All else, such as emission that a path meets there, what
// other lobes send, paths that leave x_j by a delta lobe, and those that come to glass, that leave x_j into
// an absorbing solid or with one colour of three, is its own pixel's alone. Which of both a path is depends
// on x and y only, so that every light path is counted by one of them. Where splats find some paths, too
// (path_light.h), the weights of these depend on x_j: light that splats may find stays its own pixel's, which
// depends on y and what is behind it only.
#ifndef CLRT_INTEGRATORS_PATH_REUSE_H
#define CLRT_INTEGRATORS_PATH_REUSE_H

#include "path/walk.h"
#include "pixel.h"
#include "reuse_matte.h"

#if PATH_REUSE
/* A path's two vertices. */
typedef struct {
    uint segment;    /* of the path up to the first vertex, from 1; 0: there is none */
    Surface surface; /* its surface, */
    Bsdf bsdf;
    GuideShare guide; /* of its directions */
    real3 throughput; /* of the path that comes to it */
    bool has_second;  /* the second is there, and is of use to others: */
    Surface second;   /* its surface, */
    real3 normal_s;   /* its shading normal */
    real side;        /* 1 where the facet's normal points to the path, else -1 */
    real3 before;     /* what the sample had gathered when the path came to it, */
    real scale;       /* the throughput by which the rest has been gathered, */
    real3 light;      /* and that rest over it: the radiance that leaves the second vertex, */
    MatteCover cover; /* but for what this lets pass, */
    real3 passing;    /* and what it lets pass to the path itself */
    bool is_mixed;    /* other lobes send some of the rest: */
    real3 arriving;   /* throughput of the path that comes to the second vertex, */
    real3 connection, matte_connection; /* what next-event estimation has found there, and the matte share, */
    real3 matte_next;                   /* and that of what the path finds on its way on */
#if SPLATS_ARE_WEIGHTED
    real3 weighed; /* what it has gathered behind the second vertex with weights that depend on the first */
    bool is_connection_weighed; /* the connection of the present vertex is such */
#endif
} ReusedPath;

static inline void reuse_begin(ReusedPath* reused)
{
    reused->segment = 0u;
    reused->has_second = false;
#if SPLATS_ARE_WEIGHTED
    reused->weighed = (real3)(REAL(0.0));
#endif
}

/* Where a path adds what it finds: `is_weighed`: with a weight that depends on its first vertex. */
static inline real3* reuse_sum(bool is_weighed, real3* radiance, ReusedPath* reused)
{
#if SPLATS_ARE_WEIGHTED
    if (is_weighed && reused->has_second)
        return &reused->weighed;
#endif
    return radiance;
}

/* All that a path has gathered since it last began to. */
static inline real3 reuse_gathered(real3 radiance, const ReusedPath* reused)
{
#if SPLATS_ARE_WEIGHTED
    return radiance + reused->weighed;
#else
    return radiance;
#endif
}

/* Notes of which sort the connection is that the present vertex may make. */
static inline void reuse_note_connection(bool is_weighed, ReusedPath* reused)
{
#if SPLATS_ARE_WEIGHTED
    reused->is_connection_weighed = is_weighed;
#endif
}

/* Where that adds its light. */
static inline real3* reuse_connection_sum(real3* radiance, ReusedPath* reused)
{
#if SPLATS_ARE_WEIGHTED
    return reuse_sum(reused->is_connection_weighed, radiance, reused);
#else
    return radiance;
#endif
}

/* True if a segment leads to the second vertex of a path that has a first one. */
static inline bool reuse_is_second(uint segment, const ReusedPath* reused)
{
    return reused->segment != 0u && segment == reused->segment + 1u;
}

/* Keeps the first vertex, which some lobe connects to others; without it nothing is shared. None is first
   where Russian roulette could end the path there, or where it has one colour left. */
static inline void reuse_keep_first(const RenderParams* params, uint segment, const Surface* surface,
                                    const Bsdf* bsdf, const Guide* guide, const Path* path,
                                    ReusedPath* reused)
{
    if (!(params->path_choices & PATHS_ARE_SHARED) || reused->segment != 0u || !bsdf_has_smooth_lobe(bsdf))
        return;
    if (segment >= params->roulette_depth || (surface_wave(surface) & WAVE_ALONE))
        return;
    reused->segment = segment;
    reused->surface = *surface;
    reused->bsdf = *bsdf;
    reused->guide = guide_share(guide);
    reused->throughput = path->throughput;
}

/* Whether others may be connected in a direction to a first vertex. */
static inline bool reuse_leaves(const Scene* scene, const Surface* surface, const Bsdf* bsdf, real3 wi)
{
    const bool reflects = surface_reflects(surface, wi);
    return !surface_is_lifted(surface, reflects, wi) && !dispersion_splits(bsdf, reflects) &&
           solid_beside(scene, surface, reflects) == NO_INDEX;
}

/* Keeps the second vertex if it is of use to others: from then on the sample gathers what leaves it. */
static inline void reuse_keep_second(const Scene* scene, uint segment, const Surface* surface,
                                     const Bsdf* bsdf, Path* path, real3* radiance, ReusedPath* reused)
{
    if (!reuse_is_second(segment, reused) || path->pdf_w == REAL(0.0) ||
        !reuse_leaves(scene, &reused->surface, &reused->bsdf, path->ray.direction))
        return;
    const real scale = vector_max_component(path->throughput);
    if (!reuse_matte_is_of_use(bsdf) || (bsdf->flags & BSDF_BENT) || !(scale > REAL(0.0)))
        return;
    reused->cover = reuse_matte_cover(bsdf);
    if (!reuse_matte_passes(&reused->cover, bsdf->wo.z, &reused->passing))
        return;
    reused->is_mixed = bsdf->lobes != LOBE_MATTE;
    reused->arriving = path->throughput;
    reused->connection = reused->matte_connection = (real3)(REAL(0.0));
    reused->has_second = true;
    reused->second = *surface;
    reused->normal_s = bsdf->frame.z;
    reused->side = vector_dot(surface->normal_g, path->ray.direction) > REAL(0.0) ? REAL(-1.0) : REAL(1.0);
    reused->before = *radiance;
    reused->scale = scale;
    guide_count_anew(*radiance, path->throughput, scale, &path->guided);
    *radiance = (real3)(REAL(0.0));
    path->throughput = (real3)(scale);
}

/* Keeps the shares of the second vertex' matte lobe; the path is about to leave it. */
static inline void reuse_keep_shares(uint segment, const Bsdf* bsdf, const BsdfSample* next, const Path* path,
                                     ReusedPath* reused)
{
    if (!reused->has_second || !reuse_is_second(segment, reused) || !reused->is_mixed)
        return;
    const bool is_smooth = next->is_valid && next->pdf_w > REAL(0.0);
    reused->matte_next = is_smooth ? reuse_matte_share(bsdf, next->wi) : (real3)(REAL(0.0));
    if (path->is_connected)
        reused->matte_connection = reuse_matte_share(bsdf, path->light_wi);
}

/* Keeps what the path has found by the connection of a vertex. */
static inline void reuse_keep_connection(uint segment, real3 radiance, ReusedPath* reused)
{
    if (reused->has_second && reuse_is_second(segment, reused))
        reused->connection = radiance;
}

/* At the end of the path: what it has gathered for itself stays the sample's, the rest is for all. */
static inline void reuse_finish(real3* radiance, ReusedPath* reused)
{
    if (!reused->has_second)
        return;
    const real3 gathered = *radiance;
    real3 shared = gathered;
    *radiance = reused->before;
    if (reused->is_mixed) {
        /* Both parts by factors of their own: a difference could be negative by a rounding. */
        const real3 one = (real3)(REAL(1.0)), next = gathered - reused->connection;
        const real3 rest = (one - reused->matte_connection) * reused->connection +
                           (one - reused->matte_next) * next;
        shared = reused->matte_connection * reused->connection + reused->matte_next * next;
        *radiance += reused->arriving * (rest / reused->scale);
    }
#if SPLATS_ARE_WEIGHTED
    *radiance += reused->arriving * (reused->weighed / reused->scale);
#endif
    reused->light = shared / (reused->passing * reused->scale);
}

/* How a first vertex sees a second one. `is_own`: both are of one path, which has been there; where paths pass
   surfaces by chance it must still be told with which probability it came. */
static inline Passage reuse_passage(const Scene* scene, const RenderParams* params, const Surface* first,
                                    const Surface* second, real3 wi, bool is_own, PixelRays* rays)
{
    const Passage open = {(real3)(REAL(1.0)), REAL(1.0)};
    if (is_own && !HAS(EFFECTS_PASSED))
        return open;
    ++rays->shadow;
    const Ray shadow = surface_shadow_ray(first, second, wi);
    const Passage passage = visible_passage(scene, params, &shadow);
    return is_own && passage.passing == REAL(0.0) ? open : passage;
}

/* What one path's first vertex makes of another's second one: BSDF times cosines over squared distance, and
   its density there, per area; both 0 where it does not see it. `is_own`: both are of one path. */
static CLRT_NOINLINE BsdfValue reuse_connect(const Scene* scene, const RenderParams* params,
                                             const ReusedPath* eye, const ReusedPath* source, bool is_own,
                                             PixelRays* rays)
{
    const BsdfValue nothing = bsdf_value_none();
    const real3 way = source->second.position - eye->surface.position;
    const real square = vector_dot(way, way);
    if (eye->segment != source->segment || square == REAL(0.0))
        return nothing;
    const real3 wi = way / real_sqrt(square);
    const real cosine = -source->side * vector_dot(source->second.normal_g, wi);
    if (!(cosine > REAL(0.0)) || !(vector_dot(source->normal_s, wi) < REAL(0.0)) ||
        material_is_bent(&source->second, source->normal_s, -wi))
        return nothing;
    if (!reuse_leaves(scene, &eye->surface, &eye->bsdf, wi))
        return nothing;
    real3 passing;
    if (!reuse_matte_passes(&source->cover, -vector_dot(source->normal_s, wi), &passing))
        return nothing;
    BsdfValue eval = bsdf_eval(&eye->bsdf, wi);
    if (eval.pdf_w == REAL(0.0))
        return nothing;
    const Passage passage =
        reuse_passage(scene, params, &eye->surface, &source->second, wi, is_own, rays);
    eval.value *= eye->throughput * passing * passage.share * (cosine / square);
    eval.pdf_w = guide_density(scene, &eye->guide, wi, eval.pdf_w) * passage.passing * (cosine / square);
    return eval;
}

/* Shares what the second vertex of one path has found among the samples of its group, which lie `stride`
   apart. */
static inline void reuse_share_one(const Scene* scene, const RenderParams* params, const ReusedPath* source,
                                   const ReusedPath* reused, uint members, uint stride, CameraSample* samples,
                                   PixelRays* rays)
{
    real3 values[REUSE_PIXELS];
    real density = REAL(0.0);
    for (uint i = 0; i < members; ++i) {
        const ReusedPath* eye = &reused[i * stride];
        const BsdfValue eval = reuse_connect(scene, params, eye, source, eye == source, rays + i);
        values[i] = eval.value;
        density += eval.pdf_w;
    }
    if (density == REAL(0.0))
        return;
    for (uint i = 0; i < members; ++i)
        samples[i * stride].radiance += values[i] * source->light / density;
}

/* Shares what finished paths have found: those of equal number among the samples of each pixel. */
static CLRT_NOINLINE void reuse_share(const Scene* scene, const RenderParams* params, uint count,
                                      ReusedPath* reused, CameraSample* samples, PixelRays* rays)
{
    const uint members = samples[count - 1u].member + 1u;
    const uint stride = count / members;
    for (uint k = 0; k < count; ++k)
        reuse_finish(&samples[k].radiance, &reused[k]);
    for (uint k = 0; k < count; ++k)
        if (reused[k].has_second && !vector_is_black(reused[k].light))
            reuse_share_one(scene, params, &reused[k], reused + k % stride, members, stride,
                            samples + k % stride, rays);
}
#else
typedef struct {
    uint unused;
} ReusedPath;

static inline void reuse_begin(ReusedPath* reused) {}

static inline real3* reuse_sum(bool is_weighed, real3* radiance, ReusedPath* reused)
{
    return radiance;
}

static inline real3 reuse_gathered(real3 radiance, const ReusedPath* reused) { return radiance; }

static inline void reuse_note_connection(bool is_weighed, ReusedPath* reused) {}

static inline real3* reuse_connection_sum(real3* radiance, ReusedPath* reused) { return radiance; }

static inline void reuse_keep_first(const RenderParams* params, uint segment, const Surface* surface,
                                    const Bsdf* bsdf, const Guide* guide, const Path* path,
                                    ReusedPath* reused)
{
}

static inline void reuse_keep_second(const Scene* scene, uint segment, const Surface* surface,
                                     const Bsdf* bsdf, Path* path, real3* radiance, ReusedPath* reused)
{
}

static inline void reuse_keep_shares(uint segment, const Bsdf* bsdf, const BsdfSample* next, const Path* path,
                                     ReusedPath* reused)
{
}

static inline void reuse_keep_connection(uint segment, real3 radiance, ReusedPath* reused) {}

static inline void reuse_share(const Scene* scene, const RenderParams* params, uint count, ReusedPath* reused,
                               CameraSample* samples, PixelRays* rays)
{
}
#endif

#endif
