// SPDX-License-Identifier: Apache-2.0
// The device's view of the scene: every kernel takes the buffers through SCENE_PARAMS, gathers them in a private Scene
// and passes a pointer down.
#ifndef CLRT_GEOMETRY_SCENE_H
#define CLRT_GEOMETRY_SCENE_H

#include "shared/scene_types.h"
#include "shared/render_types.h"
#include "shared/bvh_types.h"
#include "shared/effects.h"
#include "numerics/vector.h"
#include "trace/trace.h"

#ifndef BVH_LAYOUT
#define BVH_LAYOUT BVH_LAYOUT_BVH8
#endif

typedef struct {
    global const uint* restrict bvh_nodes;
    global const uint* restrict bvh_leaves;
    global const Triangle* restrict triangles;
    global const float4* restrict positions;
    global const float4* restrict normals;
    global const float2* restrict uvs;
    global const Material* restrict materials;
    global const Texture* restrict textures;
    global const uint* restrict texel_words;
    global const Emitter* restrict emitters;
    global const Light* restrict lights;
    global const EnvironmentTexel* restrict environment;
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
#define SCENE_NO_VISITS , 0
#else
#define SCENE_COUNT_NODE(scene)
#define SCENE_COUNT_LEAF(scene, triangle_count)
#define SCENE_NO_VISITS
#endif
#ifdef CLRT_TRACE
#define SCENE_NO_TRACE , 0
#else
#define SCENE_NO_TRACE
#endif

#define SCENE_PARAMS                                                                                          \
    global const uint* restrict bvh_nodes, global const uint* restrict bvh_leaves,                            \
        global const Triangle* restrict triangles, global const float4* restrict positions,                   \
        global const float4* restrict normals, global const float2* restrict uvs,                             \
        global const Material* restrict materials, global const Texture* restrict textures,                   \
        global const uint* restrict texel_words, global const Emitter* restrict emitters,                     \
        global const Light* restrict lights, global const EnvironmentTexel* restrict environment

#define SCENE_MAKE                                                                                            \
    {bvh_nodes, bvh_leaves,  triangles, positions, normals, uvs,                                              \
     materials, textures, texel_words, emitters, lights, environment SCENE_NO_VISITS SCENE_NO_TRACE}

#endif
