// SPDX-License-Identifier: Apache-2.0
#include "scene/environment.h"

#include "colour.h"
#include "error.h"
#include "scene/sky_table.h"
#include "scene/sky_texels.h"
#include "scene_support.h"

#include <cmath>
#include <cstring>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace clrt;

namespace {

constexpr double PI = 3.14159265358979323846;

EnvironmentImage black(int width, int height) {
    return {width, height, std::vector<glm::vec3>(size_t(width * height), glm::vec3(0))};
}

/// Luminance of the bilinear lookup, x and y in texels: wraps in x, clamps in y.
double lookup(const EnvironmentImage& image, double x, double y) {
    const double fx = x - 0.5, fy = y - 0.5;
    const int x0 = int(std::floor(fx)), y0 = int(std::floor(fy));
    const auto at = [&](int i, int j) {
        i = (i % image.width + image.width) % image.width;
        j = std::min(std::max(j, 0), image.height - 1);
        return luminance(glm::dvec3(image.texels[size_t(j * image.width + i)]));
    };
    const double a = fx - x0, b = fy - y0;
    return (1 - b) * ((1 - a) * at(x0, y0) + a * at(x0 + 1, y0)) +
           b * ((1 - a) * at(x0, y0 + 1) + a * at(x0 + 1, y0 + 1));
}

} // namespace

TEST(Environment, CellLuminanceIsTheMeanOfTheBilinearLookup) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 2);
    for (const glm::ivec2 size : {glm::ivec2(5, 4), glm::ivec2(1, 1), glm::ivec2(2, 3)}) {
        EnvironmentImage image = black(size.x, size.y);
        for (glm::vec3& texel : image.texels)
            texel = glm::vec3(uniform(random), uniform(random), uniform(random));
        NoticeList notices;
        const std::vector<double> cells = cell_luminance(map_environment(image, 1, 0, notices), 0, size.y);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                // Midpoints on a grid with even n integrate each linear half exactly in x and y.
                constexpr int N = 8;
                double mean = 0;
                for (int j = 0; j < N; ++j)
                    for (int i = 0; i < N; ++i)
                        mean += lookup(image, x + (i + 0.5) / N, y + (j + 0.5) / N) / (N * N);
                EXPECT_NEAR(cells[size_t(y * size.x + x)], mean, 1e-12);
            }
    }
}

TEST(Environment, ProbabilityIsPositiveExactlyWhereTheLookupIs) {
    EnvironmentImage image = black(8, 6);
    image.texels[0] = glm::vec3(100); // top left: its neighbours wrap around in u
    NoticeList notices;
    Environment environment = map_environment(image, 1, 0, notices);
    tabulate_sky(environment, SkySampling::BY_TABLE);
    double sum = 0;
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x) {
            const bool lit = y <= 1 && (x <= 1 || x == 7);
            const double p = texel_probability(environment, x, y);
            EXPECT_EQ(p > 0, lit) << x << "," << y;
            sum += p;
        }
    EXPECT_NEAR(sum, 1, 1e-6);
}

/// A table of texels in proportion to what exceeds so many means, of which dimmer ones have none.
void expect_chosen_by_excess(Environment environment, SkySampling sampling, double means) {
    tabulate_sky(environment, sampling);
    const std::vector<double> cells = cell_luminance(environment, 0, 8);
    double mean = 0, sum = 0;
    for (size_t i = 0; i < cells.size(); ++i)
        mean += cells[i] * texel_solid_angle(int(i) / 12, 12, 8) / (4 * PI);
    const auto weight = [&](size_t i) {
        return std::max(cells[i] - means * mean, 0.0) * texel_solid_angle(int(i) / 12, 12, 8);
    };
    for (size_t i = 0; i < cells.size(); ++i)
        sum += weight(i);
    size_t dim = 0;
    for (size_t i = 0; i < cells.size(); ++i) {
        const double p = texel_probability(environment, int(i) % 12, int(i) / 12);
        const SkyTile& tile = environment.tiles[i / 48 * 3 + i % 12 / 4];
        EXPECT_NEAR(p, weight(i) / sum, double(tile.probability) / SKY_SHARES + 1e-7) << i;
        EXPECT_EQ(p > 0, cells[i] > means * mean) << i;
        dim += p == 0;
    }
    EXPECT_GT(dim, 0u);
    EXPECT_LT(dim, cells.size());
    EXPECT_NEAR(environment.mean_radiance, 3 * mean, 1e-12) << "the light that is left to the BSDF counts";
}

TEST(Environment, BesideBsdfSamplingTexelsAreChosenByWhatExceedsTheMean) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0, 2);
    EnvironmentImage image = black(12, 8);
    for (glm::vec3& texel : image.texels)
        texel = glm::vec3(uniform(random), uniform(random), uniform(random));
    for (const size_t bright : {17u, 50u, 51u})
        image.texels[bright] *= 20;
    NoticeList notices;
    const Environment environment = map_environment(image, 3, 0, notices);
    expect_chosen_by_excess(environment, SkySampling::BY_TABLE_AND_BSDF, 1);
    expect_chosen_by_excess(environment, SkySampling::BRIGHTEST_BY_TABLE, 4);
}

TEST(Environment, OnlyThePathTracerLeavesDimTexelsToTheBsdf) {
    EXPECT_EQ(integrator_row(Integrator::PATH).sky, SkySampling::BY_TABLE_AND_BSDF);
    for (const IntegratorRow& row : INTEGRATOR_ROWS)
        if (row.film == FilmAccess::SPLAT) // no light path may start where the table has nothing
            EXPECT_EQ(row.sky, SkySampling::BY_TABLE) << row.name;
    EXPECT_EQ(integrator_row(Integrator::WHITTED).sky, SkySampling::BY_TABLE);
    EXPECT_EQ(integrator_row(Integrator::RAYCAST).sky, SkySampling::BY_TABLE);
}

TEST(Environment, ATableIsMadeAnewForAnotherSampling) {
    EnvironmentImage image = black(12, 8);
    for (size_t i = 0; i < image.texels.size(); ++i)
        image.texels[i] = glm::vec3(float(1 + i % 7));
    NoticeList notices;
    const Environment loaded = map_environment(image, 1, 0, notices);
    EXPECT_FALSE(loaded.sampling) << "a scene is loaded for any integrator";
    Environment turned = loaded, straight = loaded;
    tabulate_sky(turned, SkySampling::BY_TABLE_AND_BSDF);
    tabulate_sky(turned, SkySampling::BY_TABLE);
    tabulate_sky(straight, SkySampling::BY_TABLE);
    EXPECT_EQ(straight.sampling, SkySampling::BY_TABLE);
    ASSERT_EQ(turned.tiles.size(), straight.tiles.size());
    EXPECT_EQ(
        std::memcmp(turned.tiles.data(), straight.tiles.data(), straight.tiles.size() * sizeof(SkyTile)), 0);
}

TEST(Environment, SolidAnglesSumToTheSphere) {
    for (int height : {1, 2, 7, 512}) {
        double sum = 0;
        for (int row = 0; row < height; ++row)
            sum += 3 * texel_solid_angle(row, 3, height);
        EXPECT_NEAR(sum, 4 * PI, 1e-11);
    }
    EXPECT_NEAR(texel_solid_angle(0, 4, 2), PI / 2, 1e-14);
}

TEST(Environment, AConstantMapIsChosenBySolidAngle) {
    for (const SkySampling sampling :
         {SkySampling::BY_TABLE, SkySampling::BY_TABLE_AND_BSDF, SkySampling::BRIGHTEST_BY_TABLE}) {
        EnvironmentImage image = black(6, 5);
        image.texels.assign(30, glm::vec3(0.5f));
        NoticeList notices;
        Environment environment = map_environment(image, 3, 25, notices);
        tabulate_sky(environment, sampling);
        for (int y = 0; y < 5; ++y) // a share is a part of a tile's light, at most all but the last row
            EXPECT_NEAR(texel_probability(environment, 0, y), texel_solid_angle(y, 6, 5) / (4 * PI),
                        0.7 / SKY_SHARES);
        EXPECT_NEAR(environment.mean_radiance, 1.5, 1e-12);
        EXPECT_EQ(environment.radiance, glm::dvec3(3));
        EXPECT_EQ(environment.rotation_degrees, 25);
        EXPECT_EQ(sky_texel(environment, 0, 0).x, 0.5f) << "the factor is not in the texels";
    }
}

TEST(Environment, BadTexelsBecomeBlackAndAreCounted) {
    EnvironmentImage image = black(3, 2);
    image.texels.assign(6, glm::vec3(1));
    image.texels[1].y = std::numeric_limits<float>::quiet_NaN();
    image.texels[2].x = std::numeric_limits<float>::infinity();
    image.texels[5] = glm::vec3(2, -1, 3);
    NoticeList notices;
    clean_environment(image, "sky.exr", notices);
    EXPECT_EQ(image.texels[1], glm::vec3(0));
    EXPECT_EQ(image.texels[2], glm::vec3(0));
    EXPECT_EQ(image.texels[5], glm::vec3(2, 0, 3));
    EXPECT_EQ(count_notices(notices, "2 texels are NaN or infinite and became black, the first at 1,0"), 1);
    EXPECT_EQ(count_notices(notices, "1 texels have negative channels, which became 0, the first at 2,1"), 1);
}

TEST(Environment, ABlackMapGivesNoLight) {
    NoticeList notices;
    const Environment environment = map_environment(black(4, 2), 1, 0, notices);
    EXPECT_TRUE(environment.texels.empty());
    EXPECT_EQ(environment.width, 0);
    EXPECT_EQ(environment.radiance, glm::dvec3(0));
    EXPECT_EQ(count_notices(notices, "black"), 1);
}

TEST(Environment, AWhiteSkyComesOnlyWithoutAnyLight) {
    LightOptions options;
    NoticeList notices;
    EXPECT_EQ(load_environment(options, false, notices).radiance, glm::dvec3(1));
    EXPECT_EQ(count_notices(notices, "no light in the scene: white sky of radiance 1 (--env 1,1,1)"), 1);

    NoticeList none;
    EXPECT_EQ(load_environment(options, true, none).radiance, glm::dvec3(0));
    options.environment = glm::dvec3(0);
    EXPECT_EQ(load_environment(options, false, none).radiance, glm::dvec3(0))
        << "--env 0,0,0 counts as given";
    options.environment = glm::dvec3(1, 2, 3);
    options.environment_scale = 2;
    EXPECT_EQ(load_environment(options, true, none).radiance, glm::dvec3(2, 4, 6));
    EXPECT_TRUE(none.lines().empty());
}

TEST(Environment, WrongValuesAreUsageErrors) {
    NoticeList notices;
    LightOptions options;
    options.environment = glm::dvec3(1, -1, 0);
    EXPECT_THROW(load_environment(options, false, notices), UsageError);
    options.environment = glm::dvec3(1);
    options.environment_scale = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(load_environment(options, false, notices), UsageError);
}

TEST(Environment, MapsAreReadFromTheTop) {
    const TemporaryFolder folder;
    const std::vector<float> pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9};
    for (const char* name : {"sky.exr", "sky.hdr"}) {
        const EnvironmentImage image =
            read_environment(folder.write_image(name, 2, 2, 3, pixels, OIIO::TypeDesc::FLOAT));
        ASSERT_EQ(image.texels.size(), 4u) << name;
        EXPECT_EQ(image.texels[0], glm::vec3(1, 0, 0)) << name;
        EXPECT_EQ(image.texels[3], glm::vec3(9)) << name;
    }
}

TEST(Environment, PngMapsAreDecodedAndAMissingFileIsASceneError) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> pixels = {188, 255, 0, 0, 0, 0};
    const EnvironmentImage image =
        read_environment(folder.write_image("sky.png", 2, 1, 3, pixels, OIIO::TypeDesc::UINT8));
    EXPECT_NEAR(image.texels[0].x, srgb_to_linear(188 / 255.), 1e-6);
    EXPECT_EQ(image.texels[0].y, 1);
    EXPECT_THROW(read_environment(folder.path("none.exr")), SceneError);
}
