// SPDX-License-Identifier: Apache-2.0
// The check of clrt-bench --watertight, a hundredth of its rays; and that it can fail.
#include "bench/closed_meshes.h"
#include "bench/watertight.h"
#include "probes/ray_device.h"
#include "support/test_device.h"

#include <gtest/gtest.h>
#include <map>
#include <set>
#include <utility>

namespace clrt {
namespace {

constexpr std::uint64_t RAYS = 1000000;
constexpr BvhLayout LAYOUTS[] = {BvhLayout::BVH8, BvhLayout::BVH2};

WatertightRequest request(BvhLayout layout, std::uint64_t rays) {
    WatertightRequest result;
    result.rays = rays;
    result.layout = layout;
    result.files = kernels_under_test();
    result.files.insert(bench_kernel_files().begin(), bench_kernel_files().end());
    return result;
}

} // namespace

TEST(BenchWatertight, MeshesAreClosed) {
    for (const ClosedMesh& mesh : watertight_meshes()) {
        // Every edge has one triangle on either side.
        std::map<std::pair<u32, u32>, int> sides;
        for (const Triangle& t : mesh.scene.triangles)
            for (const auto& [from, to] :
                 {std::pair(t.v0, t.v1), std::pair(t.v1, t.v2), std::pair(t.v2, t.v0)})
                ++sides[{from, to}];
        for (const auto& [edge, count] : sides) {
            ASSERT_EQ(count, 1) << mesh.name << " " << mesh.place;
            ASSERT_EQ(sides.count({edge.second, edge.first}), 1u) << mesh.name << " " << mesh.place;
        }
        EXPECT_TRUE(is_closed_by_areas(mesh.scene)) << mesh.name << " " << mesh.place;
    }
}

TEST(BenchWatertight, NoAimedRayGetsOut) {
    for (const BvhLayout layout : LAYOUTS) {
        std::uint64_t rays = 0;
        std::set<std::string> meshes, places;
        for (const WatertightCase& result : run_watertight(test_device(), request(layout, RAYS))) {
            EXPECT_EQ(result.lost, 0u) << result.mesh << " " << result.place << " bvh" << int(layout);
            EXPECT_EQ(result.lost_any, 0u) << result.mesh << " " << result.place << " bvh" << int(layout);
            EXPECT_GT(result.triangles, 1000u);
            rays += result.rays;
            meshes.insert(result.mesh);
            places.insert(result.place);
        }
        EXPECT_GE(rays, RAYS);
        EXPECT_EQ(meshes.size(), 3u);
        EXPECT_EQ(places.size(), 8u);
    }
}

TEST(BenchWatertight, CountsWhatPlainTestsLose) {
    for (const bool box : {false, true}) {
        WatertightRequest plain = request(BvhLayout::BVH8, RAYS);
        plain.files = with_naive(plain.files, /*triangle=*/!box, box);
        std::uint64_t lost = 0, lost_any = 0;
        for (const WatertightCase& result : run_watertight(test_device(), plain)) {
            EXPECT_EQ(result.lost_ray.has_value(), result.lost + result.lost_any > 0);
            lost += result.lost;
            lost_any += result.lost_any;
        }
        EXPECT_GT(lost, 100u) << (box ? "plain slabs" : "plain triangles");
        EXPECT_GT(lost_any, 100u) << (box ? "plain slabs" : "plain triangles");
    }
}

} // namespace clrt
