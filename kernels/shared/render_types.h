// SPDX-License-Identifier: Apache-2.0
// What one launch needs besides the scene's arrays. Passed to every kernel by value.
#ifndef CLRT_SHARED_RENDER_TYPES_H
#define CLRT_SHARED_RENDER_TYPES_H

#include "camera_types.h"
#include "types.h"

SHARED_BEGIN

#define FILTER_BOX 0u
#define FILTER_TENT 1u
#define FILTER_GAUSSIAN 2u

/* The deepest tree of `whitted`; every level leaves at most one ray waiting on its stack. The command line
   refuses more. */
#define WHITTED_MAX_DEPTH 64

typedef struct {
    CameraParams camera;
    vec4 environment; /* rgb: radiance of a constant environment, or factor of the map;
                         w: LIGHT_TREE_IS_USED */
    vec4 background;  /* rgb: radiance that camera rays see outside the scene; w: BACKGROUND_IS_SEEN */

    u32 width, height;          /* of the whole picture, pixels */
    u32 crop_x, crop_y;         /* top left pixel of the rendered window */
    u32 crop_width, crop_height;
    u32 first_sample;           /* of this launch */
    u32 sample_count;           /* of this launch: samples first_sample .. first_sample + sample_count - 1 */
    u32 replicates;             /* sample s belongs to replicate s mod replicates */
    /* An adaptive launch deals samples to half of them only: sample s of the half is number
       s / dealt_replicates of replicate first_replicate + s mod dealt_replicates. */
    u32 first_replicate, dealt_replicates;
    u32 film_replicates;        /* that have sums of their own: a power of two, at most `replicates` */
    u32 seed;
    u32 epoch;                  /* of a guided render (path/numbers.h), else 0 */
    u32 max_depth;              /* path segments */
    float min_contribution;     /* whitted: smallest weight worth a ray */
    u32 filter;                 /* FILTER_* */
    float filter_radius;        /* pixels */
    float patch_gap;            /* of a pilot: share of the sides of its patches that nothing is seen of; */
    u32 patch_last;             /* last pixel of a row or column of a patch: 0, or up to TILE_SIZE - 1 a
                                   power of two less 1 */
    float scene_extent;         /* largest |coordinate| of the geometry */

    u32 emitter_count, light_count;
    u32 environment_width, environment_height; /* 0: constant */
    float environment_cos, environment_sin;    /* rotation of the map about +Y */
    float choose_emitter, choose_environment;  /* probabilities of the kinds in next-event estimation; */
    float choose_light;                        /* they sum to 1, or are all 0 */
    u32 roulette_depth;         /* first path segment that Russian roulette may end */
    float emit_emitter, emit_environment; /* probabilities of the kinds where light paths start; */
    float emit_light;                     /* they sum to 1, or are all 0 */
    float emission_radius; /* of the sphere about the origin that holds all that distant light meets */

    float quantum;              /* radiance of one unit of the fixed-point film; a power of two */
    float inverse_quantum;
    float largest_contribution; /* in radiance; larger samples count as overflow */
    u32 tile_count;             /* 8x8 tiles of the window */
    u32 tiles_x;                /* tiles a row */
    u32 tile_stride;            /* coprime to tile_count: spreads neighbouring work-groups over the picture */
    u32 first_tile, end_tile;   /* this launch renders tiles first_tile .. end_tile - 1 of the spread order */
    u32 guide_learns;           /* paths teach the guide whose sample has at most this number within its
                                   replicate, its bits reversed, plus the pixel's key, modulo 2^32 */
    u32 caster_count;           /* spheres at which emission is aimed, */
    float caster_squares;       /* and the sum of their squared radii */
    u32 light_path_count;       /* of a pass over the whole picture */
    u32 environment_format;     /* SKY_TEXEL_* */
    u32 texture_filter;         /* 1: lookups are filtered over the ray's footprint */
    u32 portal_count;           /* rectangles through which the sky is seen */
    float portal_share;         /* probability of sampling the sky through them */
    u32 path_choices;           /* what paths do, in programs that can; see below */
    u32 shadow_rays;            /* that a vertex branches into, where it does: to lights, */
    u32 gloss_rays;             /* by rough reflection, */
    u32 translucent_rays;       /* and by rough glass */
    u32 unused0;
} RenderParams;
ASSERT_SIZE(RenderParams, 448);

/* Paths serve other pixels, too (integrators/path_reuse.h). */
#define PATHS_ARE_SHARED 1u
/* Vertices are connected to light at infinity through slabs of glass (path/slab.h). */
#define SLABS_ARE_CROSSED 2u
/* The logarithm of how many light samples a path takes at its first vertex (path/light_samples.h). */
#define LIGHT_SAMPLES_SHIFT 2u
#define LIGHT_SAMPLES_LOG(params) ((params).path_choices >> LIGHT_SAMPLES_SHIFT & 3u)
#define MOST_LIGHT_SAMPLES 8
/* Camera rays for emission may go on at mirrors and smooth glass, where EMISSION_GOES_ON says so. */
#define MIRRORS_SHOW_EMISSION 16u
/* Camera rays a sample from which emission comes, where it does not come from paths. */
#define EMISSION_RAYS_SHIFT 8u
#define EMISSION_RAYS(params) ((params).path_choices >> EMISSION_RAYS_SHIFT)

/* 1 where the light tree chooses lights for next-event estimation, 0 where tables do. */
#define LIGHT_TREE_IS_USED(params) ((params).environment.w)

/* 1 where camera rays see the background, 0 where they see sky and suns. */
#define BACKGROUND_IS_SEEN(params) ((params).background.w)

/* The picture is rendered and summed in tiles of 8 x 8 pixels; sums of a tile lie together. */
#define TILE_SIZE 8
#define TILE_PIXELS 64

/* Pixels of a tile whose paths serve each other where paths are reused (integrators/path_reuse.h). */
#define REUSE_PIXELS 8

/* Counts of a pixel, over all its samples: these u32 a slot. */
#define PIXEL_RAYS_WORDS 8
#define PIXEL_RAYS_SECONDARY 0
#define PIXEL_RAYS_SHADOW 1
#define PIXEL_BAD_SAMPLES 2
#define PIXEL_CUT_PATHS 3
#define PIXEL_CUT_WEIGHT_LOW 4  /* 64 bits in two words */
#define PIXEL_CUT_WEIGHT_HIGH 5
#define PIXEL_SHOWN 6           /* 1 once a camera ray has hit the scene */
#define PIXEL_EMISSION 7        /* EMISSION_*: whence the emission comes that the pixel sees */

/* From the first segments of its paths, from camera rays of its own (integrators/emission_rays.h), or from
   whichever of both the pixel's first launch finds better. Bits beside the latter two: lights may be too small
   there for the first launch to find them; what is seen by way of lobes without a density is emission that the
   pixel sees, too. */
#define EMISSION_BY_PATHS 0u
#define EMISSION_BY_RAYS 1u
#define EMISSION_OPEN 2u
#define EMISSION_SMALL 4u
#define EMISSION_GOES_ON 8u
/* Segments of a camera ray that goes on. */
#define EMISSION_SEGMENTS 8u

/* Weights of paths that max_depth cuts are summed in units of 2^-20, each rounded up: the sum is a bound, and
   the same in any order. Larger weights count as the largest, so that 2^27 of them fit the 64 bits of a
   pixel. */
#define CUT_WEIGHT_UNITS 1048576
#define CUT_WEIGHT_LARGEST 65536

/* Behind them, the samples of an adaptive launch: two u32 a tile. */
#define TILE_RANGE_WORDS 2
#define TILE_RANGE_FIRST 0
#define TILE_RANGE_COUNT 1

/* Counters of a run, u32 each. */
#define COUNT_NAN 0
#define COUNT_INFINITE 1
#define COUNT_NEGATIVE 2
#define COUNT_OVERFLOW 3
#define COUNT_BAD_SAMPLES 4 /* entries written to the replay list, may exceed its capacity */
#define COUNT_WORDS 16
#define REPLAY_CAPACITY 64  /* (pixel, sample) pairs after the counters */

SHARED_END

#endif
