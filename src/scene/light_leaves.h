// SPDX-License-Identifier: Apache-2.0
// The leaves of the light tree: what is to be chosen between by position.
#pragma once

#include "scene/light_bounds.h"
#include "scene/scene.h"

#include <vector>

namespace clrt {

/// How far off a light is: parts of the tree on their own.
enum class LightRange { SKY, SUN, NEAR };

/// A light, or a fan of emissive triangles: a flat polygon, so that no vertex tells its triangles apart but
/// by area. Lights have numbers: emissive triangles first, then points and suns, then the environment.
struct LightLeaf {
    LightBounds bounds;
    u32 first = 0, count = 1; ///< numbers of its lights
    LightRange range = LightRange::NEAR;
};

/// Triangles that a fan has at most.
constexpr u32 LARGEST_FAN = 32;

/// The number behind the last triangle of the fan that begins with an emitter: successive triangles of one
/// object and material, in one plane, that all have a vertex in common.
u32 fan_end(const Scene& scene, u32 first);

/// Whether next-event estimation chooses among the kinds (KIND_*) of lights at all: there are two leaves.
bool has_several_leaves(const Scene& scene, unsigned kinds);

/// Whether the lights of these kinds are the triangles of one object that surrounds the scene: a glowing
/// dome. Its parts lie alike to every point, so that the choice by area is as good as one by position.
bool is_glowing_dome(const Scene& scene, unsigned kinds);

/// The leaves of all lights of the kinds that next-event estimation finds. A sun is a point so far away that
/// it has one direction; the environment map is a sphere of that radius.
std::vector<LightLeaf> light_leaves(const Scene& scene, unsigned kinds);

} // namespace clrt
