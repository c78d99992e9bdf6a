// SPDX-License-Identifier: Apache-2.0
// No ray leaves a closed mesh: so many are aimed at vertices and edges, where they would.
#pragma once

#include "bench/bench_kernels.h"
#include "bench/bench_rays.h"
#include "bvh/bvh.h"
#include "device/device.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// What a mesh in one place gave.
struct WatertightCase {
    std::string mesh, place;
    size_t triangles = 0;                           ///< in the tree
    std::uint64_t rays = 0, lost = 0, lost_any = 0; ///< by scene_closest_hit, by scene_any_hit
    std::optional<BenchRay> lost_ray;               ///< one of them
};

struct WatertightRequest {
    std::uint64_t rays = 100000000; ///< over all cases; rounded up to whole launches
    BvhLayout layout = BvhLayout::BVH8;
    KernelFiles files; ///< all_kernel_files()
};

/// Traces the rays through every mesh, as it is and in the loader's frame: at the origin, a million away, at
/// sizes of 1e-6 and 1e6. `progress` hears the share that is done.
std::vector<WatertightCase> run_watertight(const Device& device, const WatertightRequest& request,
                                           const std::function<void(double)>& progress = {});

/// Lost rays of all cases.
std::uint64_t count_lost(const std::vector<WatertightCase>& cases);

} // namespace clrt
