// SPDX-License-Identifier: Apache-2.0
// Where light reaches a coarse smooth mesh: sampling lights, sampling the BSDF, both with their weights, and
// paths from lights see it from the same points.
#include "device/kernel_source.h"
#include "probes/film_estimate.h"
#include "render/kernels.h"
#include "support/render_scene.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

using glm::dvec3;

constexpr double PI = 3.14159265358979323846;

/// Largest standard error of a picture's mean over the mean. With two origins, means are 2 to 5 percent
/// apart.
constexpr double SHARPNESS = 2.5e-3;
/// The same where BSDF sampling alone has to find the lamp by reflection off glass.
constexpr double GLASS_SHARPNESS = 9e-3;

/// The kernels with one technique alone.
class OneTechnique {
public:
    OneTechnique() {
        const KernelFiles files = kernels_under_test();
        const std::string combined = "return emitted * mis_weight(pdf_w, light_pdf_w);";
        write(files, "light", combined, "return (real3)(REAL(0.0));",
              "light.is_delta ? REAL(1.0) : mis_weight(light.pdf_w, eval.pdf_w);", "REAL(1.0);");
        write(files, "bsdf", combined, "return emitted;", "if (!is_seen)\n        return;", "return;");
    }
    std::string light() const { return folder_.file("light"); }
    std::string bsdf() const { return folder_.file("bsdf"); }

private:
    void write(KernelFiles files, const std::string& name, const std::string& hit, const std::string& hit_by,
               const std::string& connection, const std::string& connection_by) {
        std::string& path = files.at("path/connect.h");
        for (const auto& [from, to] : {std::pair{hit, hit_by}, {connection, connection_by}}) {
            const size_t at = path.find(from);
            if (at == std::string::npos)
                throw std::runtime_error("not in path/connect.h: " + from);
            path.replace(at, from.size(), to);
        }
        for (const auto& [file, text] : files) {
            const std::filesystem::path to = folder_.file(name + "/" + file);
            std::filesystem::create_directories(to.parent_path());
            folder_.write(name + "/" + file, text);
        }
    }

    ScratchFolder folder_;
};

const OneTechnique& one_technique() {
    static const OneTechnique kernels;
    return kernels;
}

/// A smooth ball of radius 1 with that many segments around its axis and half as many from pole to pole.
void add_ball(TestScene& scene, int segments) {
    const int rings = segments / 2;
    for (int i = 0; i <= rings; ++i)
        for (int k = 0; k < segments; ++k) {
            const double polar = PI * i / rings, around = 2 * PI * k / segments;
            const dvec3 n(std::sin(polar) * std::cos(around), std::cos(polar),
                          std::sin(polar) * std::sin(around));
            scene.build.raw(
                fmt::format("v {0:.9g} {1:.9g} {2:.9g}\nvn {0:.9g} {1:.9g} {2:.9g}", n.x, n.y, n.z));
        }
    const int count = (rings + 1) * segments;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < segments; ++k) {
            const int a = i * segments + k - count, b = i * segments + (k + 1) % segments - count,
                      c = b + segments, d = a + segments;
            if (i > 0)
                scene.build.raw(fmt::format("f {0}//{0} {1}//{1} {2}//{2}", a, b, c));
            if (i + 1 < rings)
                scene.build.raw(fmt::format("f {0}//{0} {1}//{1} {2}//{2}", a, c, d));
        }
}

/// Where lamps are: beside the ball, within it, or both.
enum class Lamps { BESIDE = 1, INSIDE = 2, BOTH = 3 };

/// What paths by all the balls' materials need, together: a program for each technique.
constexpr EffectMask BALL_EFFECTS = EFFECT_AREA_LIGHT | EFFECT_MATTE | EFFECT_GLOSSY | EFFECT_REFRACTION |
                                    EFFECT_ROUGH_REFRACTION | EFFECT_SMOOTH_NORMALS | EFFECT_LIGHT_TREE |
                                    EFFECT_INTERREFLECTION;

/// A ball and its lamps: one as large as the ball beside it, turned away from the camera, and one across its
/// middle that shines upwards, so near that light sampling takes its solid angle.
class BallAndLamps : public TestScene {
public:
    BallAndLamps(const std::string& material, int segments, Lamps lamps = Lamps::BESIDE) {
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
        if (lamps != Lamps::INSIDE)
            build.polygon({{1.2, -1, 1}, {1.2, 1, 1}, {1.2, 1, -1}, {1.2, -1, -1}});
        if (lamps != Lamps::BESIDE)
            build.polygon({{-0.4, 0, 0.4}, {0.4, 0, 0.4}, {0.4, 0, -0.4}, {-0.4, 0, -0.4}});
        build.material("ball", material).use("ball");
        add_ball(*this, segments);
        options.transport.max_depth = 2;
        options.sampling.spp = 4096;
        look({2.5, 3, 4}, {0.4, 0, 0.2}, 20);
    }
    /// The picture's mean by the path tracer, with the kernels of a folder or its own.
    Estimate by_paths(const std::string& kernels = "") {
        options.transport.integrator = Integrator::PATH;
        options.device.kernels_folder = kernels;
        shared_effects = BALL_EFFECTS;
        return film_estimate(render().film);
    }
    Estimate by(Integrator integrator) {
        options.transport.integrator = integrator;
        options.device.kernels_folder.clear();
        shared_effects = 0;
        return film_estimate(render().film);
    }
};

/// Whether two estimates, each sharp enough, differ by no more than their noise.
testing::AssertionResult agree(const Estimate& a, const Estimate& b, double sharpness = SHARPNESS) {
    const double noise = std::hypot(a.error, b.error);
    if (noise <= sharpness * b.mean &&
        std::abs(a.mean - b.mean) <= LARGEST_Z * noise + RENDER_ROUNDING * b.mean)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << a.mean << " +- " << a.error << " and " << b.mean << " +- "
                                       << b.error << ": ratio " << a.mean / b.mean;
}

} // namespace

TEST(LightOrigin, AllIntegratorsLightAMatteBallAlike) {
    for (const int segments : {4, 8}) {
        BallAndLamps scene("Kd 0.8 0.8 0.8", segments);
        const Estimate combined = scene.by_paths();
        EXPECT_TRUE(agree(scene.by_paths(one_technique().bsdf()), combined)) << segments;
        EXPECT_TRUE(agree(scene.by_paths(one_technique().light()), combined)) << segments;
        for (const Integrator integrator :
             {Integrator::RAYCAST, Integrator::WHITTED, Integrator::DISTRIBUTION, Integrator::BDPT})
            EXPECT_TRUE(agree(scene.by(integrator), combined)) << segments << ", " << name_of(integrator);
    }
}

TEST(LightOrigin, BothTechniquesLightAGlossyBallAlike) {
    for (const char* material : {"Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3\nPr 0.6", "Kd 0.5 0.5 0.5\nPm 0\nPr 0.6"})
        for (const int segments : {4, 8}) {
            BallAndLamps scene(material, segments);
            const Estimate combined = scene.by_paths();
            EXPECT_TRUE(agree(scene.by_paths(one_technique().bsdf()), combined))
                << material << ", " << segments;
            EXPECT_TRUE(agree(scene.by_paths(one_technique().light()), combined))
                << material << ", " << segments;
            EXPECT_TRUE(agree(scene.by(Integrator::BDPT), combined)) << material << ", " << segments;
        }
}

TEST(LightOrigin, BothTechniquesLightARoughGlassBallAlikeOnBothSides) {
    for (const Lamps lamps : {Lamps::BESIDE, Lamps::INSIDE})
        for (const int segments : {4, 8}) {
            BallAndLamps scene("Ni 3\nillum 7\nPr 0.6", segments, lamps);
            const Estimate combined = scene.by_paths();
            EXPECT_TRUE(agree(scene.by_paths(one_technique().bsdf()), combined, GLASS_SHARPNESS))
                << int(lamps) << ", " << segments;
            EXPECT_TRUE(agree(scene.by_paths(one_technique().light()), combined, GLASS_SHARPNESS))
                << int(lamps) << ", " << segments;
        }
}

TEST(LightOrigin, PathsThroughRoughGlassFindTheLampsThatLightSamplingKnows) {
    for (const int segments : {4, 8}) {
        BallAndLamps scene("Ni 1.5\nillum 7\nPr 0.8", segments, Lamps::BOTH);
        scene.options.transport.max_depth = 4;
        EXPECT_TRUE(agree(scene.by_paths(one_technique().bsdf()), scene.by_paths(), GLASS_SHARPNESS))
            << segments;
    }
}

} // namespace clrt
