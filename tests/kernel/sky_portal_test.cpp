// SPDX-License-Identifier: Apache-2.0
// lights/sky_portal.h: samples through portals have the density that is said of them, cover the solid angle
// of the portals, and go where the sky is bright.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "scene/environment.h"
#include "scene/rectified_sky.h"
#include "scene/sky_texels.h"
#include "scene/vectors.h"
#include "support/test_device.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <gtest/gtest.h>

using namespace clrt;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"lights/sky_portal.h"});
        // a: position; b: two words and v
        made.add(
            "sample",
            "LightView view; view.position = vector_from(a); view.normal = (real3)(REAL(0.0));"
            "const LightSample s = sky_sample_portals(scene, params, &view, as_uint(b.x), as_uint(b.y), b.z);"
            "first = probe_vec4(s.wi, s.pdf_w);"
            "second.x = (float)sky_pdf_w(scene, params, &view, s.wi, (real2)(REAL(0.0)));"
            "second.y = (float)vector_luminance(s.radiance);");
        return made;
    }();
    return instance;
}

/// A rectangle of width x height across z at z = depth, about the axis, that is seen from lower z.
SkyPortal across_z(double width, double height, double depth, double x) {
    SkyPortal portal{};
    portal.corner = {float(x - width / 2), float(-height / 2), float(depth), 0};
    portal.axis_u = {1, 0, 0, float(width)};
    portal.axis_v = {0, 1, 0, float(height)};
    portal.normal = {0, 0, -1, 0};
    return portal;
}

/// A sky whose luminance is 1, but for a patch of this one about +z; `columns` wide.
Environment sky_with_patch(int columns, float bright) {
    EnvironmentImage image{columns, columns / 2, {}};
    image.texels.assign(size_t(columns) * size_t(columns / 2), glm::vec3(1));
    for (int y = columns / 4 - 1; y < columns / 4 + 1; ++y)
        for (int x = columns * 3 / 4 - 1; x < columns * 3 / 4 + 1; ++x)
            image.texels[size_t(y) * size_t(columns) + size_t(x)] = glm::vec3(bright);
    NoticeList notices;
    return map_environment(image, 1, 0, notices);
}

double solid_angle(double width, double height, double depth) {
    const double a = width / (2 * depth), b = height / (2 * depth);
    return 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
}

struct Sampled {
    double mean = 0, error = 0; ///< of luminance / density
    double solid_angle = 0;     ///< mean of 1 / density
    double unlike = 0;          ///< share of the samples of which both densities differ
    double left = 0;            ///< share with negative x
};

Sampled sampled(Environment sky, const std::vector<SkyPortal>& portals, const vec4& position) {
    Scene scene;
    sky.portals = portals;
    rectify_sky(sky);
    RenderParams params{};
    params.environment = {1, 1, 1, 0};
    params.environment_width = u32(sky.width);
    params.environment_height = u32(sky.height);
    params.environment_format = sky.texel_format;
    params.environment_cos = 1;
    params.portal_count = u32(portals.size());
    params.portal_share = 1;
    scene.environment = std::move(sky);
    Random random(3);
    std::vector<vec4> a, b;
    const int count = 20000;
    for (int i = 0; i < count; ++i) {
        const u32 word = random.word(), alias = random.word();
        a.push_back(position);
        b.push_back({bits_to_float(word), bits_to_float(alias), float(random.unit()), 0});
    }
    const SceneProbe::Outputs out = probe().run("sample", scene, params, a, b);
    Sampled result;
    double squares = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double pdf = double(out.first[i].w), weight = pdf > 0 ? 1 / (pdf * count) : 0;
        const double x = weight * double(out.second[i].y);
        result.mean += x;
        squares += x * x * count;
        result.solid_angle += weight;
        result.unlike += std::abs(double(out.second[i].x) - pdf) > 1e-4 * pdf ? 1.0 / count : 0;
        result.left += out.first[i].x < 0 ? 1.0 / count : 0;
    }
    result.error = std::sqrt((squares - result.mean * result.mean) / count);
    return result;
}

/// Luminance of the bilinear lookup, away from the map's borders.
double luminance_at(const Environment& sky, double u, double v) {
    const double x = u * sky.width - 0.5, y = v * sky.height - 0.5;
    const int column = int(std::floor(x)), row = int(std::floor(y));
    const auto mixed = [&](int at) {
        return glm::mix(double(sky_texel(sky, column, at).x), double(sky_texel(sky, column + 1, at).x),
                        x - column);
    };
    return glm::mix(mixed(row), mixed(row + 1), y - row);
}

/// Light that comes through a rectangle about the axis: luminance times solid angle.
double light_through(const Environment& sky, double width, double height, double depth) {
    const int steps = 1000;
    double sum = 0;
    for (int i = 0; i < steps * steps; ++i) {
        const double x = width * ((i % steps + 0.5) / steps - 0.5),
                     y = height * ((i / steps + 0.5) / steps - 0.5);
        const double square = x * x + y * y + depth * depth;
        const double u = 0.5 + std::atan2(depth, x) / (2 * PI), v = std::acos(y / std::sqrt(square)) / PI;
        sum += luminance_at(sky, u, v) * depth / (square * std::sqrt(square));
    }
    return sum * width * height / (steps * steps);
}

} // namespace

TEST(SkyPortal, SamplesCoverItsSolidAngle) {
    for (const Environment& even : {constant_environment({1, 1, 1}), sky_with_patch(512, 1)})
        for (const double depth : {0.002, 0.2, 1.0, 30.0, 3000.0}) {
            SCOPED_TRACE(fmt::format("{} texels across, depth {}", even.width, depth));
            const Sampled one = sampled(even, {across_z(1, 2, depth, 0)}, {0, 0, 0, 0});
            EXPECT_NEAR(one.mean / solid_angle(1, 2, depth), 1, 5 * one.error / one.mean + 1e-3);
            EXPECT_LT(one.unlike, 1e-3);
            if (even.width > 0) // nearly in proportion
                EXPECT_LT(one.error / one.mean * std::sqrt(20000.0), 0.2);
        }
}

TEST(SkyPortal, SamplesGoWhereTheSkyIsBright) {
    for (const int columns : {32, 512, 2048}) {
        const float bright = float(columns) * float(columns);
        const Environment sky = sky_with_patch(columns, bright);
        const Sampled one = sampled(sky, {across_z(1, 2, 1, 0.1)}, {0.1f, 0, 0, 0});
        EXPECT_NEAR(one.mean / light_through(sky, 1, 2, 1), 1, 5 * one.error / one.mean + 2e-3) << columns;
        // Even samples have a standard deviation of 190 means in the finest map, whose patch is smaller than
        // a texel of the rectified one.
        EXPECT_LT(one.error / one.mean * std::sqrt(20000.0), columns == 2048 ? 6 : 1) << columns;
        EXPECT_LT(one.unlike, 1e-2) << columns;
    }
}

TEST(SkyPortal, SeveralAreOneMixture) {
    // Two windows, and another one behind the first: what both show is covered once.
    for (const Environment& even : {constant_environment({1, 1, 1}), sky_with_patch(512, 1)}) {
        const SkyPortal left = across_z(1, 1, 2, -1.5), right = across_z(1.5, 2, 2, 1.5);
        const SkyPortal behind = across_z(1.5, 1.5, 3, -2.25);
        const Sampled two = sampled(even, {left, right}, {0, 0, 0, 0});
        const Sampled three = sampled(even, {left, right, behind}, {0, 0, 0, 0});
        const Sampled of_left = sampled(even, {left}, {0, 0, 0, 0});
        const Sampled of_right = sampled(even, {right}, {0, 0, 0, 0});
        const double both = of_left.mean + of_right.mean;
        EXPECT_NEAR(two.mean, both, 5 * (two.error + of_left.error + of_right.error));
        EXPECT_NEAR(two.left, of_left.mean / both, 0.03);
        EXPECT_NEAR(two.mean, three.mean, 5 * std::hypot(two.error, three.error));
        EXPECT_LT(three.unlike, 1e-3);
    }
}

TEST(SkyPortal, IsNotSeenFromBehindOrFromItsPlane) {
    for (const Environment& even : {constant_environment({1, 1, 1}), sky_with_patch(512, 1)}) {
        for (const float z : {2.0f, 3.0f})
            EXPECT_EQ(sampled(even, {across_z(1, 1, 2, 0)}, {0, 0, z, 0}).mean, 0) << z;
        // As near as floats are, even samples go along it, others to half of all directions.
        for (const double depth : {1e-6, 1e-30, 1e-43}) {
            const Sampled half = sampled(even, {across_z(1, 1, depth, 0)}, {0, 0, 0, 0});
            EXPECT_TRUE(std::isfinite(half.mean)) << depth;
            if (even.width > 0 && depth > 1e-38) // else it may be rounded to 0
                EXPECT_NEAR(half.mean, 2 * PI, 0.2) << depth;
        }
    }
}

TEST(RectifiedSky, HoldsHalfOfTheLight) {
    Environment sky = sky_with_patch(512, 1);
    sky.portals = {across_z(1, 1, 2, 0), across_z(2, 1, 1, 0)};
    rectify_sky(sky);
    ASSERT_EQ(sky.portal_sums.size(), size_t(RECTIFIED_SUMS)); // both face the same way
    EXPECT_EQ(sky.portals[1].first_sum, 0u);
    EXPECT_NEAR(double(sky.portals[0].corner.w) * double(sky.portal_sums.back()), 2 * PI, 5e-3);
}
