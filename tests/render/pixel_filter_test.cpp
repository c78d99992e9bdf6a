// SPDX-License-Identifier: Apache-2.0
// Where pixels lie and how filters spread them: pictures of a straight edge against the filter's integral.
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double EDGE = 8.25; ///< pixels from the picture's left or top

/// Standard error that a line of pixels may have, in the lamp's radiance. LARGEST_Z of them are the light
/// that an edge moves by in 1/160 pixel under a box of one pixel: so small a shift, or a width that is off by
/// a hundredth, is seen.
constexpr double LARGEST_ERROR = 1 / (160 * LARGEST_Z);

enum class Axis { X, Y };

/// A picture of 16 x 16 pixels, each one unit wide, of a lamp that ends at film position EDGE: it lies left
/// of it or above it.
class EdgeScene : public TestScene {
public:
    explicit EdgeScene(Axis axis) {
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
        const double right = axis == Axis::X ? EDGE - 8 : 30, bottom = axis == Axis::Y ? 8 - EDGE : -30;
        build.polygon({{-30, bottom, 0}, {right, bottom, 0}, {right, 30, 0}, {-30, 30, 0}});
        const double distance = 20;
        look({0, 0, distance}, {0, 0, 0}, 2 * std::atan(8 / distance) * 180 / 3.14159265358979323846);
        options.transport.integrator = Integrator::RAYCAST;
        options.sampling.spp = 4096; // a line has the error that it may have, or half of it
    }
    void filter(Filter kind, std::optional<double> radius = {}) {
        options.film.filter = kind;
        options.film.filter_radius = radius;
    }
};

/// Expects that pixel `i` along the axis holds the filter's integral up to the edge: cdf(edge - pixel
/// centre).
template <typename Cdf>
void expect_edge(Filter kind, std::optional<double> radius, const Cdf& cdf) {
    for (const Axis axis : {Axis::X, Axis::Y}) {
        EdgeScene scene(axis);
        scene.filter(kind, radius);
        const Film film = scene.render().film;
        for (int i = 0; i < 16; ++i) {
            const Crop line = axis == Axis::X ? Crop{i, 0, i + 1, 16} : Crop{0, i, 16, i + 1};
            const double expected = cdf(EDGE - (i + 0.5));
            if (expected == 0)
                EXPECT_EQ(film_estimate(film, 0, line).mean, 0) << i;
            else
                EXPECT_TRUE(agrees(film_estimate(film, 0, line), expected, LARGEST_ERROR / expected, 1e-5))
                    << (axis == Axis::X ? "column " : "row ") << i;
        }
    }
}

/// Share of a disc-shaped Gaussian (deviation radius / 3, cut at the radius) on the side x < a.
double cut_gaussian_cdf(double a, double radius) {
    const double sigma = radius / 3;
    double below = 0, total = 0;
    const int steps = 1000;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const double x = radius * (2 * (i + 0.5) / steps - 1), y = radius * (2 * (k + 0.5) / steps - 1);
            if (x * x + y * y > radius * radius)
                continue;
            const double weight = std::exp(-(x * x + y * y) / (2 * sigma * sigma));
            total += weight;
            below += x < a ? weight : 0;
        }
    return below / total;
}

} // namespace

TEST(PixelFilter, ABoxAveragesThePixel) {
    expect_edge(Filter::BOX, {}, [](double a) { return std::min(std::max(a + 0.5, 0.0), 1.0); });
}

TEST(PixelFilter, AWiderBoxReachesItsRadius) {
    expect_edge(Filter::BOX, 2.0, [](double a) { return std::min(std::max((a + 2) / 4, 0.0), 1.0); });
}

TEST(PixelFilter, ATentFallsOffLinearly) {
    for (const double radius : {1.0, 2.0})
        expect_edge(Filter::TENT, radius == 1 ? std::optional<double>() : radius, [&](double a) {
            const double t = std::min(std::max(a / radius, -1.0), 1.0);
            return t < 0 ? 0.5 * (1 + t) * (1 + t) : 1 - 0.5 * (1 - t) * (1 - t);
        });
}

TEST(PixelFilter, AGaussianIsCutAtItsRadius) {
    expect_edge(Filter::GAUSSIAN, {}, [](double a) {
        return a <= -1.5 ? 0 : a >= 1.5 ? 1 : std::round(cut_gaussian_cdf(a, 1.5) * 1e6) / 1e6;
    });
}

TEST(PixelFilter, PixelZeroIsAtTheTopLeft) {
    TestScene scene;
    scene.options.transport.integrator = Integrator::RAYCAST;
    scene.options.sampling.spp = 64;
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
    scene.build.polygon({{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}}); // left of and above the centre
    scene.look({0, 0, 3}, {0, 0, 0}, 30);
    const Film film = scene.render().film;
    EXPECT_NEAR(film_pixel(film, 0, 0).x, 1, 1e-12) << "rounding to the film's quanta adds nothing";
    EXPECT_NEAR(film_pixel(film, 7, 7).x, 1, 1e-6);
    EXPECT_EQ(film_pixel(film, 8, 7).x, 0);
    EXPECT_EQ(film_pixel(film, 7, 8).x, 0);
    EXPECT_EQ(film_pixel(film, 15, 15).x, 0);
}

TEST(PixelFilter, TheAngleOfViewIsVertical) {
    // A lamp that fills the height of a 2:1 picture exactly fills half of its width.
    TestScene scene;
    scene.options.transport.integrator = Integrator::RAYCAST;
    scene.options.film.size = {32, 16};
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
    scene.build.polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    scene.look({0, 0, 1}, {0, 0, 0}, 90);
    const Film film = scene.render().film;
    EXPECT_NEAR(film_estimate(film, 0, {8, 0, 24, 16}).mean, 1, 1e-6);
    EXPECT_EQ(film_estimate(film, 0, {0, 0, 8, 16}).mean, 0);
    EXPECT_EQ(film_estimate(film, 0, {24, 0, 32, 16}).mean, 0);
}

TEST(PixelFilter, TheUpVectorNeedNotBeOrthogonal) {
    TestScene scene;
    scene.options.transport.integrator = Integrator::RAYCAST;
    scene.options.sampling.spp = 64;
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
    scene.build.polygon({{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}});
    scene.look({0, 0, 3}, {0, 0, 0}, 30);
    const auto sums = [&](const glm::dvec3& up) {
        scene.options.camera.up = up;
        return film_estimate(scene.render().film, 0, {0, 0, 8, 8}).mean;
    };
    EXPECT_NEAR(sums({0, 3, 5}), 1, 1e-6) << "projected on the picture's plane";
    EXPECT_EQ(sums({-1, 0, 0}), 0) << "a quarter turn: up is to the left";
}

} // namespace clrt
