// SPDX-License-Identifier: Apache-2.0
// What robustness costs and what it is worth: clrt's watertight triangle test and padded boxes against plain
// ones, on one device, by the same traversal.
#pragma once

#include "bench/bench_options.h"
#include "bench/bench_rays.h"
#include "bench/measure.h"
#include "console/progress.h"
#include "device/device.h"

#include <cstdint>
#include <string>
#include <vector>

namespace clrt {

/// Kinds of rays that are timed.
constexpr RayKind TIMED_KINDS[] = {RayKind::PRIMARY, RayKind::SHADOW, RayKind::DIFFUSE};

/// One kind of rays under one variant.
struct VariantKind {
    RayKind kind = RayKind::PRIMARY;
    Spread seconds; ///< of a ray
    Spread ratio;   ///< over the robust variant's time, round by round
    size_t rays = 0, wrong = 0;
};

/// The robust kernels or a plainer variant of them.
struct Variant {
    std::string name;
    bool plain_triangle = false, plain_box = false;
    std::vector<VariantKind> kinds;
    std::uint64_t aimed = 0,
                  lost = 0; ///< rays aimed at edges of closed meshes, and those that got out, of both queries
};

struct Robustness {
    std::string scene; ///< path, or what the made one shows
    std::string layout;
    size_t triangles = 0;
    std::vector<Variant> variants; ///< the robust one first
};

/// Measures all variants on a scene (empty: one that is made) and on aimed rays.
Robustness compare_robustness(const Device& device, const BenchOptions& bench, const std::string& scene,
                              Progress& progress);

/// True if the robust variant lost a ray or got one wrong.
bool is_wrong(const Robustness& robustness);

} // namespace clrt
