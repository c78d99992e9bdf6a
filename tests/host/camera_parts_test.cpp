// SPDX-License-Identifier: Apache-2.0
// What the options make of lens, shift, panoramas and motion; where the camera stands: camera_fit_test.
#include "command_line_support.h"
#include "error.h"
#include "run/turntable.h"
#include "scene/camera_fit.h"
#include "scene/camera_params.h"
#include "scene/vectors.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;
using glm::dvec3;

namespace {

constexpr glm::ivec2 SIZE(80, 60);

/// A camera at (0, 0, 5) that looks at the origin.
CameraOptions down_the_axis() {
    CameraOptions options;
    options.eye = dvec3(0, 0, 5);
    options.at = dvec3(0);
    return options;
}

Camera fit(const CameraOptions& options, std::vector<std::string>* lines = nullptr) {
    NoticeList notices;
    const Camera camera = fit_camera(options, SIZE, Scene(), {dvec3(-1), dvec3(1)}, notices);
    if (lines)
        *lines = notices.lines();
    return camera;
}

std::string fit_refusal(const CameraOptions& options) {
    try {
        fit(options);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "none";
}

} // namespace

TEST(CameraParts, LensAndShutterOptionsArrive) {
    const CameraOptions lens =
        parse({"--aperture", "0.5", "--focus", "3", "--blades", "5", "--shift", "-1,0.5"}).camera;
    EXPECT_EQ(lens.aperture, 0.5);
    EXPECT_EQ(lens.focus, 3);
    EXPECT_EQ(lens.blades, 5);
    EXPECT_EQ(lens.shift, glm::dvec2(-1, 0.5));
    const CameraOptions point = parse({"--aperture", "0", "--focus", "2", "--focus", "1,2,3"}).camera;
    EXPECT_FALSE(point.focus);
    EXPECT_EQ(point.focus_point, dvec3(1, 2, 3));
    EXPECT_EQ(parse({"--aperture", "1", "--focus", "inf"}).camera.focus,
              std::numeric_limits<double>::infinity());
    const CameraOptions motion =
        parse({"--end-eye", "1,2,3", "--end-at", "4,5,6", "--end-up", "z", "--shutter", "0.25,0.75"}).camera;
    EXPECT_EQ(motion.end_eye, dvec3(1, 2, 3));
    EXPECT_EQ(motion.end_at, dvec3(4, 5, 6));
    EXPECT_EQ(motion.end_up, dvec3(0, 0, 1));
    EXPECT_EQ(motion.shutter, glm::dvec2(0.25, 0.75));
}

TEST(CameraParts, WithoutALensThereIsNone) {
    const Camera camera = fit(down_the_axis());
    EXPECT_EQ(camera.aperture, 0);
    EXPECT_FALSE(camera.end);
    EXPECT_EQ(make_camera_params(camera, Normalisation(), SIZE).lens_radius, 0);
}

TEST(CameraParts, TheLensFocusesOnWhatTheCameraLooksAt) {
    CameraOptions options = down_the_axis();
    options.aperture = 0.5;
    options.blades = 6;
    std::vector<std::string> lines;
    const Camera camera = fit(options, &lines);
    EXPECT_EQ(camera.focus, 5);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("--focus 5"), std::string::npos) << "to copy: " << lines[0];
    const CameraParams params = make_camera_params(camera, {dvec3(1), 0.5}, SIZE);
    EXPECT_EQ(params.lens_radius, 0.125f);
    EXPECT_EQ(params.inverse_focus, 0.4f);
    EXPECT_EQ(params.blades, 6u);
}

TEST(CameraParts, TheFocusIsADepthAPointOrInfinity) {
    CameraOptions options = down_the_axis();
    options.fstop = 2;
    options.focal_length = 0.5;
    options.film_width = 0.4;
    options.focus = 3;
    EXPECT_EQ(fit(options).focus, 3);
    EXPECT_EQ(fit(options).aperture, 0.25);
    options.focus = std::numeric_limits<double>::infinity();
    EXPECT_EQ(make_camera_params(fit(options), Normalisation(), SIZE).inverse_focus, 0);
    options.focus.reset();
    options.focus_point = dvec3(7, -2, 1); // beside the axis: its depth counts
    EXPECT_EQ(fit(options).focus, 4);
    options.focus_point = dvec3(0, 0, 6);
    EXPECT_EQ(fit_refusal(options),
              "--focus: expected a point before the camera, found 0,0,6, which lies 1 behind it");
}

TEST(CameraParts, AShiftCountsInPicturesRightAndUp) {
    CameraOptions options = down_the_axis();
    options.shift = glm::dvec2(0.5, 0.25);
    const CameraParams params = make_camera_params(fit(options), Normalisation(), SIZE);
    EXPECT_EQ(params.shift_x, 40);
    EXPECT_EQ(params.shift_y, -15);
    const FilmRay middle = film_ray(params, {0, 0});
    EXPECT_GT(middle.direction.x, 0);
    EXPECT_GT(middle.direction.y, 0);
}

TEST(CameraParts, AFisheyeShowsAHalfOfAllDirectionsUnlessItsCornersLookBack) {
    CameraOptions options = down_the_axis();
    options.projection = PROJECTION_FISHEYE;
    EXPECT_EQ(field_of_view(options, {80, 60}), 180);
    EXPECT_NEAR(field_of_view(options, {300, 100}), 360 / std::sqrt(10.), 1e-9);
    options.fov_degrees = 216;
    EXPECT_EQ(field_of_view(options, SIZE), 216);
    options.fov_degrees = 217;
    EXPECT_THROW(field_of_view(options, SIZE), UsageError);
}

TEST(CameraParts, APanoramaStandsWhereAPerspectiveCameraWould) {
    CameraOptions options;
    options.projection = PROJECTION_EQUIRECTANGULAR;
    std::vector<std::string> lines;
    const Camera camera = fit(options, &lines);
    EXPECT_GT(glm::distance(camera.eye, camera.at), 0);
    EXPECT_NE(lines.back().find("--projection equirectangular"), std::string::npos) << lines.back();
    EXPECT_EQ(lines.back().find("--fov"), std::string::npos) << lines.back();
}

TEST(CameraParts, TheShutterCutsItsTimesOutOfTheWay) {
    CameraOptions options = down_the_axis();
    options.end_eye = dvec3(4, 0, 5);
    const Camera whole = fit(options);
    EXPECT_EQ(whole.eye, dvec3(0, 0, 5));
    ASSERT_TRUE(whole.end);
    EXPECT_EQ(whole.end->eye, dvec3(4, 0, 5));
    EXPECT_EQ(whole.end->at, dvec3(0)) << "what has no end stands still";
    options.shutter = glm::dvec2(0.25, 0.5);
    const Camera part = fit(options);
    EXPECT_EQ(part.eye, dvec3(1, 0, 5));
    EXPECT_EQ(part.end->eye, dvec3(2, 0, 5));
    options.shutter = glm::dvec2(0.5, 0.5);
    EXPECT_EQ(fit(options).eye, dvec3(2, 0, 5));
    EXPECT_FALSE(fit(options).end) << "no time, no motion";
    options.end_eye = options.eye;
    EXPECT_FALSE(fit(options).end);
}

TEST(CameraParts, ACameraThatLosesItsViewOnTheWayIsRefused) {
    CameraOptions options = down_the_axis();
    options.end_eye = dvec3(0, 0, -5);
    EXPECT_NE(fit_refusal(options).find("never meets what it looks at, found both at 0,0,0"),
              std::string::npos)
        << fit_refusal(options);
    options = down_the_axis();
    options.end_eye = dvec3(0, 5, 0);
    EXPECT_NE(fit_refusal(options).find("never looks along its up vector, found it so at 0,5,0"),
              std::string::npos)
        << fit_refusal(options);
    options.end_up = dvec3(0, 0, -1);
    EXPECT_EQ(fit_refusal(options), "none");
}

TEST(CameraParts, ATurnTurnsTheWholeWay) {
    CameraOptions options = down_the_axis();
    options.end_eye = dvec3(1, 0, 5);
    const Camera turned = turned_camera(fit(options), 2, 4); // a quarter to the right
    EXPECT_LT(glm::distance(turned.eye, dvec3(5, 0, 0)), 1e-12);
    ASSERT_TRUE(turned.end);
    EXPECT_LT(glm::distance(turned.end->eye, dvec3(5, 0, -1)), 1e-12);
}
