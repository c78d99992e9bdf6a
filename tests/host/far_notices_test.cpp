// SPDX-License-Identifier: Apache-2.0
#include "scene/far_notices.h"

#include "scene/assemble_geometry.h"
#include "scene_support.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace clrt {

namespace {

/// Triangles between random points of a box of 500 units at `offset` along x, rounded to multiples of `step`.
Mesh points(double offset, double step) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(0, 500);
    Mesh mesh;
    for (u32 i = 0; i < 300; ++i) {
        const double x = std::round((offset + place(random)) / step) * step;
        mesh.positions.emplace_back(x, place(random), place(random));
        if (i % 3 == 2)
            mesh.triangles.push_back({{i - 2, i - 1, i}, {}, {}, 0, 0});
    }
    return mesh;
}

std::vector<std::string> digits(double offset, double step) {
    const Mesh mesh = points(offset, step);
    NoticeList notices;
    note_coarse_digits(mesh, bounds_of_triangles(mesh), "a.obj", notices);
    return notices.lines();
}

} // namespace

TEST(FarNotices, StepsThatFloatsWouldResolveAreTheFilesLimit) {
    EXPECT_EQ(digits(5.4e6, 1e-3).size(), 0u) << "map coordinates to the millimetre";
    EXPECT_EQ(digits(5.4e6, 0.1).size(), 0u) << "finer than floats, which have steps of 0.5";
    EXPECT_EQ(count_notices(digits(5.4e6, 0.5), "a.obj: x is written in steps of 0.5 near 5.4"), 1);
    EXPECT_EQ(count_notices(digits(5.4e6, 10), "x is written in steps of 10 near 5.4"), 1) << "six digits";
    EXPECT_EQ(count_notices(digits(-5.4e6, 1), "x is written in steps of 1 near 5.4"), 1);
    EXPECT_EQ(count_notices(digits(1e16, 2), "x is written in steps of 2 near 1e+16"), 1)
        << "there doubles end, too";
}

TEST(FarNotices, NearTheOriginStepsAreTheModels) {
    for (const double offset : {0., 1000., 1e5})
        EXPECT_EQ(digits(offset, 1).size(), 0u) << offset;
    Mesh flat;
    flat.positions = {{5.4e6, 0.25, 0}, {5.4e6, 1.75, 0}, {5.4e6, 0, 0.5}};
    flat.triangles.push_back({{0, 1, 2}, {}, {}, 0, 0});
    NoticeList notices;
    note_coarse_digits(flat, bounds_of_triangles(flat), "a.obj", notices);
    EXPECT_TRUE(notices.lines().empty()) << "a wall in one plane has no steps";
}

} // namespace clrt
