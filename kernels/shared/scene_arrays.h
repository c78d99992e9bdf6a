// SPDX-License-Identifier: Apache-2.0
// The arrays of a scene, a row each. From the rows follow the kernels' Scene (kernels/geometry/scene.h), the
// upload (src/render/scene_buffers.cpp) and the hash of the scene in a film's identity
// (src/film/film_identity.cpp).
#ifndef CLRT_SHARED_SCENE_ARRAYS_H
#define CLRT_SHARED_SCENE_ARRAYS_H

#include "bvh_types.h"
#include "path_types.h"
#include "scene_types.h"

/* ROW(type of an element, name in the kernels, member of the host's Bvh). How these are laid out changes no
   bit of a picture. */
#define BVH_ARRAYS(ROW)                                                                                      \
    ROW(u32, bvh_nodes, nodes)                                                                               \
    ROW(u32, bvh_leaves, leaves)                                                                             \
    ROW(u32, bvh_leaf_moves, leaf_moves)                                                                     \
    ROW(u32, bvh_roots, roots)

/* ROW(type of an element, name in the kernels, member of the host's Scene), in the order in which they are
   hashed. */
#define SCENE_ARRAYS(ROW)                                                                                    \
    ROW(vec4, positions, positions)                                                                          \
    ROW(vec4, position_moves, position_moves)                                                                \
    ROW(vec4, normals, normals)                                                                              \
    ROW(vec4, normal_moves, normal_moves)                                                                    \
    ROW(vec2, uvs, uvs)                                                                                      \
    ROW(vec2, second_uvs, second_uvs)                                                                        \
    ROW(Triangle, triangles, triangles)                                                                      \
    ROW(Instance, instances, instances)                                                                      \
    ROW(Material, materials, materials)                                                                      \
    ROW(MaterialExtension, extensions, extensions)                                                           \
    ROW(u32, measured, measured)                                                                             \
    ROW(Texture, textures, textures)                                                                         \
    ROW(u32, texel_words, texel_words)                                                                       \
    ROW(Emitter, emitters, emitters)                                                                         \
    ROW(EmitterPart, emitter_parts, emitter_parts)                                                           \
    ROW(Light, lights, lights)                                                                               \
    ROW(vec4, casters, casters)                                                                              \
    ROW(SkyTile, sky_tiles, environment.tiles)                                                               \
    ROW(u32, sky_texels, environment.texels)                                                                 \
    ROW(SkyPortal, sky_portals, environment.portals)                                                         \
    ROW(u32, sky_sums, environment.portal_sums)                                                              \
    ROW(LightNode, light_nodes, light_tree.nodes)                                                            \
    ROW(LightPlace, light_places, light_tree.places)

/* ROW(type of an element, name in the kernels, member of the host's PathTables): what the options make of the
   scene, which a film's identity has from the options. */
#define PATH_ARRAYS(ROW) ROW(PathState, path_states, states)

/* The arrays lie in a few buffers, the heaps, so that kernels do not get an argument more for every array. A
   device promises buffers of a quarter of its memory. Where each array goes to the emptiest heap, the largest
   first, seven such heaps hold whatever the memory holds: if one finds no place that needs the share x of a
   heap, all seven are fuller than 1 - x. For x <= 1/2 that makes more than 7 (1 - x) + x >= 4 heaps in all;
   for x > 1/2 each heap holds an array that is no smaller, which makes eight of more than half a heap. */
#define SCENE_HEAPS 7

/* An array begins at a multiple of this many bytes: the size of a ulong16, to which OpenCL aligns every
   buffer. */
#define SCENE_ALIGNMENT 128

SHARED_BEGIN

/* Where an array lies. */
typedef struct {
    u32 heap;
    u32 first;    /* its beginning, in units of SCENE_ALIGNMENT bytes */
    u32 is_empty; /* 1: it has no elements */
    u32 unused0;
} ArrayPlace;
ASSERT_SIZE(ArrayPlace, 16);

/* Of all arrays; heap 0 begins with it. */
typedef struct {
#define ARRAY_PLACE(type, name, member) ArrayPlace name;
    BVH_ARRAYS(ARRAY_PLACE)
    SCENE_ARRAYS(ARRAY_PLACE)
    PATH_ARRAYS(ARRAY_PLACE)
#undef ARRAY_PLACE
} ArrayPlaces;

SHARED_END

#endif
