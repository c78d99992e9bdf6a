// SPDX-License-Identifier: Apache-2.0
// Furnaces: surroundings of equal radiance, in which every material shows its albedo and nothing else.
#include "probes/closed_forms.h"
#include "probes/reference.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr int NO_ROULETTE = 65535;

/// What closed furnaces need, together: long paths, for which the small program is the fast one.
constexpr EffectMask CLOSED_EFFECTS =
    EFFECT_AREA_LIGHT | EFFECT_MATTE | EFFECT_MIRROR | EFFECT_REFRACTION | EFFECT_INTERREFLECTION;

/// A closed space of emitting and reflecting walls around the camera.
class ClosedFurnace : public TestScene {
public:
    ClosedFurnace(double reflectance, double emission) {
        const auto grey = [](double x) { return std::to_string(x); };
        build.material("wall", "Kd " + grey(reflectance) + "\nKe " + grey(emission));
        build.use("wall");
        look({0.1, 0.2, 0.7}, {0.2, -0.1, -0.5}, 70);
        options.transport.roulette_depth = NO_ROULETTE;
        shared_effects = CLOSED_EFFECTS;
    }
};

/// A floor of one material, white light from everywhere, and a view at a given cosine and azimuth (from the x
/// axis).
class FloorUnderSky : public TestScene {
public:
    FloorUnderSky(const std::string& keys, double cos_o, double azimuth = 0) {
        build.material("m", keys).use("m");
        build.textured_quad({{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}});
        const double sin_o = std::sqrt(1 - cos_o * cos_o);
        look_at_point({2 * sin_o * std::cos(azimuth), 2 * cos_o, -2 * sin_o * std::sin(azimuth)}, {0, 0, 0});
        options.light.environment = glm::dvec3(1);
    }
};

/// What the tables of scattering/albedo.h are off by: for round lobes, for stretched ones, for glass.
constexpr double TABLE_ERROR = 1e-3, STRETCHED_ERROR = 6e-3, GLASS_ERROR = 6e-3;

/// Mean over the hemisphere, weighted by the cosine, of a loss that depends on the cosine.
template <class Loss>
double hemispherical_mean(const Loss& loss) {
    constexpr int STEPS = 24;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double cosine = (i + 0.5) / STEPS;
        sum += loss(cosine) * 2 * cosine / STEPS;
    }
    return sum;
}

double stretched_mean_loss(double alpha_x, double alpha_y) {
    return hemispherical_mean([&](double cosine) {
        double sum = 0;
        for (const double turn : {0.125, 0.375, 0.625, 0.875})
            sum += 1 - rough_reflection_albedo({alpha_x, alpha_y, cosine, turn * PI / 2},
                                               [](double) { return 1.0; });
        return sum / 4;
    });
}

/// What one facet of a lossless mirror does not send on.
double mean_loss(double alpha) {
    return hemispherical_mean([&](double cosine) {
        return 1 - rough_reflection_albedo({alpha, alpha, cosine, 0}, [](double) { return 1.0; });
    });
}

double glass_mean_loss(double alpha, double eta) {
    return hemispherical_mean([&](double cosine) {
        const RoughSurface surface{alpha, alpha, cosine, 0};
        return 1 - rough_transmission_albedo(surface, eta) -
               rough_reflection_albedo(surface, [&](double c) { return fresnel_reflectance(c, eta); });
    });
}

/// The colour of light that facets of mean reflectance f reflect more than once (Kulla and Conty 2017).
double multiple_colour(double f, double loss) {
    return f * f * (1 - loss) / (1 - f * loss);
}

/// The albedo by BSDF sampling alone, and with light sampling of a map on top.
void expect_albedo(const std::string& keys, double cos_o, double expected, double azimuth = 0,
                   double error = 0) {
    SCOPED_TRACE(keys + ", cosine " + std::to_string(cos_o));
    FloorUnderSky constant(keys, cos_o, azimuth);
    EXPECT_TRUE(agrees(film_estimate(constant.render().film), expected, 2e-3, 1e-5 + TABLE_ERROR + error));

    FloorUnderSky mapped(keys, cos_o, azimuth);
    mapped.texture("ones.exr", 8, 4, 3, std::vector<float>(8 * 4 * 3, 1.0f));
    mapped.options.light.environment.reset();
    mapped.options.light.environment_file = mapped.folder.file("ones.exr");
    EXPECT_TRUE(agrees(film_estimate(mapped.render().film), expected, 3e-3, 1e-5 + TABLE_ERROR + error))
        << "with a map";
}

} // namespace

TEST(Furnace, PathsOfAtMostNSegmentsGiveTheirPartialSum) {
    ClosedFurnace scene(0.5, 0.5);
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    for (const int depth : {1, 2, 3, 5, 32}) {
        scene.options.transport.max_depth = depth;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 1 - std::ldexp(1.0, -depth))) << depth;
    }
}

TEST(Furnace, EveryPartOfAnIcosphereHasTheSameRadiance) {
    ClosedFurnace scene(0.5, 0.5);
    scene.build.icosphere({0, 0, 0}, 1, 2, Facing::INWARD);
    scene.options.transport.max_depth = 32;
    const Film film = scene.render().film;
    for (int y = 0; y < 16; y += 4)
        for (int x = 0; x < 16; x += 4)
            for (int c = 0; c < 3; ++c)
                EXPECT_TRUE(agrees(film_estimate(film, c, {x, y, x + 4, y + 4}), 1)) << x << "," << y;
}

TEST(Furnace, TheOtherIntegratorsStopAfterOneBounce) {
    ClosedFurnace scene(0.5, 0.5);
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    scene.shared_effects = 0; // the programs of the other tests
    for (const Integrator integrator : {Integrator::WHITTED, Integrator::RAYCAST}) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.75, 4e-3)) << name_of(integrator);
    }
}

TEST(Furnace, RouletteEndsPathsWithoutChangingTheMean) {
    ClosedFurnace scene(0.9, 0.1);
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    scene.options.transport.max_depth = 1000;
    scene.options.sampling.spp = 512;
    for (const int start : {1, 5}) {
        scene.options.transport.roulette_depth = start;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 1, 5e-3)) << start;
    }
}

TEST(Furnace, RouletteLeavesPathsAloneThatWeighAQuarter) {
    // Half of the light is lost at every vertex: after the second a quarter is left, after the third less.
    ClosedFurnace scene(0.5, 0.5);
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    for (const int depth : {3, 4}) {
        scene.options.transport.max_depth = depth;
        scene.options.transport.roulette_depth = NO_ROULETTE;
        const Estimate whole = film_estimate(scene.render().film);
        scene.options.transport.roulette_depth = 1;
        const Estimate ended = film_estimate(scene.render().film);
        EXPECT_EQ(ended.mean == whole.mean, depth == 3) << ended.mean << " " << whole.mean;
    }
}

TEST(Furnace, RouletteIsIndependentOfTheChoiceOfLobe) {
    // A matte lobe that is reddish and a mirror that is bluish: each channel's sum is Ke / (1 - Kd - Ks).
    TestScene scene;
    scene.build.material("wall", "Kd 0.6 0.2 0.1\nKs 0.2 0.2 0.5\nillum 3\nKe 0.2 0.6 0.4").use("wall");
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    scene.look({0.1, 0.2, 0.7}, {0.2, -0.1, -0.5}, 70);
    scene.options.transport.max_depth = 1000;
    scene.options.transport.roulette_depth = 1;
    const Film film = scene.render().film;
    for (const int channel : {0, 1, 2})
        EXPECT_TRUE(agrees(film_estimate(film, channel), 1, 5e-3)) << channel;
}

TEST(Furnace, ThingsInsideCannotBeSeen) {
    ClosedFurnace scene(0.5, 0.5);
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    scene.build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3").material("glass", "Ni 1.5\nillum 7");
    scene.build.use("mirror").box({-0.6, -0.6, -0.6}, {-0.2, -0.2, -0.2});
    scene.build.use("glass").icosphere({0.3, 0, -0.2}, 0.3, 2);
    scene.options.transport.max_depth = 64;
    const Film film = scene.render().film;
    for (int y = 0; y < 16; y += 4)
        for (int x = 0; x < 16; x += 4)
            EXPECT_TRUE(agrees(film_estimate(film, 0, {x, y, x + 4, y + 4}), 1)) << x << "," << y;
}

TEST(Furnace, LosslessBodiesReturnAllLight) {
    const char* const materials[] = {
        "Kd 1 1 1",
        "Kd 0 0 0\nKs 1 1 1\nillum 3",
        "Kd 0 0 0\nKs 1 1 1\nillum 5",
        "Kd 1 1 1\nPm 1\nPr 0",
        "Kd 0.4 0.4 0.4\nKs 0.6 0.6 0.6\nillum 3",
        "Ni 1.5\nillum 7",
        "Ni 2.417\nillum 7",
        "Ni 1\nillum 7",
        "Ni 0.8\nillum 7",
    };
    for (const char* keys : materials)
        for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED}) {
            TestScene scene;
            scene.build.material("m", keys).use("m").box({-1, -1, -1},
                                                         {1, 1, 1}); // a box of glass traps no ray
            scene.options.light.environment = glm::dvec3(1);
            scene.options.transport.integrator = integrator;
            scene.options.transport.max_depth = 64;
            scene.options.transport.min_contribution = 0;
            scene.options.sampling.spp = 64;
            scene.options.scene.mtl = MtlReading::PLAIN; // Ni 1 is glass that bends nothing
            scene.look({3, 4, 5}, {0, 0, 0}, 10);
            EXPECT_TRUE(agrees(film_estimate(scene.render().film), 1, 1e-5))
                << keys << ", " << name_of(integrator);
        }
}

TEST(Furnace, RoughMirrorsReflectMoreThanOnce) {
    for (const double pr : {0.4, 0.7, 1.0})
        for (const double cos_o : {0.25, 0.9}) {
            const double alpha = pr * pr;
            const double once = rough_reflection_albedo({alpha, alpha, cos_o, 0}, [](double) { return 1.0; });
            const double albedo = 0.8 * once + multiple_colour(0.8, mean_loss(alpha)) * (1 - once);
            expect_albedo("Kd 0 0 0\nKs 0.8 0.8 0.8\nillum 3\nPr " + std::to_string(pr), cos_o, albedo);
        }
}

TEST(Furnace, StretchedHighlightsDependOnTheDirectionOfTheView) {
    // One facet reflects 0.5 F; more facets add the more, the more of them there are, and the darker the
    // colour.
    const double alpha = 0.36, aspect = std::sqrt(1 - 0.9 * 0.8), cos_o = 0.35, ks = 0.5;
    const std::string keys = "Kd 0 0 0\nKs 0.5 0.5 0.5\nillum 3\nPr 0.6\naniso 0.8";
    const double more = multiple_colour(ks, stretched_mean_loss(alpha / aspect, alpha * aspect));
    double albedo[2];
    for (const int across : {0, 1}) {
        const double azimuth = across * PI / 2;
        const RoughSurface surface{alpha / aspect, alpha * aspect, cos_o, azimuth};
        const double once = rough_reflection_albedo(surface, [](double) { return 1.0; });
        albedo[across] = ks * once + more * (1 - once);
        expect_albedo(keys, cos_o, albedo[across], azimuth, STRETCHED_ERROR);
    }
    EXPECT_GT(std::abs(albedo[1] - albedo[0]), 2 * STRETCHED_ERROR)
        << "or the test could not tell them apart";
}

TEST(Furnace, MatteAndRoughLobesAddUp) {
    const double cos_o = 0.6;
    const RoughSurface by_ns{std::sqrt(2.0 / 22), std::sqrt(2.0 / 22), cos_o, 0};
    const double once = rough_reflection_albedo(by_ns, [](double) { return 1.0; });
    expect_albedo("Kd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 20\nillum 2", cos_o,
                  0.3 + 0.5 * once + multiple_colour(0.5, mean_loss(by_ns.alpha_x)) * (1 - once));

    // Below Fresnel's reflection the matte lobe gets what is left.
    const auto schlick = [](double cosine) { return 0.04 + 0.96 * std::pow(1 - cosine, 5); };
    const RoughSurface by_pr{0.25, 0.25, cos_o, 0};
    const double lost = 1 - rough_reflection_albedo(by_pr, [](double) { return 1.0; });
    const double above = rough_reflection_albedo(by_pr, schlick) +
                         multiple_colour(0.04 + 0.96 / 21, mean_loss(by_pr.alpha_x)) * lost;
    expect_albedo("Kd 0.6 0.6 0.6\nPm 0\nPr 0.5", cos_o, above + (1 - above) * 0.6);
}

TEST(Furnace, ARoughBoundaryOfGlassReflectsAndRefracts) {
    // Below the floor is glass that no other side ends, lit by the same sky. Radiance that leaves it for air
    // is compressed by the squared index.
    for (const double cos_o : {0.3, 0.8}) {
        const RoughSurface surface{0.25, 0.25, cos_o, 0};
        const double eta = 1 / 1.5;
        const double reflected =
            rough_reflection_albedo(surface, [&](double cosine) { return fresnel_reflectance(cosine, eta); });
        const double refracted = rough_transmission_albedo(surface, eta);
        // What more facets send on crosses with the mean transmittance of the facets, 1 - F: inside, less is
        // lost.
        const double more = 1 - reflected - refracted, crosses = 1 - 0.5 / (4.08567 + 1.00071 * 1.5);
        const double share = crosses * std::min(1.0, glass_mean_loss(0.25, 1.5) / glass_mean_loss(0.25, eta));
        expect_albedo("Ni 1.5\nillum 7\nPr 0.5", cos_o,
                      reflected + refracted * eta * eta + more * (1 - share + share * eta * eta), 0,
                      GLASS_ERROR);
    }
}

TEST(Furnace, ASmoothBoundaryOfGlassReflectsAndRefracts) {
    for (const double cos_o : {0.2, 0.6, 0.999}) {
        const double eta = 1 / 1.5, f = fresnel_reflectance(cos_o, eta);
        FloorUnderSky scene("Ni 1.5\nillum 7", cos_o);
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), f + (1 - f) * eta * eta)) << cos_o;
        scene.options.transport.integrator = Integrator::WHITTED;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), f + (1 - f) * eta * eta, 1e-5, 1e-5)) << cos_o;
    }
}

TEST(Furnace, ConductorsFollowFresnel) {
    const double eta = 0.6, k = 2.5;
    const std::string keys = fmt::format("eta {}\nk {}\n", eta, k);
    const auto fresnel = [&](double c) { return reference::fresnel_conductor(c, eta, k); };
    double mean = 0;
    for (int i = 0; i < 512; ++i)
        mean += fresnel(std::sqrt((i + 0.5) / 512)) / 512;
    for (const double cosine : {0.05, 0.3, 1.0}) {
        expect_albedo(keys, cosine, fresnel(cosine));
        for (const double roughness : {0.3, 0.8}) {
            const double alpha = roughness * roughness;
            const RoughSurface surface{alpha, alpha, cosine, 0};
            const double lost = 1 - rough_reflection_albedo(surface, [](double) { return 1.0; });
            expect_albedo(keys + fmt::format("Pr {}\n", roughness), cosine,
                          rough_reflection_albedo(surface, fresnel) +
                              multiple_colour(mean, mean_loss(alpha)) * lost);
        }
    }
}

TEST(Furnace, MirrorsWithFresnelFollowSchlick) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED})
        for (const double cos_o : {0.1, 0.5, 0.95}) {
            FloorUnderSky scene("Kd 0 0 0\nKs 0.3 0.3 0.3\nillum 5", cos_o);
            scene.options.transport.integrator = integrator;
            const double expected = 0.3 + 0.7 * std::pow(1 - cos_o, 5);
            EXPECT_TRUE(agrees(film_estimate(scene.render().film), expected, 1e-4, 1e-5)) << cos_o;
        }
}

TEST(Furnace, PhongsHighlightIsNormalisedForALookStraightDown) {
    for (const Integrator integrator : {Integrator::RAYCAST, Integrator::WHITTED}) {
        FloorUnderSky scene("Kd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 7\nillum 2", 1);
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.8)) << name_of(integrator);
    }
}

TEST(Furnace, LampsBelowACoatAreDimmerTheMoreAslantTheyAreSeen) {
    const auto left = [](double cosine) { return 1 - 0.8 * (0.04 + 0.96 * std::pow(1 - cosine, 5)); };
    TestScene scene;
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1\nPc 0.8\nPcr 0.03").use("lamp").floor(600);
    scene.build.material("ceiling", "Kd 0.5 0.5 0.5")
        .use("ceiling")
        .polygon({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    scene.options.light.environment = glm::dvec3(0);
    scene.options.transport.max_depth = 1;
    for (const double cosine : {1.0, 0.5, 0.2}) { // coats are never quite smooth: 2e-3
        scene.look_at_point({std::sqrt(1 - cosine * cosine), cosine, 0}, {0, 0, 0});
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), left(cosine), 1e-5, 2e-3)) << cosine;
    }
    // What falls on the ceiling: the mean of (1 - cos)^5 over equal radiance is 1 / 21.
    scene.options.transport.max_depth = 2;
    scene.look_at_point({0.2, 1, 0.5}, {0.2, 2, 0.1});
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.5 * (1 - 0.8 * (0.04 + 0.96 / 21)), 2e-3, 2e-3));
}

} // namespace clrt
