// SPDX-License-Identifier: Apache-2.0
// Second moments, for a pilot that compares path tracing with an integrator that has its techniques and more
// (-DFILM_MOMENTS=1): splats, or splats and inner connections. Both are told by the same samples. Let a path
// contribute c = f / (p_hit + p_connect + p_others) to its pixel, by whichever technique it was found
// (balance heuristic). Of the pixel's estimate by all techniques the second moment is the sum of c^2, and of
// that by the first two alone the sum of c^2 e, the excess e being the sum of all densities over p_hit +
// p_connect: both are integrals of f^2 over a density, and these samples have the density of the sum
// (Grittmann, Yazici, Georgiev, Slusallek 2022). So light paths tell the variance of light that paths from
// the eye meet too seldom to tell it themselves, and the noise of the comparison is common to both.
//
// Roulette ends light paths that are connected to paths from the eye sooner than path ends its own: that they
// are rarer by this must not look as if path were noisier (path/roulette.h).
//
// What one path from the eye gathers at several vertices is correlated. If y_i is what it would gather at a
// vertex by hits and next-event estimation alone, and x_i = (1 - w_i) y_i what it does, its part of the
// second moment without the others is
//     (sum y_i)^2 - sum w_i y_i^2:
// squares of y_i alone are left to the samples of all techniques, each with its share.
//
// The other way round, path's next-event estimation finds lamps behind slabs (path/slab_bend.h) that these
// integrators may have nothing but hits for, too rare to tell their own noise. Where it contributes h =
// f / p_connect, the mean square of hits exceeds its own by the mean of h^2 (p_connect / p_hit - 1).
#ifndef CLRT_FILM_MOMENTS_H
#define CLRT_FILM_MOMENTS_H

#include "film/film.h"
#include "shared/moment_types.h"

/* Stands for infinity where paths from the eye find nothing: 0 times it is 0. */
#define MOMENT_RIVALLED REAL(1e30)

#ifndef FILM_MOMENTS
#define FILM_MOMENTS 0
#endif

/* What a path from the eye would have gathered alone, and what the others beside it have cost. */
typedef struct {
    real3 radiance;
    real3 shared;                 /* sum of w y^2, less what inner connections tell */
    real3 connection;             /* of the present vertex, if nothing is in between */
    uint light_rays, camera_rays; /* of the paths from the lights; from those to the camera */
    uint inner_rays;              /* of inner connections */
    real3 hidden, missed;         /* as the planes of that name */
} Moments;

static inline void moments_begin(Moments* moments)
{
    moments->light_rays = moments->camera_rays = moments->inner_rays = 0u;
    moments->radiance = moments->shared = moments->connection = (real3)(REAL(0.0));
    moments->hidden = moments->missed = (real3)(REAL(0.0));
}

/* Light that is weighted against splats and inner connections, and the same without them. */
static inline void moments_gather(real3 with, real3 without, Moments* moments)
{
    moments->radiance += without;
    moments->shared += without * (without - with);
}

/* Light by an inner connection, as it would be if all of `count` vertices were connected: one of them is, and
   counts for all. `excess` as of moments_add_splat. */
static inline void moments_connect(real3 light, real count, real excess, Moments* moments)
{
    ++moments->inner_rays;
    moments->shared -= light * light * (count * fmin(excess, MOMENT_RIVALLED));
}

/* Light that nothing but hits finds, as next-event estimation does; `rarity`: its density over theirs. */
static inline void moments_miss(real3 light, real rarity, Moments* moments)
{
    moments->hidden += light;
    moments->missed += light * light * clamp(rarity - REAL(1.0), REAL(0.0), MOMENT_RIVALLED);
}

/* A square as a number to be added. */
static inline long moments_round(const RenderParams* params, real square, uint word)
{
    const real unit = (real)params->inverse_quantum * (real)params->inverse_quantum / (real)MOMENT_UNIT;
    return film_round(fmin(square * unit, (real)MOMENT_LARGEST), word);
}

/* Adds squares to a slot of a plane. */
static inline void moments_add(const RenderParams* params, global long* film, uint slot, uint plane,
                               uint word, real3 squares)
{
    global long* sums = film_plane_sums(params, film, slot, params->film_replicates + plane);
    sum_add(sums, moments_round(params, squares.x, word));
    sum_add(sums + 1, moments_round(params, squares.y, word * 0x9e3779b9u));
    sum_add(sums + 2, moments_round(params, squares.z, word * 0x85ebca6bu));
}

/* Adds a sample and what it has gathered. Bad ones are left out. */
static inline void moments_add_sample(const RenderParams* params, global long* film, uint slot,
                                      const Sampler* sampler, real3 radiance, const Moments* moments)
{
    global long* gathered = film_plane_sums(params, film, slot, params->film_replicates + MOMENTS_GATHERED);
    global long* rays = film_plane_sums(params, film, slot, params->film_replicates + MOMENTS_RAYS);
    sum_add(rays, moments->light_rays);
    sum_add(rays + 1, moments->camera_rays);
    sum_add(rays + 2, moments->inner_rays);
    if (film_fault(params, radiance) != COUNT_WORDS || film_fault(params, moments->radiance) != COUNT_WORDS)
        return;
    const uint word = sampler_word(sampler, 0u, SAMPLE_ROUNDING);
    film_add_rounded(params, gathered, word, radiance);
    moments_add(params, film, slot, MOMENTS_SPLATTED, word, radiance * radiance);
    moments_add(params, film, slot, MOMENTS_ALONE, word,
                moments->radiance * moments->radiance - moments->shared);
    if (vector_is_zero(moments->hidden) || film_fault(params, moments->hidden) != COUNT_WORDS)
        return;
    global long* hidden = film_plane_sums(params, film, slot, params->film_replicates + MOMENTS_HIDDEN);
    film_add_rounded(params, hidden, word, moments->hidden);
    moments_add(params, film, slot, MOMENTS_MISSED, word, moments->missed);
}

/* Adds a good splat, number `number` of its sample. `excess`: all densities over those of hit and next-event
   estimation; infinite where they cannot find it. */
static inline void moments_add_splat(const RenderParams* params, global long* film, uint slot,
                                     const Sampler* sampler, uint number, real3 radiance, real excess)
{
    if (film_fault(params, radiance) != COUNT_WORDS)
        return;
    const uint word = sampler_word(sampler, number, SAMPLE_ROUNDING);
    const real3 squares = radiance * radiance;
    moments_add(params, film, slot, MOMENTS_SPLATTED, word, squares);
    moments_add(params, film, slot, MOMENTS_ALONE, word, squares * fmin(excess, MOMENT_RIVALLED));
}

#endif
