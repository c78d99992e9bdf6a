// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_fit.h"

#include "error.h"
#include "scene_support.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

const Bounds BOX{glm::dvec3(-1, 0, -3), glm::dvec3(3, 2, 1)};

struct Fitted {
    Camera camera;
    std::vector<std::string> notices;
};

Fitted fit(const CameraOptions& options, glm::ivec2 size = {800, 600}, const Bounds& box = BOX,
           const BoxCover& cover = {}) {
    NoticeList notices;
    const Camera camera = fit_camera(options, size, box, cover, notices);
    return {camera, notices.lines()};
}

/// A box of 12 triangles; faces whose bit is set in `faces` (order +Z -Z +X -X +Y -Y), fronts inwards or
/// outwards.
struct BoxMesh {
    std::vector<vec4> positions;
    std::vector<Triangle> triangles;

    BoxMesh(unsigned faces, bool inwards) {
        for (int i = 0; i < 8; ++i)
            positions.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f, 0});
        const u32 outward[6][4] = {{4, 5, 7, 6}, {1, 0, 2, 3}, {5, 1, 3, 7},
                                   {0, 4, 6, 2}, {6, 7, 3, 2}, {0, 1, 5, 4}};
        for (int f = 0; f < 6; ++f)
            if (faces >> f & 1) {
                add(outward[f][0], outward[f][1], outward[f][2], inwards);
                add(outward[f][0], outward[f][2], outward[f][3], inwards);
            }
    }
    void add(u32 a, u32 b, u32 c, bool flip) {
        Triangle triangle{};
        triangle.v0 = a;
        triangle.v1 = flip ? c : b;
        triangle.v2 = flip ? b : c;
        triangles.push_back(triangle);
    }
    BoxCover cover() const { return measure_box_cover(positions, triangles); }
};

const Bounds CUBE{glm::dvec3(-1), glm::dvec3(1)};

} // namespace

TEST(CameraFit, TheBoundingSphereFitsWithAMarginOfFivePercent) {
    for (const glm::ivec2 size : {glm::ivec2(800, 600), glm::ivec2(300, 900), glm::ivec2(64, 64)})
        for (double fov : {10.0, 40.0, 120.0}) {
            CameraOptions options;
            options.fov_degrees = fov;
            const Camera camera = fit(options, size).camera;
            EXPECT_EQ(camera.at, BOX.centre());
            const double vertical = std::tan(glm::radians(fov) / 2);
            const double narrow = std::atan(std::min(vertical, vertical * size.x / size.y));
            const double distance = glm::distance(camera.eye, camera.at);
            EXPECT_NEAR(distance * std::sin(narrow), 1.05 * BOX.radius(), 1e-12 * distance);
            const glm::dvec3 direction = (camera.eye - camera.at) / distance;
            EXPECT_NEAR(glm::dot(direction, glm::normalize(glm::dvec3(0.5, 0.35, 1))), 1, 1e-12);
        }
}

TEST(CameraFit, DefaultsAreFortyDegreesAndYUp) {
    const Camera camera = fit({}).camera;
    EXPECT_EQ(camera.fov_degrees, 40);
    EXPECT_EQ(camera.up, glm::dvec3(0, 1, 0));
}

TEST(CameraFit, EachMissingPartIsFittedOnItsOwn) {
    CameraOptions options;
    options.eye = glm::dvec3(7, 8, 9);
    Camera camera = fit(options).camera;
    EXPECT_EQ(camera.eye, glm::dvec3(7, 8, 9));
    EXPECT_EQ(camera.at, BOX.centre());

    options = {};
    options.at = glm::dvec3(2, 1, 0);
    options.up = glm::dvec3(0, 0, 1);
    camera = fit(options).camera;
    EXPECT_EQ(camera.at, glm::dvec3(2, 1, 0));
    EXPECT_EQ(camera.up, glm::dvec3(0, 0, 1));
    // The sphere around `at` that holds the box fits.
    const double radius = BOX.radius() + glm::distance(glm::dvec3(2, 1, 0), BOX.centre());
    EXPECT_NEAR(glm::distance(camera.eye, camera.at) * std::sin(glm::radians(20.)), 1.05 * radius, 1e-9);
}

TEST(CameraFit, FocalLengthAndFilmWidthGiveTheAngle) {
    CameraOptions options;
    options.focal_length = 0.035;
    options.film_width = 0.025;
    EXPECT_NEAR(field_of_view(options, {512, 512}), glm::degrees(2 * std::atan(0.025 / 0.07)), 1e-12);
    EXPECT_NEAR(field_of_view(options, {800, 600}),
                glm::degrees(2 * std::atan(0.025 * 600 / (2 * 800 * 0.035))), 1e-12);
    options.film_width.reset();
    EXPECT_THROW(field_of_view(options, {512, 512}), UsageError);
    options.film_width = -1;
    EXPECT_THROW(field_of_view(options, {512, 512}), UsageError);
}

TEST(CameraFit, WrongValuesAreUsageErrors) {
    CameraOptions options;
    options.eye = options.at = glm::dvec3(1, 2, 3);
    EXPECT_THROW(fit(options), UsageError);
    options = {};
    options.eye = glm::dvec3(std::numeric_limits<double>::quiet_NaN(), 0, 0);
    EXPECT_THROW(fit(options), UsageError);
    options = {};
    options.at = glm::dvec3(0, std::numeric_limits<double>::infinity(), 0);
    EXPECT_THROW(fit(options), UsageError);
    options = {};
    options.up = glm::dvec3(0);
    EXPECT_THROW(fit(options), UsageError);
    for (double fov : {0.0, -1.0, 180.0, std::numeric_limits<double>::quiet_NaN()}) {
        options = {};
        options.fov_degrees = fov;
        EXPECT_THROW(fit(options), UsageError) << fov;
    }
}

TEST(CameraFit, AnEyeAtTheCentreLooksAlongMinusZ) {
    CameraOptions options;
    options.eye = BOX.centre();
    const Camera camera = fit(options).camera;
    EXPECT_LT(camera.at.z, camera.eye.z);
    EXPECT_EQ(camera.at.x, camera.eye.x);
}

TEST(CameraFit, AnUpVectorAlongTheViewIsReplacedWithANotice) {
    CameraOptions options;
    options.eye = BOX.centre() + glm::dvec3(0, 10, 0);
    Fitted down = fit(options);
    EXPECT_EQ(down.camera.up, glm::dvec3(0, 0, -1));
    EXPECT_EQ(count_notices(down.notices, "points along the view"), 1);

    options.eye = BOX.centre() + glm::dvec3(0, 0, 10);
    options.up = glm::dvec3(0, 0, 3);
    EXPECT_EQ(fit(options).camera.up, glm::dvec3(0, 1, 0));
}

TEST(CameraFit, AViewTooNarrowForItsPixelsIsNoticed) {
    CameraOptions options;
    options.eye = glm::dvec3(0, 0, 5);
    options.at = glm::dvec3(0);
    options.fov_degrees = 0.01; // 2.9e-7 radians a pixel
    EXPECT_TRUE(fit(options).notices.empty());
    options.fov_degrees = 0.001;
    const auto notices = fit(options).notices;
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_EQ(notices[0],
              "camera: --fov 0.001 puts pixels 2.9e-08 radians apart, rays of single precision differ from "
              "2.4e-07 on: neighbours show the same");
}

TEST(CameraFit, TheNoticeHoldsFlagsThatGiveTheSameCamera) {
    const Fitted first = fit({});
    ASSERT_EQ(first.notices.size(), 1u);
    double v[10];
    ASSERT_EQ(10, std::sscanf(first.notices[0].c_str(),
                              "camera: --eye %lf,%lf,%lf --at %lf,%lf,%lf --up %lf,%lf,%lf --fov %lf", &v[0],
                              &v[1], &v[2], &v[3], &v[4], &v[5], &v[6], &v[7], &v[8], &v[9]));
    CameraOptions options;
    options.eye = glm::dvec3(v[0], v[1], v[2]);
    options.at = glm::dvec3(v[3], v[4], v[5]);
    options.up = glm::dvec3(v[6], v[7], v[8]);
    options.fov_degrees = v[9];
    const Fitted second = fit(options);
    EXPECT_EQ(second.camera.eye, first.camera.eye);
    EXPECT_EQ(second.camera.at, first.camera.at);
    EXPECT_TRUE(second.notices.empty()) << "nothing was fitted, nothing is announced";
}

TEST(CameraFit, ScalingTheSceneByAPowerOfTwoScalesTheCameraExactly) {
    const Camera one = fit({}).camera;
    const Camera big = fit({}, {800, 600}, {BOX.low * 1024., BOX.high * 1024.}).camera;
    EXPECT_EQ(big.eye, one.eye * 1024.);
    EXPECT_EQ(big.at, one.at * 1024.);
}

TEST(CameraFit, ASinglePointIsSeenFromADistance) {
    const Camera camera = fit({}, {800, 600}, {glm::dvec3(5), glm::dvec3(5)}).camera;
    EXPECT_GT(glm::distance(camera.eye, camera.at), 1);
}

TEST(CameraFit, RoomsAreCoveredFromInsideAndSolidsAreNot) {
    const BoxCover room = BoxMesh(0x3f, true).cover(), solid = BoxMesh(0x3f, false).cover();
    for (size_t f = 0; f < 6; ++f) {
        EXPECT_EQ(room[f], 1);
        EXPECT_EQ(solid[f], 0);
    }
    for (unsigned open = 0; open < 6; ++open) {
        const BoxCover cover = BoxMesh(0x3f & ~(1u << open), true).cover();
        for (unsigned f = 0; f < 6; ++f)
            EXPECT_EQ(cover[f], f == open ? 0 : 1) << "open " << open << ", face " << f;
    }
}

TEST(CameraFit, ARoomIsSeenThroughItsOpenSide) {
    const glm::dvec3 sides[6] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    for (unsigned open = 0; open < 6; ++open) {
        const Fitted fitted = fit({}, {600, 600}, CUBE, BoxMesh(0x3f & ~(1u << open), true).cover());
        // The open side, 2 x 2 at distance 1 from the centre, fills the view of 40 degrees but for the
        // margin.
        const double distance = 1 + 1.05 / std::tan(glm::radians(20.));
        EXPECT_NEAR(glm::distance(fitted.camera.eye, sides[open] * distance), 0, 1e-12) << open;
    }
}

TEST(CameraFit, AClosedRoomIsSeenFromInside) {
    const Camera camera = fit({}, {800, 600}, CUBE, BoxMesh(0x3f, true).cover()).camera;
    EXPECT_EQ(camera.eye, glm::dvec3(0, 0, 0.9));
}

TEST(CameraFit, FewerThanFourWallsAreNoRoom) {
    const Camera camera = fit({}, {800, 600}, CUBE, BoxMesh(0x2a, true).cover()).camera;
    EXPECT_GT(camera.eye.x, 0);
    EXPECT_GT(camera.eye.y, 0);
}

TEST(CameraFit, FlatScenesAreNoRoom) {
    BoxMesh mesh(0x20, true); // the floor only
    for (double cover : mesh.cover())
        EXPECT_EQ(cover, 0);
}
