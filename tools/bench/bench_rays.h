// SPDX-License-Identifier: Apache-2.0
// Rays and hits as both sides read and write them (kernels/bench/bench_ray.h).
#pragma once

#include "kernels/shared/types.h"

#include <vector>

namespace clrt {

/// A ray: 32 bytes.
struct BenchRay {
    vec4 origin;    ///< w: t_max
    vec4 direction; ///< w: 0; unit, or a segment's way to its end, where t = 1
};

/// A hit: 16 bytes. For rays that only ask whether something is in between, just the triangle counts:
/// NO_INDEX or not.
struct BenchHit {
    float t, b1, b2;
    u32 triangle; ///< NO_INDEX: nothing was hit
};

/// The kinds of rays that a render traces.
enum class RayKind { PRIMARY, SHADOW, DIFFUSE, MIRROR };
constexpr RayKind RAY_KINDS[] = {RayKind::PRIMARY, RayKind::SHADOW, RayKind::DIFFUSE, RayKind::MIRROR};

/// "primary", "shadow", ...: for tables and JSON.
const char* ray_kind_name(RayKind kind);

/// Whether any hit will do; else the closest is wanted.
inline bool wants_any_hit(RayKind kind) {
    return kind == RayKind::SHADOW;
}

/// Work-groups take this many consecutive rays, on both sides.
constexpr u32 RAYS_PER_BLOCK = 64;

} // namespace clrt
