// SPDX-License-Identifier: Apache-2.0
// The device's view of the scene: every kernel takes its heaps through SCENE_PARAMS, finds the arrays in them
// (SCENE_MAKE) and passes a pointer to the private Scene down.
#ifndef CLRT_GEOMETRY_SCENE_H
#define CLRT_GEOMETRY_SCENE_H

#include "shared/scene_arrays.h"
#include "shared/render_types.h"
#include "shared/effects.h"
#include "shared/guide_types.h"
#include "numerics/vector.h"
#include "trace/trace.h"

/* Whether directions are guided by what paths have found (path/guide.h). */
#ifndef PATH_GUIDE
#define PATH_GUIDE 0
#endif
#ifndef PATH_REUSE
#define PATH_REUSE 0
#endif

#ifndef BVH_LAYOUT
#define BVH_LAYOUT BVH_LAYOUT_BVH8
#endif

/* What guided paths read, and the sums that they add to. */
typedef struct {
    global const uint* restrict links;
    global const GuideCell* restrict cells;
    global long* sums;
    global const float* restrict weights; /* of gains (path/guide_gain.h), a tile each */
    global long* gains;
} GuideArrays;

typedef struct {
#define SCENE_ARRAY(type, name, member) global const type* restrict name;
    BVH_ARRAYS(SCENE_ARRAY)
    SCENE_ARRAYS(SCENE_ARRAY)
    PATH_ARRAYS(SCENE_ARRAY)
#undef SCENE_ARRAY
#if PATH_GUIDE
    GuideArrays guide;
#endif
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    bool moves; /* triangles move while the shutter is open */
#endif
#if CLRT_EFFECTS & EFFECT_MAPPED_EMISSION
    bool has_emitter_parts;
#endif
#if CLRT_EFFECTS & EFFECT_SECOND_UV
    bool has_second_uvs;
#endif
#ifdef CLRT_COUNT_VISITS
    uint* visits; /* of the rays so far: nodes, leaves, triangles; to be set by whoever counts */
#endif
#ifdef CLRT_TRACE
    Trace* trace; /* the record of the sample at hand; to be set by whoever traces */
#endif
} Scene;

/* Count what a traversal visits, in builds that are made to (clrt-bench); else they are nothing. */
#ifdef CLRT_COUNT_VISITS
#define SCENE_COUNT_NODE(scene) (++(scene)->visits[0])
#define SCENE_COUNT_LEAF(scene, triangle_count) (++(scene)->visits[1], (scene)->visits[2] += (triangle_count))
#else
#define SCENE_COUNT_NODE(scene)
#define SCENE_COUNT_LEAF(scene, triangle_count)
#endif

static inline bool scene_moves(const Scene* scene)
{
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    return scene->moves;
#else
    return false;
#endif
}

/* A heap, in units of SCENE_ALIGNMENT bytes. */
typedef global const ulong16* SceneHeap;

/* The arguments by which every kernel takes the scene, and the Scene that they make. */
#define SCENE_PARAMS                                                                                         \
    SceneHeap restrict scene_heap0, SceneHeap restrict scene_heap1, SceneHeap restrict scene_heap2,          \
        SceneHeap restrict scene_heap3, SceneHeap restrict scene_heap4, SceneHeap restrict scene_heap5,      \
        SceneHeap restrict scene_heap6
#define SCENE_MAKE                                                                                           \
    scene_make(scene_heap0, scene_heap1, scene_heap2, scene_heap3, scene_heap4, scene_heap5, scene_heap6)

static inline Scene scene_make(SceneHeap heap0, SceneHeap heap1, SceneHeap heap2, SceneHeap heap3,
                               SceneHeap heap4, SceneHeap heap5, SceneHeap heap6)
{
    const SceneHeap heaps[SCENE_HEAPS] = {heap0, heap1, heap2, heap3, heap4, heap5, heap6};
    global const ArrayPlaces* places = (global const ArrayPlaces*)heap0;
    Scene scene;
#define SCENE_ARRAY(type, name, member)                                                                      \
    scene.name = (global const type*)(heaps[places->name.heap] + places->name.first);
    BVH_ARRAYS(SCENE_ARRAY)
    SCENE_ARRAYS(SCENE_ARRAY)
    PATH_ARRAYS(SCENE_ARRAY)
#undef SCENE_ARRAY
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    scene.moves = places->position_moves.is_empty == 0u;
#endif
#if CLRT_EFFECTS & EFFECT_MAPPED_EMISSION
    scene.has_emitter_parts = places->emitter_parts.is_empty == 0u;
#endif
#if CLRT_EFFECTS & EFFECT_SECOND_UV
    scene.has_second_uvs = places->second_uvs.is_empty == 0u;
#endif
#ifdef CLRT_COUNT_VISITS
    scene.visits = 0;
#endif
#ifdef CLRT_TRACE
    scene.trace = 0;
#endif
    return scene;
}

#endif
