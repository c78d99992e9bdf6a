// SPDX-License-Identifier: Apache-2.0
#include "run/turntable.h"

#include "exit_code.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

using namespace clrt;

TEST(Turntable, TheEyeGoesOnceAroundAtAboutUp) {
    const Camera camera{{4, 3, 5}, {1, 2, 1}, {0, 2, 0}, 40};
    const glm::dvec3 eyes[] = {{4, 3, 5}, {5, 3, -2}, {-2, 3, -3}, {-3, 3, 4}}; // counterclockwise from above
    for (int frame = 1; frame <= 4; ++frame) {
        const Camera turned = turned_camera(camera, frame, 4);
        EXPECT_NEAR(glm::distance(turned.eye, eyes[frame - 1]), 0, 1e-12) << frame;
        EXPECT_EQ(turned.at, camera.at);
        EXPECT_EQ(turned.up, camera.up);
    }
}

TEST(Turntable, DistanceAndHeightStayForAnyUp) {
    const Camera camera{{4, 3, 5}, {1, 2, 1}, {1, -2, 3}, 40};
    const glm::dvec3 up = glm::normalize(camera.up);
    for (int frame = 1; frame <= 7; ++frame) {
        const glm::dvec3 arm = turned_camera(camera, frame, 7).eye - camera.at,
                         first = camera.eye - camera.at;
        EXPECT_NEAR(glm::length(arm), glm::length(first), 1e-12);
        EXPECT_NEAR(glm::dot(arm, up), glm::dot(first, up), 1e-12);
    }
    EXPECT_EQ(turned_camera(camera, 1, 7).eye, camera.eye);
}

TEST(Turntable, TheGravestExitCodeWins) {
    EXPECT_EQ(graver_exit(EXIT_DONE, EXIT_DONE), EXIT_DONE);
    EXPECT_EQ(graver_exit(EXIT_ERROR_NOT_REACHED, EXIT_DONE), EXIT_ERROR_NOT_REACHED);
    EXPECT_EQ(graver_exit(EXIT_ERROR_NOT_REACHED, EXIT_CHECK), EXIT_CHECK);
    EXPECT_EQ(graver_exit(EXIT_CHECK, EXIT_DEVICE), EXIT_DEVICE);
    EXPECT_EQ(graver_exit(EXIT_DEVICE, EXIT_SCENE), EXIT_SCENE);
    EXPECT_EQ(graver_exit(EXIT_SCENE, EXIT_DONE), EXIT_SCENE);
    EXPECT_EQ(graver_exit(EXIT_SCENE, EXIT_INTERRUPTED), EXIT_INTERRUPTED);
    EXPECT_EQ(graver_exit(EXIT_DEVICE, EXIT_INTERRUPTED), EXIT_INTERRUPTED);
}
