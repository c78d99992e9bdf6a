// SPDX-License-Identifier: Apache-2.0
// The judge of clrt-bench finds every wrong hit that is planted, on the side where it is planted, and no
// other.
#include "bench/arbitrate.h"
#include "probes/meshes.h"
#include "probes/random_inputs.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {
namespace {

constexpr size_t RAYS = 300;
const RoundingBound BOUND = rounding_bound(true);

/// Rays from within a ball, each with its closest hit by plain double precision.
struct Fixture {
    Scene scene = make_ball(16, 16);
    std::vector<BenchRay> rays;
    std::vector<BenchHit> hits;

    explicit Fixture(float t_max = 1e18f, double direction_length = 1) {
        Random random(3);
        while (rays.size() < RAYS) {
            const vec4 origin = to_vec4(random.in_cube(0.4), t_max);
            rays.push_back({origin, to_vec4(random.direction() * direction_length)});
            hits.push_back(closest(rays.back()));
        }
    }

    /// Among the triangles from `first` on.
    BenchHit closest(const BenchRay& ray, u32 first = 0) const {
        BenchHit best{ray.origin.w, 0, 0, NO_INDEX};
        const glm::dvec3 o = to_dvec3(ray.origin), d = to_dvec3(ray.direction);
        for (u32 i = first; i < scene.triangles.size(); ++i) {
            const Triangle& triangle = scene.triangles[i];
            const glm::dvec3 a = corner_position(scene, triangle, 0) - o,
                             b = corner_position(scene, triangle, 1) - o,
                             c = corner_position(scene, triangle, 2) - o;
            const double u = glm::dot(d, glm::cross(c, b)), v = glm::dot(d, glm::cross(a, c)),
                         w = glm::dot(d, glm::cross(b, a));
            if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)))
                continue;
            const glm::dvec3 n = triangle_normal(scene, triangle);
            const double t = glm::dot(n, a) / glm::dot(n, d);
            if (t > 0 && t < double(best.t))
                best = {float(t), 0, 0, i};
        }
        return best;
    }

    Verdict judge(const std::vector<BenchHit>& clrt, const std::vector<BenchHit>& rival,
                  bool any_hit = false) const {
        return arbitrate(scene, BOUND, any_hit, rays, clrt, rival);
    }

    /// Plants a wrong hit on one side, then on the other.
    void expect_found(const BenchHit& wrong, const char* what, bool any_hit = false) const {
        std::vector<BenchHit> faulty = hits;
        faulty[7] = wrong;
        const Verdict by_clrt = judge(faulty, hits, any_hit), by_rival = judge(hits, faulty, any_hit);
        EXPECT_EQ(by_clrt.differences, 1u) << what;
        EXPECT_EQ(by_clrt.clrt_wrong, 1u) << what;
        EXPECT_EQ(by_clrt.rival_wrong, 0u) << what;
        EXPECT_FALSE(by_clrt.first_wrong.empty()) << what;
        EXPECT_EQ(by_rival.clrt_wrong, 0u) << what;
        EXPECT_EQ(by_rival.rival_wrong, 1u) << what;
        EXPECT_TRUE(by_rival.first_wrong.empty()) << what;
    }
};

} // namespace

TEST(BenchArbitrate, FindsNothingInRightHits) {
    const Fixture fixture;
    const Verdict verdict = fixture.judge(fixture.hits, fixture.hits);
    EXPECT_EQ(verdict.rays, RAYS);
    EXPECT_EQ(verdict.differences, 0u);
    for (size_t i = 0; i < RAYS; ++i) {
        ASSERT_NE(fixture.hits[i].triangle, NO_INDEX);
        EXPECT_FALSE(closest_is_wrong(fixture.scene, BOUND, fixture.rays[i], fixture.hits[i]));
    }
}

TEST(BenchArbitrate, FindsAPlantedWrongHit) {
    const Fixture fixture;
    const BenchHit right = fixture.hits[7];
    fixture.expect_found({1e18f, 0, 0, NO_INDEX}, "a lost ray");
    fixture.expect_found({right.t, 0, 0, u32((right.triangle + 100) % fixture.scene.triangles.size())},
                         "another triangle");
    fixture.expect_found({right.t * 1.00001f, 0, 0, right.triangle}, "the right triangle too far");
    fixture.expect_found({right.t * 0.99999f, 0, 0, right.triangle}, "the right triangle too near");
    fixture.expect_found({NAN, 0, 0, right.triangle}, "no number");
    fixture.expect_found({right.t, 0, 0, 123456u}, "a triangle that does not exist");
}

TEST(BenchArbitrate, FindsAFartherTriangle) {
    Fixture fixture;
    // A second, larger ball around the first one.
    const u32 inner = u32(fixture.scene.triangles.size());
    append_scene(fixture.scene, placed(make_ball(16, 16), 2, {0, 0, 0}));
    const BenchHit farther = fixture.closest(fixture.rays[7], inner);
    ASSERT_NE(farther.triangle, NO_INDEX);
    fixture.expect_found(farther, "the farther ball");
}

TEST(BenchArbitrate, MeasuresDistancesInLengthsOfTheDirection) {
    const Fixture fixture(1e18f, 1e-3);
    EXPECT_EQ(fixture.judge(fixture.hits, fixture.hits).differences, 0u);
    const BenchHit right = fixture.hits[7];
    EXPECT_GT(right.t, 100);
    fixture.expect_found({right.t * 1.00001f, 0, 0, right.triangle}, "too far along a short direction");
    // Rounding of the last place is excused.
    std::vector<BenchHit> rounded = fixture.hits;
    rounded[7].t = std::nextafter(right.t, 1e18f);
    EXPECT_EQ(fixture.judge(rounded, fixture.hits).differences, 0u);
}

TEST(BenchArbitrate, FindsWrongShadows) {
    // Everything is beyond 0.6 at least, nothing is beyond 2.
    const Fixture lit(0.05f), dark(4.0f);
    EXPECT_EQ(lit.hits[7].triangle, NO_INDEX);
    lit.expect_found({0, 0, 0, 0}, "a shadow that is not there", true);
    dark.expect_found({0, 0, 0, NO_INDEX}, "a shadow that is overlooked", true);
}

TEST(BenchArbitrate, TakesEqualDistancesForTwins) {
    Fixture fixture;
    // The same ball once more: each triangle has a twin.
    const size_t once = fixture.scene.triangles.size();
    append_scene(fixture.scene, make_ball(16, 16));
    std::vector<BenchHit> twins = fixture.hits;
    twins[7].triangle += u32(once);
    const Verdict verdict = fixture.judge(twins, fixture.hits);
    EXPECT_EQ(verdict.differences, 0u);
    EXPECT_EQ(verdict.twins, 1u);
}

} // namespace clrt
