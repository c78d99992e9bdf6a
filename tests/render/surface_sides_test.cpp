// SPDX-License-Identifier: Apache-2.0
// Sides of a surface: light from behind stays behind, whatever normals the surface is shaded with.
#include "probes/film_estimate.h"
#include "render/kernels.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

using glm::dvec3;

const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED,
                                  Integrator::RAYCAST};

/// Vectors along a wall that no axis is parallel to, and away from it.
const dvec3 NORMAL = glm::normalize(dvec3(1, 2, 3)),
            ALONG_U = glm::normalize(glm::cross(NORMAL, dvec3(1, 0, 0))),
            ALONG_V = glm::cross(NORMAL, ALONG_U);

/// A normal tilted by asin(0.8) towards growing u, and heights that rise as steeply: what they shade as the
/// horizon lies 53 degrees below the plane on one side.
const std::vector<float> TILTED = {0.9f, 0.5f, 0.8f};
const char* const MAPS[] = {"norm tilted.exr", "bump -bm 24 rising.exr"};

constexpr int NO_VN = 0;

const char* const MATERIALS[] = {"Kd 1 1 1", "Kd 0.4 0.4 0.4\nKs 0.6 0.6 0.6\nNs 4\nillum 2",
                                 "Kd 0 0 0\nKs 1 1 1\nillum 3\nPr 0.6"};

/// A scene with the maps above, walls among them.
class MappedScene : public TestScene {
public:
    MappedScene() {
        texture("tilted.exr", 1, 1, 3, TILTED);
        std::vector<float> rising;
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 64; ++x)
                rising.push_back((float(x) + 0.5f) / 64);
        texture("rising.exr", 64, 4, 1, rising);
        options.sampling.spp = 64;
        options.transport.max_depth = 2;
    }
    /// A quad with texture coordinates whose vn is written with this many digits, or which has none.
    void wall(const dvec3& centre, const dvec3& u, const dvec3& v, int digits) {
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            const dvec3 p = centre + double(x) * u + double(y) * v;
            build.raw(
                fmt::format("v {:.9g} {:.9g} {:.9g}\nvt {} {}", p.x, p.y, p.z, (x + 1) / 2, (y + 1) / 2));
        }
        const dvec3 n = glm::normalize(glm::cross(u, v));
        if (digits == NO_VN) {
            build.raw("f -4/-4 -3/-3 -2/-2 -1/-1");
            return;
        }
        build.raw(fmt::format("vn {0:.{3}f} {1:.{3}f} {2:.{3}f}", n.x, n.y, n.z, digits));
        build.raw("f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1");
    }
    /// A small lamp, a point light and a sun, all in one direction from the origin.
    void light_from(const dvec3& towards) {
        const dvec3 u = 0.3 * glm::normalize(glm::cross(towards, dvec3(0, 1, 0)));
        build.material("lamp", "Kd 0 0 0\nKe 9 9 9").use("lamp");
        for (const dvec3& p : {towards, towards + u, towards + dvec3(0, 0.3, 0)})
            build.raw(fmt::format("v {:.9g} {:.9g} {:.9g}", p.x, p.y, p.z));
        build.raw("f -3 -2 -1");
        options.light.two_sided = true;
        options.light.points.push_back({towards, dvec3(9)});
        options.light.suns.push_back({towards, dvec3(9), 0});
    }
};

/// How many sums of the film are not 0.
std::int64_t count_lit(const Film& film) {
    return std::int64_t(film.sums.size()) - std::count(film.sums.begin(), film.sums.end(), 0);
}

/// A wall with this material and map, seen from its front and lit from behind or, if `front`, from before it.
class LitWall : public MappedScene {
public:
    LitWall(const std::string& material, const std::string& map, int digits, bool front) {
        build.material("wall", material + "\n" + map).use("wall");
        wall({0, 0, 0}, 9.0 * ALONG_U, 9.0 * ALONG_V, digits);
        // Towards growing u the map's normal sees below the plane; against it the heights' does.
        const double along = map.front() == 'n' ? 1 : -1;
        light_from(along * 2.0 * ALONG_U + (front ? 0.6 : -0.6) * NORMAL);
        look_at_point(3.0 * NORMAL + 0.1 * ALONG_V, {0, 0, 0});
    }
};

} // namespace

TEST(SurfaceSides, AFlatWallWithRoundedNormalsIsDarkWhenLitFromBehind) {
    for (const std::string map : MAPS)
        for (const char* material : MATERIALS)
            for (const Integrator integrator : INTEGRATORS)
                for (const int digits : {2, 3, 4, 9}) {
                    LitWall behind(material, map, digits, false);
                    behind.options.transport.integrator = integrator;
                    EXPECT_EQ(count_lit(behind.render().film), 0)
                        << map << ", " << material << ", " << digits << ", " << name_of(integrator);
                }
}

TEST(SurfaceSides, TheSameWallIsLitFromItsFront) {
    for (const std::string map : MAPS)
        for (const Integrator integrator : INTEGRATORS)
            for (const int digits : {2, 4}) {
                LitWall before(MATERIALS[0], map, digits, true);
                before.options.transport.integrator = integrator;
                EXPECT_GT(film_estimate(before.render().film).mean, 0.5) << map << name_of(integrator);
            }
}

TEST(SurfaceSides, TellingMatteFromGlossyPathsLetsNothingThrough) {
    // In the last two the wall reflects a light to the eye by one lobe alone and has both.
    for (const std::string paths : {"LDE", "LGE", "L(G|DD)E", "L(D|GG)E"}) {
        LitWall behind(MATERIALS[1], MAPS[0], 9, false);
        behind.options.transport.paths = paths;
        behind.options.transport.max_depth = 4;
        EXPECT_EQ(count_lit(behind.render().film), 0) << paths;
    }
}

TEST(SurfaceSides, AClosedRoomWithMappedWallsKeepsTheLightOut) {
    for (const char* material : MATERIALS)
        for (const Integrator integrator : INTEGRATORS)
            for (const int digits : {2, 4}) {
                MappedScene room;
                room.build.material("wall", std::string(material) + "\n" + MAPS[0]).use("wall");
                const dvec3 axes[] = {ALONG_U, ALONG_V, NORMAL};
                for (int k = 0; k < 3; ++k)
                    for (const double side : {-1.0, 1.0})
                        room.wall(side * axes[k], -side * axes[(k + 1) % 3], axes[(k + 2) % 3], digits);
                for (const double x : {-3.0, 3.0})
                    room.light_from(x * ALONG_U + 2.0 * ALONG_V - NORMAL);
                room.options.transport.integrator = integrator;
                room.options.transport.max_depth = 6;
                room.options.film.size = {32, 32};
                room.look(0.8 * ALONG_U, -ALONG_U + 0.2 * NORMAL, 100);
                EXPECT_EQ(count_lit(room.render().film), 0)
                    << material << ", " << digits << ", " << name_of(integrator);
            }
}

TEST(SurfaceSides, ASmoothMappedBallKeepsItsLightInside) {
    for (const char* material : MATERIALS)
        for (const Integrator integrator : INTEGRATORS) {
            MappedScene scene;
            scene.build.material("ball", std::string(material) + "\n" + MAPS[0]).use("ball");
            for (const TestTriangle& triangle : icosphere_triangles({0, 0, 0}, 1, 1)) {
                for (const dvec3& p : triangle.corners)
                    scene.build.raw(fmt::format(
                        "v {0:.9g} {1:.9g} {2:.9g}\nvn {0:.4f} {1:.4f} {2:.4f}\nvt {0} {1}", p.x, p.y, p.z));
                scene.build.raw("f -3/-3/-3 -2/-2/-2 -1/-1/-1");
            }
            scene.light_from({0.3, 0.2, 0.1});
            scene.options.light.suns.clear();
            scene.options.transport.integrator = integrator;
            scene.options.film.size = {32, 32};
            scene.options.transport.max_depth = 6;
            scene.look({0.3, 0.2, 5}, {0, 0, 0}, 30);
            EXPECT_EQ(count_lit(scene.render().film), 0) << material << ", " << name_of(integrator);
        }
}

TEST(SurfaceSides, MappedGlassLosesAndGainsNothingByItsPlanesOwnNormals) {
    for (const char* material : {"Ni 1.5\nillum 7", "Ni 1.5\nillum 7\nPr 0.5"})
        for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED}) {
            Estimate found[2];
            for (const int digits : {NO_VN, 4}) {
                MappedScene scene;
                scene.build.material("glass", std::string(material) + "\n" + MAPS[0]).use("glass");
                const dvec3 axes[] = {ALONG_U, ALONG_V, NORMAL};
                for (int k = 0; k < 3; ++k)
                    for (const double side : {-1.0, 1.0})
                        scene.wall(side * axes[k], side * axes[(k + 1) % 3], axes[(k + 2) % 3], digits);
                scene.options.light.environment = dvec3(1);
                scene.options.transport.integrator = integrator;
                scene.options.transport.max_depth = 64;
                scene.options.transport.min_contribution = 0;
                scene.options.sampling.spp = 256;
                scene.look({3, 4, 5}, {0, 0, 0}, 10);
                found[digits != NO_VN] = film_estimate(scene.render().film);
            }
            const double noise = std::hypot(found[0].error, found[1].error);
            EXPECT_LT(noise, 0.01 * found[0].mean);
            EXPECT_LT(std::abs(found[1].mean - found[0].mean), LARGEST_Z * noise)
                << material << ", " << name_of(integrator) << ": " << found[0].mean << " without vn, "
                << found[1].mean << " with";
            EXPECT_LT(found[1].mean, 1 + LARGEST_Z * noise);
        }
}

TEST(SurfaceSides, ABoxSeenAtItsOutlineKeepsItsLightInside) {
    // Pictures a few roundings wide of points on edges between a face that is seen from outside and one that
    // is not.
    for (const Integrator integrator : INTEGRATORS)
        for (const double along : {-0.77, -0.31, 0.12, 0.58})
            for (const dvec3& eye : {dvec3(0.3, 2.4, 0.2), dvec3(-1.6, 3.1, 1.4), dvec3(0.9, 1.7, -0.8)}) {
                MappedScene scene;
                scene.build.material("wall", MATERIALS[0]).use("wall").box({-1, -1, -1}, {1, 1, 1});
                scene.light_from({0.3, 0.2, 0.1});
                scene.options.light.suns.clear();
                scene.options.transport.integrator = integrator;
                scene.options.transport.max_depth = 4;
                scene.look(eye, {1, 1, along}, 1e-5);
                EXPECT_EQ(count_lit(scene.render().film), 0) << name_of(integrator) << ", " << along;
            }
}

TEST(SurfaceSides, AnEyeOnTheFloorSeesTheSkyAboveTheHorizonAndNothingElse) {
    TestScene scene;
    scene.build.material("black", "Kd 0 0 0").use("black");
    scene.build.polygon({{-3, 0.7, 9}, {5, 0.7, 9}, {5, 0.7, -7}, {-3, 0.7, -7}});
    scene.options.camera.eye = dvec3(0.3, 0.7, 5);
    scene.options.camera.at = dvec3(0.1, 0.7, 0);
    scene.options.camera.fov_degrees = 60;
    scene.options.light.environment = dvec3(1);
    scene.options.transport.integrator = Integrator::RAYCAST;
    scene.options.sampling.spp = 64;
    const Film film = scene.render().film;
    EXPECT_NEAR(film_estimate(film, 0, {0, 0, 16, 8}).mean, 1, 1e-6);
    EXPECT_EQ(film_estimate(film, 0, {0, 8, 16, 16}).mean, 0);
}

} // namespace clrt
