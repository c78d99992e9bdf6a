// SPDX-License-Identifier: Apache-2.0
// Normals that are not the plane's: interpolated, mapped, bumped; what they do to direct light.
#include "probes/film_estimate.h"
#include "render/kernels.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double PI = 3.14159265358979323846;
const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::WHITTED, Integrator::RAYCAST};

/// A matte floor of radiance cos(normal, sun): Kd 1 and a sun of irradiance pi. On the floor u grows along +x
/// and v along -z; `mirrored` turns u round.
class SunlitFloor : public TestScene {
public:
    explicit SunlitFloor(const std::string& keys, bool mirrored = false) {
        build.material("m", "Kd 1 1 1\n" + keys).use("m");
        if (mirrored)
            build.raw(
                "vt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1/1 2/2 3/3 4/4");
        else
            build.textured_quad({{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}});
        options.sampling.spp = 64;
        options.transport.max_depth = 2;
        look_at_point({0.2, 3, 0.1}, {0, 0, 0});
    }
    /// Radiance for a sun in this direction.
    double lit_from(const glm::dvec3& towards) {
        options.light.suns = {{towards, glm::dvec3(PI), 0}};
        return film_estimate(render().film).mean;
    }
};

/// Red, green, blue of a normal map that holds this vector.
std::vector<float> normal_texel(const glm::dvec3& n) {
    return {float(0.5 + 0.5 * n.x), float(0.5 + 0.5 * n.y), float(0.5 + 0.5 * n.z)};
}

const glm::dvec3 EAST(0.6, 0.8, 0), NORTH(0, 0.8, -0.6), WEST(-0.6, 0.8, 0), SOUTH(0, 0.8, 0.6);

} // namespace

TEST(ShadingNormal, AFlatNormalMapChangesNothing) {
    SunlitFloor plain(""), mapped("norm flat.exr");
    mapped.texture("flat.exr", 1, 1, 3, normal_texel({0, 0, 1}));
    for (const glm::dvec3& sun : {EAST, NORTH, glm::dvec3(-0.3, 1, 2)})
        EXPECT_NEAR(mapped.lit_from(sun), plain.lit_from(sun), 1e-6);
}

TEST(ShadingNormal, RedTiltsAlongUAndGreenAlongV) {
    const double s = 0.5, c = std::sqrt(0.75);
    for (const bool mirrored : {false, true})
        for (const Integrator integrator : INTEGRATORS) {
            SunlitFloor red("norm red.exr", mirrored), green("norm green.exr", mirrored);
            red.options.transport.integrator = green.options.transport.integrator = integrator;
            red.texture("red.exr", 1, 1, 3, normal_texel({s, 0, c}));
            green.texture("green.exr", 1, 1, 3, normal_texel({0, s, c}));
            const double side = mirrored ? -1 : 1;
            SCOPED_TRACE(std::string(name_of(integrator)) + (mirrored ? ", mirrored" : ""));
            EXPECT_NEAR(red.lit_from(EAST), 0.8 * c + side * 0.6 * s, 1e-5);
            EXPECT_NEAR(red.lit_from(WEST), 0.8 * c - side * 0.6 * s, 1e-5);
            EXPECT_NEAR(red.lit_from(NORTH), 0.8 * c, 1e-5);
            EXPECT_NEAR(green.lit_from(NORTH), 0.8 * c + 0.6 * s, 1e-5);
            EXPECT_NEAR(green.lit_from(SOUTH), 0.8 * c - 0.6 * s, 1e-5);
            EXPECT_NEAR(green.lit_from(EAST), 0.8 * c, 1e-5);
        }
}

TEST(ShadingNormal, BumpsTiltAgainstTheirSlope) {
    // Heights rise by 1 along u over the 2 units of the floor, times -bm 0.8: a slope of 0.4.
    std::vector<float> along_u, along_v;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            along_u.push_back((float(x) + 0.5f) / 64);
            along_v.push_back(1 - (float(y) + 0.5f) / 64);
        }
    const double length = std::sqrt(1 + 0.4 * 0.4);
    for (const bool mirrored : {false, true}) {
        SunlitFloor u("bump -bm 0.8 u.exr", mirrored), v("bump -bm 0.8 v.exr", mirrored);
        u.texture("u.exr", 64, 64, 1, along_u);
        v.texture("v.exr", 64, 64, 1, along_v);
        const double side = mirrored ? -1 : 1;
        EXPECT_NEAR(u.lit_from(EAST), (0.8 - side * 0.6 * 0.4) / length, 1e-4) << mirrored;
        EXPECT_NEAR(u.lit_from(NORTH), 0.8 / length, 1e-4) << mirrored;
        EXPECT_NEAR(v.lit_from(NORTH), (0.8 - 0.6 * 0.4) / length, 1e-4) << mirrored;
        EXPECT_NEAR(v.lit_from(SOUTH), (0.8 + 0.6 * 0.4) / length, 1e-4) << mirrored;
    }
}

TEST(ShadingNormal, CornerNormalsAreInterpolated) {
    // Normals tilted towards +x by 30 degrees on the left and by -30 on the right: halfway they are straight.
    const auto lit_at = [](double x, const glm::dvec3& sun) {
        TestScene scene;
        scene.build.material("m", "Kd 1 1 1").use("m");
        scene.build.raw("v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvn 0.5 0.8660254 0\nvn -0.5 0.8660254 0\n"
                        "f 1//1 2//2 3//2 4//1");
        scene.options.light.suns = {{sun, glm::dvec3(PI), 0}};
        scene.options.sampling.spp = 64;
        scene.options.transport.max_depth = 2;
        scene.look_at_point({x, 3, 0.1}, {x, 0, 0});
        return film_estimate(scene.render().film).mean;
    };
    const double c = std::sqrt(0.75);
    for (const double x : {-0.9, -0.5, 0.0, 0.7}) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.5 * x, c, 0));
        EXPECT_NEAR(lit_at(x, EAST), glm::dot(normal, EAST), 1e-4) << x;
        EXPECT_NEAR(lit_at(x, NORTH), glm::dot(normal, NORTH), 1e-4) << x;
    }
}

TEST(ShadingNormal, GivenNormalsDecideWhichSideShines) {
    // A lamp above the floor whose winding says up, while its normals say down.
    for (const auto& [normal, lit] : {std::pair{"0 -1 0", true}, {"0 1 0", false}}) {
        TestScene scene;
        scene.build.material("matte", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 1 1 1");
        scene.build.use("matte").floor(9).use("lamp");
        scene.build.raw(std::string("v -1 1 1\nv 1 1 1\nv 1 1 -1\nv -1 1 -1\nvn ") + normal +
                        "\nf -4//-1 -3//-1 -2//-1 -1//-1");
        scene.look_at_point({3, 0.8, 0.4}, {0, 0, 0});
        for (const Integrator integrator : INTEGRATORS) {
            scene.options.transport.integrator = integrator;
            EXPECT_EQ(film_estimate(scene.render().film).mean > 0, lit) << normal << name_of(integrator);
        }
    }
}

} // namespace clrt
