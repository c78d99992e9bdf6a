// SPDX-License-Identifier: Apache-2.0
// lights/environment.h, environment_sample.h, path/sky.h: orientation, lookup and rotation of lat-long maps,
// and directions sampled by texels.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"
#include "scene/environment.h"
#include "scene/sky_table.h"
#include "scene/sky_texels.h"
#include "support/test_device.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <set>

using namespace clrt;
using glm::dvec3;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"path/sky.h"});
        made.add("uv", "const real2 uv = environment_uv(environment_to_map(params, vector_from(a)));"
                       "first = (vec4)(uv.x, uv.y, 0.0f, 0.0f);");
        made.add("turn", "first = probe_vec4(environment_to_world(params, vector_from(a)), REAL(0.0));"
                         "second = probe_vec4(environment_to_map(params, vector_from(first)), REAL(0.0));");
        made.add("eval", "first = probe_vec4(environment_eval(scene, params, vector_from(a)), REAL(0.0));"
                         "first.w = params->environment_width ? environment_map_pdf_w(scene, params, "
                         "vector_from(a)) : 0;");
        made.add("texel", "const SkyColor c = environment_texel(scene, params->environment_format, "
                          "environment_texel_number(params, as_uint(a.x), as_uint(a.y)));"
                          "first = (vec4)((float)c.red, (float)c.green, (float)c.blue, 0.0f);");
        // As "sample", but in place b.x of b.y paths that draw together, the others by other words.
        made.add("lanes", "SkyLanes lanes; const uint place = as_uint(b.x); const uint count = as_uint(b.y);"
                          "for (uint i = 0; i < count || i % DEVICE_LANES != 0u; ++i) {"
                          "  PathNumbers numbers;"
                          "  numbers.light = (uint2)(as_uint(a.x) + (i - place) * 0x9e3779b9u, as_uint(a.w));"
                          "  numbers.alias = as_uint(a.y) ^ (i - place);"
                          "  sky_set_numbers(&lanes, i, &numbers);"
                          "}"
                          "sky_draw(scene, params, &lanes, count);"
                          "const SkySample drawn = sky_of(&lanes, place);"
                          "const LightSample s = environment_drawn(&drawn);"
                          "first = probe_vec4(s.wi, s.pdf_w);"
                          "second = probe_vec4(s.radiance, s.is_distant ? 1.0f : 0.0f);");
        made.add("solid_angle", "first.x = environment_texel_solid_angle(params, as_uint(a.x));");
        // a: words and the second number; b: shading normal
        made.add(
            "sample",
            "const LightSample s = environment_sample(scene, params, vector_from(b), as_uint(a.x), "
            "as_uint(a.y), a.z);"
            "first = probe_vec4(s.wi, s.pdf_w); second = probe_vec4(s.radiance, s.is_distant ? 1.0f : 0.0f);"
            "second.w += s.is_delta ? 2.0f : 0.0f;"
            "third.x = params->environment_width ? environment_map_pdf_w(scene, params, s.wi) : 0.0f;"
            "third.yzw = convert_float3(environment_eval(scene, params, s.wi));");
        return made;
    }();
    return instance;
}

RenderParams params_of(const Environment& environment) {
    RenderParams params{};
    params.environment = to_vec4(environment.radiance);
    params.environment_width = environment.texels.empty() ? 0 : u32(environment.width);
    params.environment_format = environment.texel_format;
    params.environment_height = environment.texels.empty() ? 0 : u32(environment.height);
    params.environment_cos = float(std::cos(environment.rotation_degrees * PI / 180));
    params.environment_sin = float(std::sin(environment.rotation_degrees * PI / 180));
    return params;
}

SceneProbe::Outputs run(const char* name, const Environment& environment, const std::vector<vec4>& a,
                        const std::vector<vec4>& b = {}) {
    Scene scene;
    scene.environment = environment;
    return probe().run(name, scene, params_of(environment), a, b);
}

/// A sky of random radiance with a few texels a hundred times brighter, and black ones.
EnvironmentImage random_image(int width, int height) {
    Random random(u32(width + height));
    EnvironmentImage image{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
        const double size = i % 7 == 3 ? 0 : i % 31 == 0 ? 100 : 1;
        const double r = size * random.unit(), g = size * random.unit();
        image.texels.emplace_back(float(r), float(g), float(size * random.unit()));
    }
    return image;
}

Environment map_of(const EnvironmentImage& image, double factor = 1, double rotation = 0,
                   SkySampling sampling = SkySampling::BY_TABLE) {
    NoticeList notices;
    Environment map = map_environment(image, factor, rotation, notices);
    tabulate_sky(map, sampling);
    return map;
}

/// The definition: u = 0.5 + atan2(z, x) / (2 pi), v = angle from +Y over pi, after turning back about +Y.
glm::dvec2 reference_uv(const Environment& environment, const dvec3& d) {
    const double angle = std::atan2(d.z, d.x) + environment.rotation_degrees * PI / 180;
    double u = 0.5 + angle / (2 * PI);
    u -= std::floor(u);
    return {u, std::atan2(std::hypot(d.x, d.z), d.y) / PI};
}

/// Bilinear lookup in double: wraps around in u, repeats the border row in v.
dvec3 reference_eval(const Environment& environment, const dvec3& d) {
    const glm::dvec2 uv = reference_uv(environment, d);
    const double x = uv.x * environment.width - 0.5, y = uv.y * environment.height - 0.5;
    dvec3 sum(0);
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const double fx = x - std::floor(x), fy = y - std::floor(y);
            const int column = (int(std::floor(x)) + dx + environment.width) % environment.width;
            const int row = std::clamp(int(std::floor(y)) + dy, 0, environment.height - 1);
            sum += (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy) * dvec3(sky_texel(environment, column, row));
        }
    return sum * environment.radiance;
}

std::vector<vec4> random_directions(size_t count, u32 seed) {
    Random random(seed);
    std::vector<vec4> directions;
    for (size_t i = 0; i < count; ++i)
        directions.push_back(to_vec4(random.direction()));
    return directions;
}

/// Words and second numbers for samples; the words are only moved, so that those which are NaN as floats stay
/// what they are.
std::vector<vec4> random_numbers(size_t count, u32 seed) {
    Random random(seed);
    std::vector<vec4> numbers;
    for (size_t i = 0; i < count; ++i) {
        const u32 word = random.word(), alias = random.word();
        numbers.push_back({bits_to_float(word), bits_to_float(alias), float(random.unit()), 0});
    }
    return numbers;
}

double luminance(const dvec3& rgb) {
    return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

/// Expects directions to be chosen by the stored probabilities, uniformly within each texel.
void expect_stored_probabilities(const Environment& map) {
    constexpr size_t SAMPLES = 400000;
    constexpr int PARTS = 3; // of a texel along each side
    const std::vector<vec4> got = run("sample", map, random_numbers(SAMPLES, 3)).first;
    std::vector<double> counts(size_t(map.width * map.height * PARTS * PARTS)), expected;
    for (int i = 0; i < map.width * map.height * PARTS * PARTS; ++i) {
        const int texel = i / (PARTS * PARTS);
        expected.push_back(SAMPLES * texel_probability(map, texel % map.width, texel / map.width) /
                           (PARTS * PARTS));
    }
    for (const vec4& sample : got) {
        const dvec3 d = to_dvec3(sample);
        ASSERT_NEAR(glm::length(d), 1, 8 * FLOAT_U);
        const glm::dvec2 uv = reference_uv(map, d);
        const double x = uv.x * map.width;
        const int column = std::min(int(x), map.width - 1),
                  row = std::min(int(uv.y * map.height), map.height - 1);
        // Uniform over the texel's solid angle: in u and in the cosine.
        const double top = std::cos(PI * row / map.height), bottom = std::cos(PI * (row + 1) / map.height);
        const int across = std::min(int((x - column) * PARTS), PARTS - 1);
        const int down = std::clamp(int((d.y - top) / (bottom - top) * PARTS), 0, PARTS - 1);
        ++counts[(size_t(row * map.width + column) * PARTS + size_t(down)) * PARTS + size_t(across)];
    }
    // A rounding may cross into a texel that is never chosen: not more than one sample in ten thousand.
    double strays = 0;
    for (size_t i = 0; i < counts.size(); ++i)
        if (expected[i] == 0) {
            strays += counts[i];
            counts[i] = 0;
        }
    EXPECT_LE(strays, SAMPLES * 1e-4);
    EXPECT_GT(chi_squared_test(counts, expected).p_value, SMALLEST_P);
}

} // namespace

TEST(EnvironmentMap, DirectionsReadTheirPlaceInTheMap) {
    const Environment map = map_of(random_image(8, 4));
    const std::vector<vec4> d = {{0, 1, 0, 0}, {0, -1, 0, 0}, {1, 0, 0, 0},
                                 {0, 0, 1, 0}, {0, 0, -1, 0}, {-1, 0, -1e-6f, 0}};
    const std::vector<vec4> uv = run("uv", map, d).first;
    EXPECT_NEAR(uv[0].y, 0, 1e-6); // up: the top row
    EXPECT_NEAR(uv[1].y, 1, 1e-6);
    EXPECT_NEAR(uv[2].x, 0.5, 1e-6); // +x: the middle of the map
    EXPECT_NEAR(uv[3].x, 0.75, 1e-6);
    EXPECT_NEAR(uv[4].x, 0.25, 1e-6);
    EXPECT_NEAR(uv[5].x, 0, 1e-5);
    for (const size_t i : {2, 3, 4, 5})
        EXPECT_NEAR(uv[i].y, 0.5, 1e-6);
}

TEST(EnvironmentMap, RotationTurnsTheSkyAboutTheYAxis) {
    // By the right-hand rule: what was seen at +x is seen at -z after a quarter turn.
    const Environment quarter = map_of(random_image(8, 4), 1, 90);
    const vec4 turned = run("turn", quarter, {{1, 0, 0, 0}}).first[0];
    EXPECT_LE(glm::length(to_dvec3(turned) - dvec3(0, 0, -1)), 1e-6);
    EXPECT_NEAR(run("uv", quarter, {{0, 0, -1, 0}}).first[0].x, 0.5, 1e-6);
    for (const double degrees : {0.0, 33.0, 180.0, -77.0}) {
        const Environment map = map_of(random_image(8, 4), 1, degrees);
        const std::vector<vec4> d = random_directions(10000, 1);
        const SceneProbe::Outputs got = run("turn", map, d);
        const std::vector<vec4> uv = run("uv", map, d).first;
        for (size_t i = 0; i < d.size(); ++i) {
            ASSERT_LE(glm::length(to_dvec3(got.second[i]) - to_dvec3(d[i])), 8 * FLOAT_U);
            const glm::dvec2 exact = reference_uv(map, to_dvec3(d[i]));
            const double du = std::abs(uv[i].x - exact.x), sine = std::hypot(double(d[i].x), double(d[i].z));
            ASSERT_LE(std::min(du, 1 - du) * sine, 1e-6) << degrees;
            ASSERT_NEAR(uv[i].y, exact.y, 1e-6) << degrees;
        }
    }
}

TEST(EnvironmentMap, TexelsCoverTheSphere) {
    for (const int height : {1, 2, 7, 64, 4096}) {
        Environment map;
        map.width = 2 * height;
        map.height = height;
        map.texels.resize(1); // only the size is read
        std::vector<vec4> rows;
        for (int row = 0; row < height; ++row)
            rows.push_back({bits_to_float(u32(row)), 0, 0, 0});
        double sum = 0;
        const std::vector<vec4> got = run("solid_angle", map, rows).first;
        for (int row = 0; row < height; ++row) {
            const double exact =
                PI / height * (std::cos(PI * row / height) - std::cos(PI * (row + 1) / height));
            ASSERT_NEAR(got[size_t(row)].x / exact, 1, 2e-6) << row << " of " << height;
            sum += double(got[size_t(row)].x) * map.width;
        }
        EXPECT_NEAR(sum / (4 * PI), 1, 1e-6) << height;
    }
}

TEST(EnvironmentMap, LookupsAreBilinear) {
    for (const auto& [width, height] :
         {std::pair{16, 8}, std::pair{2, 1}, std::pair{1, 1}, std::pair{100, 50}}) {
        const Environment map = map_of(random_image(width, height), 2.5, 20);
        const std::vector<vec4> d = random_directions(20000, 2);
        const std::vector<vec4> got = run("eval", map, d).first;
        for (size_t i = 0; i < d.size(); ++i) {
            // Neighbours differ by 250 at most; coordinates are off by 1e-6 of the map, more next to the
            // poles.
            const double sine = std::hypot(double(d[i].x), double(d[i].z));
            ASSERT_LE(glm::length(to_dvec3(got[i]) - reference_eval(map, to_dvec3(d[i]))),
                      250 * 2e-6 * width / sine + 1e-4)
                << width << "x" << height;
        }
    }
}

TEST(EnvironmentMap, TexelsReadTheSameInEveryForm) {
    // Bytes times a power of two, halves down to the smallest, and floats.
    for (const u32 format : {SKY_TEXEL_RGBE, SKY_TEXEL_HALF, SKY_TEXEL_FLOAT}) {
        Random random(format + 1);
        EnvironmentImage image{13, 7, {}};
        const auto channel = [&](double scale) {
            if (format == SKY_TEXEL_FLOAT)
                return float(scale * random.unit());
            return float(std::floor(random.unit() * (format == SKY_TEXEL_HALF ? 2048 : 256)) * scale);
        };
        for (int i = 0; i < 13 * 7; ++i) {
            const double scale = std::ldexp(1.0, i % 29 - 24);
            image.texels.emplace_back(channel(scale), channel(scale), channel(scale));
        }
        image.texels[3] = glm::vec3(0);
        const Environment map = map_of(image);
        ASSERT_EQ(map.texel_format, format);
        std::vector<vec4> places;
        for (int i = 0; i < 13 * 7; ++i)
            places.push_back({bits_to_float(u32(i % 13)), bits_to_float(u32(i / 13)), 0, 0});
        const std::vector<vec4> got = run("texel", map, places).first;
        for (size_t i = 0; i < places.size(); ++i) {
            const glm::vec3& expected = image.texels[i];
            EXPECT_TRUE(got[i].x == expected.x && got[i].y == expected.y && got[i].z == expected.z)
                << format << ": " << i;
            EXPECT_EQ(sky_texel(map, int(i) % 13, int(i) / 13), expected) << format << ": " << i;
        }
    }
}

TEST(EnvironmentMap, PathsThatDrawTogetherDrawWhatEachDrawsAlone) {
    constexpr u32 GROUP = 32;
    EnvironmentImage coarse = random_image(13, 7), fine = coarse;
    for (glm::vec3& texel : coarse.texels)
        texel = glm::round(texel * 16.f) / 16.f;
    for (glm::vec3& texel : fine.texels)
        texel *= 1 / 3.f;
    std::set<u32> formats;
    for (const EnvironmentImage& image :
         {EnvironmentImage{13, 7, std::vector<glm::vec3>(91, glm::vec3(1))}, coarse, fine}) {
        const Environment map = map_of(image, 3, -15);
        formats.insert(map.texel_format);
        std::vector<vec4> a = random_numbers(10000, 5), b;
        Random random(6);
        for (vec4& numbers : a) {
            const u32 second = random.word(), count = 1 + random.word() % GROUP;
            numbers.z = float((second >> 8) | 1u) * 0x1p-24f; // as sampler_unit
            numbers.w = bits_to_float(second);
            b.push_back({bits_to_float(random.word() % count), bits_to_float(count), 0, 0});
        }
        const SceneProbe::Outputs alone = run("sample", map, a), together = run("lanes", map, a, b);
        for (size_t i = 0; i < a.size(); ++i) {
            ASSERT_EQ(std::memcmp(&alone.first[i], &together.first[i], sizeof(vec4)), 0) << i;
            ASSERT_EQ(std::memcmp(&alone.second[i], &together.second[i], sizeof(vec4)), 0) << i;
        }
    }
    EXPECT_EQ(formats.size(), 3u) << "each form of texels is tried";
}

TEST(EnvironmentMap, SampledTexelsHaveTheirProbabilityAndAreFilledUniformly) {
    expect_stored_probabilities(map_of(random_image(12, 6), 1, 40));
    const Environment bright = map_of(random_image(12, 6), 1, 40, SkySampling::BY_TABLE_AND_BSDF);
    expect_stored_probabilities(bright);
    int dim = 0;
    for (int i = 0; i < 12 * 6; ++i)
        dim += texel_probability(bright, i % 12, i / 12) == 0;
    EXPECT_GT(dim, 20) << "dim texels are never chosen";
    expect_stored_probabilities(map_of(random_image(13, 7), 1, 40)); // tiles that stick out
}

TEST(EnvironmentMap, SamplesCarryThePdfAndTheRadianceOfTheirDirection) {
    constexpr size_t SAMPLES = 100000;
    for (const auto& [width, height] : {std::pair{12, 6}, std::pair{64, 32}, std::pair{512, 256}}) {
        const Environment map = map_of(random_image(width, height), 3, -15);
        const SceneProbe::Outputs got = run("sample", map, random_numbers(SAMPLES, 4));
        size_t other_texel = 0;
        for (size_t i = 0; i < SAMPLES; ++i) {
            ASSERT_TRUE(std::isfinite(got.first[i].w) && got.first[i].w > 0);
            ASSERT_EQ(got.second[i].w, 1); // distant, no delta light
            other_texel += std::abs(got.third[i].x / got.first[i].w - 1) > 1e-5f;
            const dvec3 eval(got.third[i].y, got.third[i].z, got.third[i].w);
            const double sine = std::max(1e-3, std::hypot(double(got.first[i].x), double(got.first[i].z)));
            ASSERT_LE(glm::length(to_dvec3(got.second[i]) - eval), 300 * 2e-6 * width / sine + 1e-4);
        }
        // A rounding of 4 u over the height of a texel, and more in the rows around the poles.
        EXPECT_LE(double(other_texel) / SAMPLES, 2e-5 * height) << width << "x" << height;
    }
}

TEST(EnvironmentMap, ThePdfIntegratesToOneAndTheEstimateToTheRadiance) {
    const SphereCells cells(96, 192, 3);
    std::vector<vec4> nodes;
    for (const dvec3& node : cells.nodes())
        nodes.push_back(to_vec4({node.x, node.z, node.y})); // rows of cells along rows of texels
    const Environment map = map_of(random_image(48, 24), 1, 0);
    std::vector<double> pdf, radiance;
    for (const vec4& value : run("eval", map, nodes).first) {
        pdf.push_back(value.w);
        radiance.push_back(luminance(to_dvec3(value)));
    }
    EXPECT_NEAR(total(cells.integrals(pdf)), 1, 5e-3);

    constexpr size_t SAMPLES = 400000;
    const SceneProbe::Outputs got = run("sample", map, random_numbers(SAMPLES, 5));
    std::vector<double> estimates;
    for (size_t i = 0; i < SAMPLES; ++i)
        estimates.push_back(luminance(to_dvec3(got.second[i])) / got.first[i].w);
    const Moments moments = moments_of(estimates);
    const double exact = total(cells.integrals(radiance));
    EXPECT_NEAR(moments.mean / exact, 1, 5e-3 + 6 * std::sqrt(moments.variance_of_mean()) / exact);
}

TEST(EnvironmentMap, ABrightTexelAtThePoleIsSampledEvenly) {
    // The whole light is within the top rows: half a millirad to a degree around +Y.
    constexpr size_t SAMPLES = 200000;
    for (const int height : {128, 1024, 4096}) {
        EnvironmentImage image{8, height, std::vector<glm::vec3>(size_t(8 * height), glm::vec3(0))};
        for (int column = 0; column < 8; ++column)
            image.texels[size_t(column)] = glm::vec3(1000);
        const Environment map = map_of(image);
        const SceneProbe::Outputs got = run("sample", map, random_numbers(SAMPLES, 6));
        std::vector<double> estimates, rings(16);
        size_t other_texel = 0, in_first = 0;
        for (size_t i = 0; i < SAMPLES; ++i) {
            estimates.push_back(double(got.second[i].x) / got.first[i].w);
            other_texel += std::abs(got.third[i].x / got.first[i].w - 1) > 1e-5f;
            // Rings of equal solid angle within the first row.
            const double sine = std::hypot(double(got.first[i].x), double(got.first[i].z));
            const double share = std::pow(std::sin(std::asin(sine) / 2) / std::sin(PI / height / 2), 2);
            if (share < 1) {
                ++rings[size_t(share * 16)];
                ++in_first;
            }
        }
        EXPECT_LE(double(other_texel) / SAMPLES, 1e-3) << height;
        EXPECT_GT(chi_squared_test(rings, std::vector<double>(16, double(in_first) / 16)).p_value, SMALLEST_P)
            << height;
        // The radiance falls linearly from the middle of the first row to the middle of the second.
        const auto falling = gauss_legendre(16);
        double exact = 0;
        for (const QuadraturePoint& q : falling) {
            const double at = 0.5 + q.at; // rows
            exact += q.weight * (1 - q.at) * 1000 * 2 * PI * std::sin(PI * at / height) * PI / height;
        }
        exact += 1000 * 2 * PI * (1 - std::cos(0.5 * PI / height));
        const Moments moments = moments_of(estimates);
        EXPECT_NEAR(moments.mean / exact, 1, 1e-4 + 6 * std::sqrt(moments.variance_of_mean()) / exact)
            << height;
    }
}

TEST(EnvironmentMap, AConstantSkyIsSampledByTheCosine) {
    constexpr size_t SAMPLES = 300000;
    const Environment sky = constant_environment({0.5, 1, 2});
    const dvec3 n = glm::normalize(dvec3(0.3, -0.5, 0.6));
    const SceneProbe::Outputs got =
        run("sample", sky, random_numbers(SAMPLES, 7), std::vector<vec4>(SAMPLES, to_vec4(n)));
    const SphereCells cells(24, 48, 2);
    // Seen from the normal: rotate n to the z axis of the cells.
    const dvec3 x = glm::normalize(glm::cross(n, dvec3(0, 1, 0))), y = glm::cross(n, x);
    std::vector<dvec3> local;
    for (size_t i = 0; i < SAMPLES; ++i) {
        const dvec3 d = to_dvec3(got.first[i]);
        local.push_back({glm::dot(d, x), glm::dot(d, y), std::max(0.0, glm::dot(d, n))});
        ASSERT_NEAR(got.first[i].w, local.back().z / PI, 4 * FLOAT_U);
        ASSERT_TRUE(got.second[i].x == 0.5f && got.second[i].y == 1 && got.second[i].z == 2);
        ASSERT_TRUE(got.third[i].y == 0.5f && got.third[i].w == 2);
    }
    std::vector<double> density;
    for (const dvec3& node : cells.nodes())
        density.push_back(std::max(0.0, node.z) / PI);
    std::vector<double> expected = cells.integrals(density);
    for (double& cell : expected)
        cell *= double(SAMPLES);
    EXPECT_GT(chi_squared_test(cells.histogram(local), expected).p_value, SMALLEST_P);
}
