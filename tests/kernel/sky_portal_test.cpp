// SPDX-License-Identifier: Apache-2.0
// lights/sky_portal.h: samples through portals have the density that is said of them, and cover the solid
// angle of the portals.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "support/test_device.h"

#include <cmath>
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
            "second.x = (float)sky_pdf_w(scene, params, &view, s.wi, (real2)(REAL(0.0)));");
        return made;
    }();
    return instance;
}

/// A rectangle of width x height across z at z = depth, about the axis, that is seen from lower z.
SkyPortal across_z(double width, double height, double depth, double x, double brightness) {
    return {{float(x - width / 2), float(-height / 2), float(depth), float(brightness)},
            {float(width), 0, 0, float(1 / (width * width))},
            {0, float(height), 0, float(1 / (height * height))},
            {0, 0, -1, float(width * height)}};
}

double solid_angle(double width, double height, double depth) {
    const double a = width / (2 * depth), b = height / (2 * depth);
    return 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
}

struct Sampled {
    double mean = 0, error = 0; ///< of 1 / density
    double worst = 0;           ///< relative difference of both densities
    double left = 0;            ///< share with negative x
};

Sampled sampled(const std::vector<SkyPortal>& portals, const vec4& position) {
    Scene scene;
    scene.environment.portals = portals;
    RenderParams params{};
    params.environment = {1, 1, 1, 0};
    params.choose_environment = 1;
    params.portal_count = u32(portals.size());
    params.portal_share = 1;
    Random random(3);
    std::vector<vec4> a, b;
    for (int i = 0; i < 20000; ++i) {
        const u32 word = random.word(), alias = random.word();
        a.push_back(position);
        b.push_back({bits_to_float(word), bits_to_float(alias), float(random.unit()), 0});
    }
    const SceneProbe::Outputs out = probe().run("sample", scene, params, a, b);
    Sampled result;
    double squares = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double pdf = double(out.first[i].w), x = pdf > 0 ? 1 / pdf : 0;
        result.mean += x / double(a.size());
        squares += x * x / double(a.size());
        result.worst = std::max(result.worst, std::abs(double(out.second[i].x) - pdf));
        result.left += out.first[i].x < 0 ? 1 / double(a.size()) : 0;
    }
    result.error = std::sqrt((squares - result.mean * result.mean) / double(a.size()));
    return result;
}

} // namespace

TEST(SkyPortal, SamplesCoverItsSolidAngle) {
    for (const double depth : {0.2, 1.0, 30.0}) {
        const Sampled one = sampled({across_z(1, 2, depth, 0, 1)}, {0, 0, 0, 0});
        EXPECT_NEAR(one.mean / solid_angle(1, 2, depth), 1, 5 * one.error / one.mean + 1e-5) << depth;
        EXPECT_EQ(one.worst, 0) << depth;
    }
}

TEST(SkyPortal, SeveralAreOneMixture) {
    // Two windows, and a brighter one behind the first: what both show is covered once.
    const SkyPortal left = across_z(1, 1, 2, -1.5, 1), right = across_z(1, 1, 2, 1.5, 3);
    const SkyPortal behind = across_z(1.5, 1.5, 3, -2.25, 2);
    const Sampled two = sampled({left, right}, {0, 0, 0, 0});
    const Sampled three = sampled({left, right, behind}, {0, 0, 0, 0});
    EXPECT_NEAR(two.left, 0.25, 0.015); // by brightness
    EXPECT_NEAR(two.mean, three.mean, 5 * std::hypot(two.error, three.error));
    EXPECT_EQ(three.worst, 0);
}

TEST(SkyPortal, IsNotSeenFromBehind) {
    EXPECT_EQ(sampled({across_z(1, 1, 2, 0, 1)}, {0, 0, 3, 0}).mean, 0);
}
