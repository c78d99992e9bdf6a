// SPDX-License-Identifier: Apache-2.0
// Maps in pictures: which way up they lie, how they repeat, and what each of them scales.
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::WHITTED, Integrator::RAYCAST};

/// A quad in the plane z = 0 from (-1, -1) to (1, 1) that faces the camera; u grows to the right and v
/// upwards.
class TexturedQuad : public TestScene {
public:
    explicit TexturedQuad(const std::string& keys) {
        build.material("m", keys).use("m").textured_quad({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
        options.sampling.spp = 64;
    }
    /// The picture's radiance at texture coordinates.
    glm::dvec3 at(double u, double v) {
        const glm::dvec3 point(2 * u - 1, 2 * v - 1, 0);
        look_at_point(point + glm::dvec3(0, 0, 1), point);
        const Film film = render().film;
        return {film_estimate(film, 0).mean, film_estimate(film, 1).mean, film_estimate(film, 2).mean};
    }
};

/// The tolerance is what bilinear mixing changes within the patch that is looked at.
void expect_colour(const glm::dvec3& found, const glm::dvec3& expected, const char* where) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 1e-3) << where << ", channel " << c;
}

/// Two rows of two texels, red and green above blue and white.
const std::vector<unsigned char> FOUR_COLOURS = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};

} // namespace

TEST(TexturedPicture, TheFirstRowOfAPictureLiesOnTop) {
    TexturedQuad scene("Kd 0 0 0\nmap_Ke four.png");
    scene.texture8("four.png", 2, 2, 3, FOUR_COLOURS);
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        expect_colour(scene.at(0.25, 0.75), {1, 0, 0}, "top left");
        expect_colour(scene.at(0.75, 0.75), {0, 1, 0}, "top right");
        expect_colour(scene.at(0.25, 0.25), {0, 0, 1}, "bottom left");
        expect_colour(scene.at(0.75, 0.25), {1, 1, 1}, "bottom right");
    }
}

TEST(TexturedPicture, TexelsAreMixedBilinearlyAndRepeat) {
    TexturedQuad scene("Kd 0 0 0\nmap_Ke four.png");
    scene.texture8("four.png", 2, 2, 3, FOUR_COLOURS);
    expect_colour(scene.at(0.5, 0.75), {0.5, 0.5, 0}, "between the upper two");
    expect_colour(scene.at(0.25, 0.5), {0.5, 0, 0.5}, "between the left two");
    expect_colour(scene.at(0.625, 0.75), {0.25, 0.75, 0}, "a quarter before the upper right");
    expect_colour(scene.at(0.001, 0.75), {0.502, 0.498, 0}, "at the left edge, halfway to the right column");
}

TEST(TexturedPicture, ScaleOffsetAndClampMoveThePicture) {
    {
        TexturedQuad scene("Kd 0 0 0\nmap_Ke -s 2 1 1 four.png");
        scene.texture8("four.png", 2, 2, 3, FOUR_COLOURS);
        expect_colour(scene.at(0.125, 0.75), {1, 0, 0}, "scaled, first column");
        expect_colour(scene.at(0.875, 0.75), {0, 1, 0}, "scaled, fourth column");
    }
    {
        TexturedQuad scene("Kd 0 0 0\nmap_Ke -o 0.5 0 0 four.png");
        scene.texture8("four.png", 2, 2, 3, FOUR_COLOURS);
        expect_colour(scene.at(0.25, 0.75), {0, 1, 0}, "moved by half a picture");
    }
    {
        TexturedQuad scene("Kd 0 0 0\nmap_Ke -s 2 2 1 -clamp on four.png");
        scene.texture8("four.png", 2, 2, 3, FOUR_COLOURS);
        expect_colour(scene.at(0.125, 0.125), {0, 0, 1}, "clamped, inside");
        expect_colour(scene.at(0.01, 0.125), {0, 0, 1}, "clamped, at the edge");
        expect_colour(scene.at(0.75, 0.75), {0, 0, 0}, "clamped, outside");
    }
}

TEST(TexturedPicture, ColoursAreEncodedAndDataIsNot) {
    // sRGB 188 is 0.5028864580 of full light.
    const double decoded = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    TexturedQuad colour("Kd 0.5 1 0.25\nmap_Kd grey.png");
    colour.texture8("grey.png", 1, 1, 1, {188});
    colour.options.light.environment = glm::dvec3(1);
    expect_colour(colour.at(0.5, 0.5), {0.5 * decoded, decoded, 0.25 * decoded}, "colour");

    TexturedQuad linear("Kd 0.5 1 0.25\nmap_Kd grey.exr");
    linear.texture("grey.exr", 1, 1, 1, {0.3f});
    linear.options.light.environment = glm::dvec3(1);
    expect_colour(linear.at(0.5, 0.5), {0.15, 0.3, 0.075}, "colour of floats");

    TexturedQuad coverage("Kd 0 0 0\nKe 1 1 1\nmap_d half.png");
    coverage.texture8("half.png", 1, 1, 1, {188});
    coverage.options.sampling.spp = 4096;
    EXPECT_NEAR(coverage.at(0.5, 0.5).x, 188 / 255.0, 3e-3) << "data";
}

TEST(TexturedPicture, MapsOfReflectionScaleItsColourAndRoughness) {
    TexturedQuad mirror("Kd 0 0 0\nKs 0.5 0.5 0.5\nmap_Ks four.exr\nillum 3");
    mirror.texture("four.exr", 1, 1, 3, {0.2f, 0.4f, 0.8f});
    mirror.options.light.environment = glm::dvec3(1);
    expect_colour(mirror.at(0.5, 0.5), {0.1, 0.2, 0.4}, "map_Ks");

    // alpha = (Pr map)^2 = 0.16
    TexturedQuad rough("Kd 0 0 0\nKs 0.5 0.5 0.5\nPr 0.8\nmap_Pr half.exr\nillum 3");
    rough.texture("half.exr", 1, 1, 1, {0.5f});
    rough.options.light.environment = glm::dvec3(1);
    rough.options.sampling.spp = 1024;
    const RoughSurface surface{0.16, 0.16, 0.3, 0};
    rough.look_at_point({std::sqrt(1 - 0.09), 0, 0.3}, {0, 0, 0});
    // Beside one facet's reflection that of more (Kulla and Conty 2017), by the mean loss; 1e-3: its table.
    const auto once = [](double cosine) {
        return rough_reflection_albedo({0.16, 0.16, cosine, 0}, [](double) { return 1.0; });
    };
    double lost = 0;
    for (double cosine = 0.025; cosine < 1; cosine += 0.05)
        lost += (1 - once(cosine)) * 2 * cosine * 0.05;
    const auto more = [&](double f) {
        return f * f * (1 - lost) / (1 - f * lost) * (1 - once(surface.cos_o));
    };
    EXPECT_TRUE(
        agrees(film_estimate(rough.render().film), 0.5 * once(surface.cos_o) + more(0.5), 1e-3, 1e-3));

    // Half metal: F0 = mix(0.04, Kd, 0.5), matte Kd / 2 of what the reflection leaves.
    TexturedQuad metal("Kd 0.6 0.6 0.6\nPm 1\nmap_Pm half.exr\nPr 0.4");
    metal.texture("half.exr", 1, 1, 1, {0.5f});
    metal.options.light.environment = glm::dvec3(1);
    metal.options.sampling.spp = 1024;
    metal.look_at_point({std::sqrt(1 - 0.09), 0, 0.3}, {0, 0, 0});
    const auto schlick = [](double cosine) { return 0.32 + 0.68 * std::pow(1 - cosine, 5); };
    const double above = rough_reflection_albedo(surface, schlick) + more(0.32 + 0.68 / 21);
    EXPECT_TRUE(agrees(film_estimate(metal.render().film), above + 0.3 * (1 - above), 2e-3, 1e-3));
}

TEST(TexturedPicture, ALampWithAMapGivesTheLightOfItsTexels) {
    // Radiance along u by bilinear mixing of two texels, 0 and 2, that repeat: a triangle wave.
    TestScene scene;
    scene.texture("two.exr", 2, 1, 1, {0, 2});
    scene.build.material("matte", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nmap_Ke two.exr");
    scene.build.use("matte").floor(9).use("lamp");
    scene.build.textured_quad({{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}});
    double irradiance = 0;
    const int strips = 512;
    for (int i = 0; i < strips; ++i) {
        const double u = (i + 0.5) / strips, x0 = -1 + 2.0 * i / strips, x1 = x0 + 2.0 / strips;
        const double away = std::abs(u - 0.75), radiance = 2 * (1 - std::min(away, 1 - away) / 0.5);
        irradiance += radiance * polygon_irradiance({0.8, 0, 0}, {0, 1, 0},
                                                    {{x0, 1, -1}, {x1, 1, -1}, {x1, 1, 1}, {x0, 1, 1}});
    }
    scene.look_at_point({3, 0.8, 0.4}, {0.8, 0, 0});
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.5 * irradiance / PI, 3e-3, 1e-4))
            << name_of(integrator);
    }
}

} // namespace clrt
