// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_fit.h"

#include "camera_fit_support.h"
#include "error.h"
#include "scene/box_cover.h"
#include "scene/framing.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace clrt;

namespace {

const Bounds BOX{glm::dvec3(-1, 0, -3), glm::dvec3(3, 2, 1)};

Fitted fit(const CameraOptions& options, glm::ivec2 size = {800, 600}, const Bounds& box = BOX) {
    return fit_points(options, size, box_points(box));
}

BoxCover cover_of(const Points& points) {
    const Scene scene = scene_of(points);
    return measure_box_cover(scene.positions, scene.triangles);
}

const Bounds CUBE{glm::dvec3(-1), glm::dvec3(1)};

/// Where points are in the picture: -1 to 1 from edge to edge; the largest value on either axis.
struct InPicture {
    glm::dvec2 low{1e9}, high{-1e9};
    double nearest = 1e9; ///< along the view
};

InPicture project(const Camera& camera, glm::ivec2 size, const Points& points) {
    const PictureAxes axes = picture_axes(camera.at - camera.eye, camera.up);
    const bool is_parallel = camera.projection == PROJECTION_ORTHOGRAPHIC;
    const double vertical =
                     is_parallel ? camera.ortho_height / 2 : std::tan(glm::radians(camera.fov_degrees) / 2),
                 horizontal = vertical * size.x / size.y;
    InPicture picture;
    for (const glm::dvec3& p : points) {
        const glm::dvec3 way = p - camera.eye;
        const double depth = glm::dot(way, axes.look);
        const double scale = is_parallel ? 1 : depth;
        const glm::dvec2 at(glm::dot(way, axes.right) / scale / horizontal,
                            glm::dot(way, axes.up) / scale / vertical);
        picture.low = glm::min(picture.low, at);
        picture.high = glm::max(picture.high, at);
        picture.nearest = std::min(picture.nearest, depth);
    }
    return picture;
}

const Points ROD = box_points({glm::dvec3(-5, 0, 0), glm::dvec3(5, 0.1, 0.1)});
const Points PLATE = box_points({glm::dvec3(-5, 0, -5), glm::dvec3(5, 0.01, 5)});
const Points TOWER = box_points({glm::dvec3(100, 0, 7), glm::dvec3(101, 30, 8)});

Points random_points() {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    Points points;
    for (int i = 0; i < 600; ++i)
        points.emplace_back(3 * normal(random), normal(random) - 7, 0.5 * normal(random));
    return points;
}

} // namespace

TEST(CameraFit, EverythingIsInThePictureAndTouchesTheMargin) {
    const std::optional<View> views[] = {std::nullopt, View::FRONT, View::TOP, View::ISO};
    for (const Points& points : {ROD, PLATE, TOWER, random_points()})
        for (const glm::ivec2 size : {glm::ivec2(800, 600), glm::ivec2(300, 900), glm::ivec2(1920, 400)})
            for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), {0, 0, 1}, {1, 0, 0}, {0, -2, 0}, {1, 2, -3}})
                for (const auto& view : views) {
                    CameraOptions options;
                    options.up = up;
                    options.view = view;
                    const InPicture seen = project(fit_points(options, size, points).camera, size, points);
                    const double widest = std::max(seen.high.x - seen.low.x, seen.high.y - seen.low.y) / 2;
                    const Scene scene = scene_of(points);
                    const double radius =
                        find_framed(scene, glm::normalize(up)).box.radius() / scene.normalisation.scale;
                    EXPECT_GT(seen.nearest, (LEAST_DISTANCE - 1e-4) * radius);
                    // Points see the picture's edges, or the eye is as near as it may come.
                    if (seen.nearest > (LEAST_DISTANCE + 1e-4) * radius) {
                        EXPECT_NEAR(widest, FRAMED_SHARE, 1e-5) << size.x << " " << up.x << up.y << up.z;
                    }
                    for (int axis = 0; axis < 2; ++axis) // in the middle
                        EXPECT_NEAR(seen.low[axis], -seen.high[axis], 1e-3);
                    EXPECT_LT(std::max({seen.high.x, seen.high.y, -seen.low.x, -seen.low.y}),
                              FRAMED_SHARE + 1e-5);
                }
}

TEST(CameraFit, ParallelRaysShowEverythingAndTouchTheMargin) {
    for (const Points& points : {ROD, PLATE, TOWER, random_points()})
        for (const glm::ivec2 size : {glm::ivec2(800, 600), glm::ivec2(300, 900), glm::ivec2(1920, 400)})
            for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), {0, 0, 1}, {1, 2, -3}})
                for (const auto& view : {std::optional<View>(), std::optional<View>(View::TOP)}) {
                    CameraOptions options;
                    options.up = up;
                    options.view = view;
                    options.projection = PROJECTION_ORTHOGRAPHIC;
                    const Camera camera = fit_points(options, size, points).camera;
                    const InPicture seen = project(camera, size, points);
                    const Scene scene = scene_of(points);
                    const double radius =
                        find_framed(scene, glm::normalize(up)).box.radius() / scene.normalisation.scale;
                    EXPECT_NEAR(seen.nearest, LEAST_DISTANCE * radius, 1e-4 * radius);
                    for (int axis = 0; axis < 2; ++axis)
                        EXPECT_NEAR(seen.low[axis], -seen.high[axis], 1e-4);
                    // Points see the picture's edges, or the film is as small as it may be.
                    const double widest = std::max(seen.high.x, seen.high.y);
                    if (camera.ortho_height > (LEAST_HEIGHT + 1e-4) * radius)
                        EXPECT_NEAR(widest, FRAMED_SHARE, 1e-5);
                    else
                        EXPECT_LT(widest, FRAMED_SHARE + 1e-5);
                }
}

TEST(CameraFit, ParallelRaysAimAtThePointThatIsGiven) {
    CameraOptions options;
    options.projection = PROJECTION_ORTHOGRAPHIC;
    options.view = View::FRONT;
    options.at = glm::dvec3(0.5, 0, 0);
    const Points points = box_points(CUBE);
    const InPicture seen = project(fit_points(options, {800, 600}, points).camera, {800, 600}, points);
    EXPECT_NEAR(seen.low.x * 4 / 3, -1.5 * FRAMED_SHARE / std::max(1.5 * 3 / 4, 1.), 1e-5);
    EXPECT_NEAR(seen.high.x * 4 / 3, 0.5 * FRAMED_SHARE / std::max(1.5 * 3 / 4, 1.), 1e-5);
}

TEST(CameraFit, ARodAlongParallelRaysIsShownSmall) {
    CameraOptions options;
    options.projection = PROJECTION_ORTHOGRAPHIC;
    options.view = View::RIGHT;
    const Fitted fitted =
        fit_points(options, {800, 600}, box_points({glm::dvec3(-5, 0, 0), glm::dvec3(5, 1e-3, 1e-3)}));
    EXPECT_NEAR(fitted.camera.ortho_height, LEAST_HEIGHT * 5, 1e-3);
}

TEST(CameraFit, FromAGivenEyeParallelRaysShowWhatThePinholeShowsAtItsTarget) {
    CameraOptions options;
    options.projection = PROJECTION_ORTHOGRAPHIC;
    options.eye = glm::dvec3(0, 0, 10);
    options.at = glm::dvec3(0);
    const Fitted fitted = fit(options);
    EXPECT_NEAR(fitted.camera.ortho_height, 20 * std::tan(glm::radians(20.)), 1e-9);
    ASSERT_EQ(fitted.notices.size(), 1u);
    EXPECT_EQ(fitted.notices[0].find("camera: --eye 0,0,10 --at 0,0,0 --up 0,1,0 --projection orthographic "
                                     "--ortho-height 7.279"),
              0u)
        << fitted.notices[0];
    options.ortho_height = 3;
    EXPECT_EQ(fit(options).camera.ortho_height, 3);
    EXPECT_TRUE(fit(options).notices.empty());
}

TEST(CameraFit, ARodAlongTheViewIsSeenFromADistance) {
    CameraOptions options;
    options.view = View::RIGHT;
    const Camera camera = fit_points(options, {800, 600}, ROD).camera;
    EXPECT_NEAR(camera.eye.x - 5, LEAST_DISTANCE * bounds_of(ROD).radius(), 1e-5);
}

TEST(CameraFit, PointsThatNoTriangleUsesAreNotFramed) {
    Scene scene = scene_of(box_points(CUBE));
    NoticeList notices;
    const Camera camera = fit_camera({}, {800, 600}, scene, CUBE, notices);
    scene.positions.push_back({100, 100, 100, 0});
    EXPECT_EQ(fit_camera({}, {800, 600}, scene, CUBE, notices).eye, camera.eye);
}

TEST(CameraFit, AVastFloorIsNotFramed) {
    Points points = box_points(CUBE);
    const Points ground = box_points({glm::dvec3(-50, -1.001, -50), glm::dvec3(50, -1, 50)}, 0x10);
    points.insert(points.end(), ground.begin(), ground.end());
    const Camera camera = fit_points({}, {800, 600}, points).camera;
    const InPicture seen = project(camera, {800, 600}, box_points(CUBE));
    EXPECT_NEAR(std::max(seen.high.x - seen.low.x, seen.high.y - seen.low.y) / 2, FRAMED_SHARE, 1e-4);
}

/// Fits to points and to triangles that shine.
Fitted fit_with_lamps(const Points& points, const Points& lamps, const CameraOptions& options = {}) {
    Points all = points;
    all.insert(all.end(), lamps.begin(), lamps.end());
    Scene scene = scene_of(all);
    for (size_t i = 0; i < scene.triangles.size(); ++i)
        scene.triangles[i].emitter = i < points.size() / 3 ? NO_INDEX : u32(i - points.size() / 3);
    scene.emitters.resize(lamps.size() / 3);
    NoticeList notices;
    const Camera camera = fit_camera(options, {800, 600}, scene, bounds_of(all), notices);
    return {camera, notices.lines()};
}

/// A square of this half side at this height.
Points square_above(double half, double height) {
    const glm::dvec3 a(-half, height, -half), b(half, height, -half), c(half, height, half),
        d(-half, height, half);
    return {a, b, c, a, c, d};
}

TEST(CameraFit, LampsFarAwayAreNotFramed) {
    const Points things = box_points(BOX);
    const Camera alone = fit_points({}, {800, 600}, things).camera;
    for (const Points& lamps : {square_above(300, 1000), square_above(1, 1000), square_above(300, 3)}) {
        const Camera with = fit_with_lamps(things, lamps).camera;
        EXPECT_LT(glm::distance(with.eye, alone.eye), 1e-3);
        EXPECT_LT(glm::distance(with.at, alone.at), 1e-3);
    }
    CameraOptions parallel;
    parallel.projection = PROJECTION_ORTHOGRAPHIC;
    EXPECT_NEAR(fit_with_lamps(things, square_above(300, 1000), parallel).camera.ortho_height,
                fit_points(parallel, {800, 600}, things).camera.ortho_height, 1e-3);
    // One lamp is far, another among the things.
    Points lamps = square_above(300, 1000);
    const Points near = square_above(1, 4);
    lamps.insert(lamps.end(), near.begin(), near.end());
    Points with_near = things;
    with_near.insert(with_near.end(), near.begin(), near.end());
    EXPECT_LT(glm::distance(fit_with_lamps(things, lamps).camera.eye,
                            fit_points({}, {800, 600}, with_near).camera.eye),
              1e-3);
    // A wide floor below is left out as without the lamp.
    Points on_floor = square_above(40, 0);
    on_floor.insert(on_floor.end(), things.begin(), things.end());
    EXPECT_LT(glm::distance(fit_with_lamps(on_floor, square_above(300, 2000)).camera.eye,
                            fit_points({}, {800, 600}, on_floor).camera.eye),
              1e-3);
}

TEST(CameraFit, LampsNearbyAndLampsAloneAreFramed) {
    const Points things = box_points(BOX), lamp = square_above(1, 12);
    Points both = things;
    both.insert(both.end(), lamp.begin(), lamp.end());
    EXPECT_EQ(fit_with_lamps(things, lamp).camera.eye, fit_points({}, {800, 600}, both).camera.eye);
    EXPECT_EQ(fit_with_lamps({}, lamp).camera.eye, fit_points({}, {800, 600}, lamp).camera.eye);
}

TEST(CameraFit, APlinthIsFramed) {
    Points points = box_points(CUBE);
    const Points plinth = box_points({glm::dvec3(-1.5, -1.01, -1.5), glm::dvec3(1.5, -1, 1.5)});
    points.insert(points.end(), plinth.begin(), plinth.end());
    const InPicture seen = project(fit_points({}, {800, 600}, points).camera, {800, 600}, points);
    EXPECT_LT(std::max({seen.high.x, seen.high.y, -seen.low.x, -seen.low.y}), FRAMED_SHARE + 1e-4);
}

TEST(CameraFit, ViewsAreNamedInTheFrameOfUp) {
    const struct {
        View view;
        glm::dvec3 y_up, z_up;
    } rows[] = {{View::FRONT, {0, 0, 1}, {0, -1, 0}},
                {View::BACK, {0, 0, -1}, {0, 1, 0}},
                {View::LEFT, {-1, 0, 0}, {-1, 0, 0}},
                {View::RIGHT, {1, 0, 0}, {1, 0, 0}},
                {View::TOP, {0, 1, 0}, {0, 0, 1}},
                {View::BOTTOM, {0, -1, 0}, {0, 0, -1}},
                {View::ISO, glm::normalize(glm::dvec3(1, 1, 1)), glm::normalize(glm::dvec3(1, -1, 1))}};
    for (const auto& row : rows)
        for (const bool is_z : {false, true}) {
            CameraOptions options;
            options.view = row.view;
            if (is_z)
                options.up = glm::dvec3(0, 0, 1);
            const Fitted fitted = fit(options, {400, 400}, CUBE);
            const glm::dvec3 direction = glm::normalize(fitted.camera.eye - fitted.camera.at);
            EXPECT_NEAR(glm::distance(direction, is_z ? row.z_up : row.y_up), 0, 1e-12) << int(row.view);
            EXPECT_EQ(fitted.notices.size(), 1u) << "the view needs another up, and that is no fallback";
        }
    CameraOptions options;
    options.view = View::TOP;
    EXPECT_EQ(fit(options).camera.up, glm::dvec3(0, 0, -1)); // the front is at the bottom of the picture
    options.up = glm::dvec3(0, 0, 1);
    EXPECT_EQ(fit(options).camera.up, glm::dvec3(0, 1, 0));
}

TEST(CameraFit, TurningTheSceneAndUpTurnsTheCamera) {
    Points turned = TOWER; // y up becomes z up: (x, y, z) -> (x, -z, y)
    for (glm::dvec3& p : turned)
        p = {p.x, -p.z, p.y};
    CameraOptions options;
    const Camera y_up = fit_points(options, {800, 600}, TOWER).camera;
    options.up = glm::dvec3(0, 0, 1);
    const Camera z_up = fit_points(options, {800, 600}, turned).camera;
    EXPECT_NEAR(glm::distance(z_up.eye, {y_up.eye.x, -y_up.eye.z, y_up.eye.y}), 0, 1e-5);
    EXPECT_NEAR(glm::distance(z_up.at, {y_up.at.x, -y_up.at.z, y_up.at.y}), 0, 1e-5);
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
    const InPicture seen = project(camera, {800, 600}, box_points(BOX));
    EXPECT_NEAR(std::max({seen.high.x, seen.high.y, -seen.low.x, -seen.low.y}), FRAMED_SHARE, 1e-5);
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
    const Points point(3, glm::dvec3(5));
    const Camera camera = fit_points({}, {800, 600}, point).camera;
    EXPECT_GT(glm::distance(camera.eye, camera.at), 1);
    EXPECT_EQ(camera.at, glm::dvec3(5));
}

TEST(CameraFit, RoomsAreCoveredFromInsideAndSolidsAreNot) {
    const BoxCover room = cover_of(box_points(CUBE, 0x3f, true)), solid = cover_of(box_points(CUBE));
    for (size_t f = 0; f < 6; ++f) {
        EXPECT_EQ(room[f], 1);
        EXPECT_EQ(solid[f], 0);
    }
    for (unsigned open = 0; open < 6; ++open) {
        const BoxCover cover = cover_of(box_points(CUBE, 0x3f & ~(1u << open), true));
        for (unsigned f = 0; f < 6; ++f)
            EXPECT_EQ(cover[f], f == open ? 0 : 1) << "open " << open << ", face " << f;
    }
}

TEST(CameraFit, ARoomIsSeenThroughItsOpenSide) {
    const glm::dvec3 sides[6] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    for (unsigned open = 0; open < 6; ++open) {
        const Fitted fitted = fit_points({}, {600, 600}, box_points(CUBE, 0x3f & ~(1u << open), true));
        // The open side, 2 x 2 at distance 1 from the centre, fills the view of 40 degrees but for the
        // margin.
        const double distance = 1 + 1 / (FRAMED_SHARE * std::tan(glm::radians(20.)));
        EXPECT_NEAR(glm::distance(fitted.camera.eye, sides[open] * distance), 0, 1e-6) << open;
    }
}

TEST(CameraFit, AClosedRoomIsSeenFromInside) {
    for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), {0, 0, 1}}) {
        CameraOptions options;
        options.up = up;
        const Camera camera = fit_points(options, {800, 600}, box_points(CUBE, 0x3f, true)).camera;
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LT(std::fabs(camera.eye[axis]), 1);
        EXPECT_NEAR(glm::dot(glm::normalize(camera.at - camera.eye), up), -0.12, 0.01) << "nearly level";
        EXPECT_EQ(camera.fov_degrees, 60);
        options.fov_degrees = 35;
        EXPECT_EQ(fit_points(options, {800, 600}, box_points(CUBE, 0x3f, true)).camera.fov_degrees, 35);
        EXPECT_GT(glm::distance(camera.at, camera.eye), 1) << "it looks where there is space";
    }
}

TEST(CameraFit, ASetBackFrontWallIsNoOpenSide) {
    Points room = box_points(CUBE, 0x3e, true);
    for (glm::dvec3 p : box_points(CUBE, 0x01, true))
        room.push_back({p.x, p.y, 0.7});
    const Camera camera = fit_points({}, {800, 600}, room).camera;
    EXPECT_LT(camera.eye.z, 0.7) << "else it sees the wall's back";
}

TEST(CameraFit, AClosedBoxWithThickWallsIsARoomIfItHasLamps) {
    Points walls = box_points(CUBE, 0x3f, true);
    const Bounds box{glm::dvec3(-1.05), glm::dvec3(1.05)};
    const Points outside = box_points(box);
    walls.insert(walls.end(), outside.begin(), outside.end());
    for (const bool has_lamps : {false, true}) {
        Scene scene = scene_of(walls);
        scene.emitters.resize(has_lamps ? 1 : 0);
        NoticeList notices;
        const Camera camera = fit_camera({}, {800, 600}, scene, box, notices);
        EXPECT_EQ(std::fabs(camera.eye.z) < 1 && std::fabs(camera.eye.x) < 1, has_lamps);
    }
}

TEST(CameraFit, SolidThingsAreSeenFromOutside) {
    for (const Points& points : {box_points(CUBE), TOWER}) {
        const Bounds box = bounds_of(points);
        const Camera camera = fit_points({}, {800, 600}, points).camera;
        EXPECT_GT(camera.eye.x, box.high.x);
        EXPECT_GT(camera.eye.y, box.low.y);
        EXPECT_GT(camera.eye.z, box.high.z);
    }
}

TEST(CameraFit, FewerThanFourWallsAreNoRoom) {
    const Camera camera = fit_points({}, {800, 600}, box_points(CUBE, 0x2a, true)).camera;
    EXPECT_GT(camera.eye.x, 0);
    EXPECT_GT(camera.eye.y, 0);
}

TEST(CameraFit, FlatScenesAreNoRoom) {
    for (double cover : cover_of(box_points(CUBE, 0x20, true))) // the floor only
        EXPECT_EQ(cover, 0);
}
