// SPDX-License-Identifier: Apache-2.0
// lights/delta_light.h and lights.h: points and suns, the choice among all kinds of light, and what escaping
// rays see.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "probes/statistics.h"
#include "scene/alias_table.h"
#include "scene/environment.h"
#include "scene/lights.h"
#include "scene/sky_table.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"lights/lights.h"});
        const std::string outputs =
            "first = probe_vec4(s.wi, s.pdf_w);"
            "second = probe_vec4(s.radiance, (s.is_distant ? 1.0f : 0.0f) + (s.is_delta ? 2.0f : 0.0f));"
            "third = probe_vec4(s.target, REAL(0.0));";
        // a: position, light; b: two numbers
        made.add("delta", "const LightSample s = delta_light_sample(scene, as_uint(a.w), vector_from(a), "
                          "(real2)((real)b.x, (real)b.y));" +
                              outputs);
        made.add("choose",
                 "first.x = as_float(delta_light_choose(scene, params, as_uint(a.x), as_uint(a.y)));");
        made.add("covers",
                 "first.x = delta_light_covers(scene, as_uint(a.w), vector_from(a)) ? 1.0f : 0.0f;");
        // a: position; b: words
        made.add(
            "any",
            "Surface surface; surface.position = vector_from(a); surface.is_curved = false;"
            "surface.normal_g = surface.normal_s = vector_make(0.0f, 0.0f, 1.0f);"
            "const LightSample s = lights_sample(scene, params, &surface, vector_make(0.0f, 0.0f, 1.0f), "
            "(uint2)(as_uint(b.x), as_uint(b.y)), as_uint(b.z));" +
                outputs);
        // a: direction, density of the other technique
        made.add(
            "escape",
            "first = probe_vec4(lights_escape(scene, params, 0, vector_from(a), (real)a.w, KINDS_ALL), "
            "REAL(0.0));"
            "second.x = params->environment_width ? environment_map_pdf_w(scene, params, vector_from(a)) : 0;"
            "second.yzw = convert_float3(environment_eval(scene, params, vector_from(a)));");
        return made;
    }();
    return instance;
}

Light point(const dvec3& position, const dvec3& intensity) {
    Light light{};
    light.kind = LIGHT_POINT;
    light.vector = to_vec4(position);
    light.emission = to_vec4(intensity);
    return light;
}

Light sun(const dvec3& towards, const dvec3& emission, double radius) {
    Light light{};
    light.kind = LIGHT_SUN;
    light.vector = to_vec4(glm::normalize(towards));
    light.emission = to_vec4(emission);
    light.one_minus_cos = float(2 * std::pow(std::sin(radius / 2), 2));
    return light;
}

/// Lights that are chosen with the given weights.
Scene scene_of(std::vector<Light> lights, const std::vector<double>& weights) {
    const AliasTable table = build_alias_table(weights);
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].probability = float(table.probability[i]);
        lights[i].alias = table.entries[i].alias;
        lights[i].threshold = table.entries[i].threshold;
    }
    Scene scene;
    scene.lights = lights;
    return scene;
}

std::vector<vec4> random_words(size_t count, u32 seed) {
    Random random(seed);
    std::vector<vec4> words;
    for (size_t i = 0; i < count; ++i) {
        const u32 x = random.word(), y = random.word();
        words.push_back({bits_to_float(x), bits_to_float(y), bits_to_float(random.word()), 0});
    }
    return words;
}

vec4 with_index(const dvec3& v, u32 index) {
    vec4 packed = to_vec4(v);
    packed.w = bits_to_float(index);
    return packed;
}

/// One light of every kind: a lamp, a map, a point and two suns.
struct Everything {
    Scene scene;
    RenderParams params{};

    Everything() {
        scene = scene_of({point({0.5, 0.2, 1.5}, {3, 2, 1}), sun({1, 2, 2}, {5, 5, 4}, 0),
                          sun({-1, 0.5, 2}, {90, 80, 70}, 0.2)},
                         {1, 2, 3});
        Triangle triangle{};
        triangle.v1 = 1;
        triangle.v2 = 2;
        triangle.n0 = triangle.n1 = triangle.n2 = triangle.t0 = triangle.t1 = triangle.t2 = NO_INDEX;
        scene.triangles.push_back(triangle);
        scene.positions = {{-1, -1, 1.8f, 0}, {-1, 1, 1.8f, 0}, {1, -1, 1.8f, 0}}; // faces down
        Material material{};
        material.matte = {0, 0, 0, 1};
        material.emission = {1, 2, 3, 0};
        material.map_matte = material.map_specular = material.map_emission = material.map_coverage = NO_INDEX;
        material.map_roughness = material.map_metallic = material.map_normal = material.map_bump = NO_INDEX;
        scene.materials.push_back(material);
        scene.emitters = build_emitters(scene.positions, scene.triangles, {2}).emitters;
        EnvironmentImage image{8, 4, {}};
        Random random(1);
        for (int i = 0; i < 32; ++i)
            image.texels.push_back(
                glm::vec3(float(random.unit()), float(random.unit()), float(random.between(0, 5))));
        NoticeList notices;
        scene.environment = map_environment(image, 1, 0, notices);
        tabulate_sky(scene.environment, SkySampling::BY_TABLE);
        params.environment = {1, 1, 1, 0};
        params.environment_width = 8;
        params.environment_height = 4;
        params.environment_format = scene.environment.texel_format;
        params.environment_cos = 1;
        params.emitter_count = 1;
        params.light_count = 3;
        params.choose_emitter = 0.25f;
        params.choose_environment = 0.45f;
        params.choose_light = 0.3f;
    }
};

double luminance(const dvec3& rgb) {
    return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

} // namespace

TEST(DeltaLight, PointLightsFallWithTheSquareOfTheDistance) {
    const dvec3 place(0.3, -1.2, 0.7), intensity(2, 5, 11);
    const Scene scene = scene_of({point(place, intensity)}, {1});
    Random random(1);
    std::vector<vec4> positions;
    for (int i = 0; i < 10000; ++i)
        positions.push_back(
            with_index(place + random.direction() * std::abs(random.signed_log(1e-3, 1e3)), 0));
    const SceneProbe::Outputs got = probe().run("delta", scene, RenderParams{}, positions);
    for (size_t i = 0; i < positions.size(); ++i) {
        const dvec3 light = to_dvec3(scene.lights[0].vector), way = light - to_dvec3(positions[i]);
        const double d2 = glm::dot(way, way);
        ASSERT_LE(glm::length(to_dvec3(got.second[i]) * d2 / intensity - dvec3(1)), 1e-6);
        ASSERT_LE(glm::length(to_dvec3(got.first[i]) - glm::normalize(way)), 1e-6);
        ASSERT_EQ(to_dvec3(got.third[i]), light);
        ASSERT_EQ(got.first[i].w, 1);
        ASSERT_EQ(got.second[i].w, 2); // a delta light that is not distant
    }
    // At the light itself there is no direction.
    const SceneProbe::Outputs at = probe().run("delta", scene, RenderParams{}, {with_index(place, 0)});
    EXPECT_EQ(at.first[0].w, 0);
    EXPECT_EQ(at.second[0].x, 0);
}

TEST(DeltaLight, SunsWithoutADiscComeFromOneDirection) {
    const Scene scene = scene_of({sun({1, 2, -2}, {4, 5, 6}, 0)}, {1});
    const SceneProbe::Outputs got = probe().run(
        "delta", scene, RenderParams{}, std::vector<vec4>(3, with_index({5, 6, 7}, 0)), {{0.1f, 0.9f, 0, 0}});
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(to_dvec3(got.first[i]), to_dvec3(scene.lights[0].vector));
        EXPECT_EQ(to_dvec3(got.second[i]), dvec3(4, 5, 6));
        EXPECT_EQ(got.first[i].w, 1);
        EXPECT_EQ(got.second[i].w, 3); // distant and delta
    }
}

TEST(DeltaLight, DiscsOfSunsAreSampledUniformly) {
    constexpr size_t SAMPLES = 200000;
    for (const double radius : {0.5, 0.00465, 1e-4}) { // 0.53 degrees across is the sun
        const Scene scene = scene_of({sun({-1, 1, 3}, {7, 8, 9}, radius)}, {1});
        Random random(2);
        std::vector<vec4> u;
        for (size_t i = 0; i < SAMPLES; ++i) {
            const double x = random.unit();
            u.push_back(to_vec4({x, random.unit(), 0}));
        }
        const SceneProbe::Outputs got = probe().run("delta", scene, RenderParams{},
                                                    std::vector<vec4>(SAMPLES, with_index({0, 0, 0}, 0)), u);
        const dvec3 n = glm::normalize(to_dvec3(scene.lights[0].vector));
        const dvec3 x = glm::normalize(glm::cross(n, dvec3(0, 1, 0))), y = glm::cross(n, x);
        std::vector<double> counts(20 * 20);
        for (size_t i = 0; i < SAMPLES; ++i) {
            const dvec3 d = to_dvec3(got.first[i]);
            const double sine = glm::length(glm::cross(n, d)),
                         h = sine * sine / (1 + std::sqrt(1 - sine * sine));
            const double share = h / scene.lights[0].one_minus_cos;
            ASSERT_LE(share, 1 + 1e-6 / radius);
            ASSERT_NEAR(got.first[i].w * 2 * PI * scene.lights[0].one_minus_cos, 1, 1e-6);
            ASSERT_EQ(to_dvec3(got.second[i]), dvec3(7, 8, 9));
            ASSERT_EQ(got.second[i].w, 1); // distant, not delta
            const double turn = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * PI) + 0.5;
            ++counts[std::min<size_t>(size_t(share * 20), 19) * 20 + std::min<size_t>(size_t(turn * 20), 19)];
        }
        // Directions are floats: the smallest disc is a thousand roundings wide, which shows in its cells.
        const double p = chi_squared_test(counts, std::vector<double>(400, SAMPLES / 400.0)).p_value;
        EXPECT_TRUE(p > SMALLEST_P || radius < 1e-3) << radius;
    }
}

TEST(DeltaLight, DiscsCoverTheDirectionsWithinTheirRadius) {
    for (const double radius : {0.5, 0.00465, 1e-4}) {
        const Scene scene = scene_of(
            {sun({-1, 1, 3}, {1, 1, 1}, radius), sun({-1, 1, 3}, {1, 1, 1}, 0), point({-1, 1, 3}, {1, 1, 1})},
            {1, 1, 1});
        const dvec3 n = glm::normalize(to_dvec3(scene.lights[0].vector));
        Random random(3);
        std::vector<vec4> directions, others;
        std::vector<double> angles;
        for (int i = 0; i < 20000; ++i) {
            const dvec3 across = glm::normalize(glm::cross(n, random.direction()));
            const double angle = radius * random.between(0, 2);
            directions.push_back(with_index(n * std::cos(angle) + across * std::sin(angle), 0));
            others.push_back(with_index(n, 1 + u32(i % 2)));
            angles.push_back(angle);
        }
        const std::vector<vec4> got = probe().run("covers", scene, RenderParams{}, directions).first;
        for (size_t i = 0; i < got.size(); ++i)
            ASSERT_TRUE((got[i].x != 0) == (angles[i] < radius) || std::abs(angles[i] - radius) < 4e-7)
                << angles[i] / radius;
        // Lights without a disc are never met by chance.
        for (const vec4& other : probe().run("covers", scene, RenderParams{}, others).first)
            ASSERT_EQ(other.x, 0);
    }
}

TEST(DeltaLight, LightsAreChosenWithTheirProbability) {
    constexpr size_t SAMPLES = 400000;
    const std::vector<double> weights = {1, 0.01, 5, 0, 3, 0.2, 1};
    const Scene scene = scene_of(std::vector<Light>(weights.size()), weights);
    RenderParams params{};
    params.light_count = u32(weights.size());
    std::vector<double> counts(weights.size()), expected;
    for (const vec4& chosen : probe().run("choose", scene, params, random_words(SAMPLES, 4)).first)
        ++counts.at(float_to_bits(chosen.x));
    for (size_t i = 0; i < weights.size(); ++i) {
        expected.push_back(SAMPLES * weights[i] / 10.21);
        EXPECT_NEAR(scene.lights[i].probability, weights[i] / 10.21, 1e-7);
    }
    EXPECT_EQ(counts[3], 0);
    EXPECT_GT(chi_squared_test(counts, expected).p_value, SMALLEST_P);
}

TEST(Lights, EveryKindHasItsShareAndItsProbabilityIsInThePdf) {
    constexpr size_t SAMPLES = 400000;
    const Everything all;
    const SceneProbe::Outputs got = probe().run(
        "any", all.scene, all.params, std::vector<vec4>(SAMPLES, {0, 0, 0, 0}), random_words(SAMPLES, 5));
    // By what was found: the lamp (not distant, not delta), the map or the disc (distant, not delta), the
    // point, the sun.
    std::vector<double> counts(4);
    for (size_t i = 0; i < SAMPLES; ++i) {
        const float pdf = got.first[i].w, kind = got.second[i].w;
        const size_t found = kind == 0 ? 0 : kind == 1 ? 1 : kind == 2 ? 2 : 3;
        ++counts[found];
        // Delta lights: the probability alone, 0.3 times 1/6 or 2/6.
        ASSERT_TRUE(found < 2 || std::abs(pdf - (found == 2 ? 0.05 : 0.1)) < 1e-6) << pdf;
    }
    EXPECT_GT(
        chi_squared_test(counts, {SAMPLES * 0.25, SAMPLES * (0.45 + 0.15), SAMPLES * 0.05, SAMPLES * 0.1})
            .p_value,
        SMALLEST_P);
}

TEST(Lights, TheEstimateOfIrradianceIsTheSumOverAllLights) {
    // On a floor that looks along +z, by one light a sample; each kind alone against the mixture.
    constexpr size_t SAMPLES = 600000;
    const Everything all;
    const auto irradiance = [&](double emitter, double sky, double light, u32 seed) {
        RenderParams params = all.params;
        params.choose_emitter = float(emitter);
        params.choose_environment = float(sky);
        params.choose_light = float(light);
        const SceneProbe::Outputs got = probe().run(
            "any", all.scene, params, std::vector<vec4>(SAMPLES, {0, 0, 0, 0}), random_words(SAMPLES, seed));
        std::vector<double> estimates;
        for (size_t i = 0; i < SAMPLES; ++i)
            estimates.push_back(got.first[i].w > 0
                                    ? luminance(to_dvec3(got.second[i])) *
                                          std::max(0.0, double(got.first[i].z)) / got.first[i].w
                                    : 0);
        return moments_of(estimates);
    };
    const Moments mixture = irradiance(0.25, 0.45, 0.3, 6);
    double sum = 0, variance = mixture.variance_of_mean();
    for (const Moments& one : {irradiance(1, 0, 0, 7), irradiance(0, 1, 0, 8), irradiance(0, 0, 1, 9)}) {
        sum += one.mean;
        variance += one.variance_of_mean();
    }
    EXPECT_LT(std::abs(mixture.mean - sum), 6 * std::sqrt(variance));
    // Points and suns in closed form; the disc's irradiance is L pi sin^2 times the cosine of its centre.
    const Moments lights = irradiance(0, 0, 1, 10);
    const dvec3 way(0.5, 0.2, 1.5);
    const double exact =
        luminance({3, 2, 1}) * way.z / std::pow(glm::length(way), 3) + luminance({5, 5, 4}) * 2 / 3 +
        luminance({90, 80, 70}) * PI * std::pow(std::sin(0.2), 2) * 2 / std::sqrt(1 + 0.25 + 4);
    EXPECT_LT(std::abs(z_of_mean(lights, exact)), 6) << lights.mean << " " << exact;
}

TEST(Lights, NothingIsSampledWhereThereIsNoLight) {
    for (const vec4& sample :
         probe().run("any", Scene{}, RenderParams{}, std::vector<vec4>(1000), random_words(1000, 11)).first)
        ASSERT_EQ(sample.w, 0);
}

TEST(Lights, EscapingRaysSeeTheSkyAndTheDiscsWeightedAgainstSampling) {
    const Everything all;
    const dvec3 disc = glm::normalize(to_dvec3(all.scene.lights[2].vector));
    Random random(12);
    std::vector<vec4> rays;
    for (int i = 0; i < 20000; ++i) {
        const dvec3 d = i % 2 ? random.direction() : glm::normalize(disc + 0.15 * random.direction());
        // 0 for a ray from the camera or a mirror.
        rays.push_back(to_vec4(d, i % 3 ? std::abs(random.signed_log(1e-3, 1e3)) : 0));
    }
    const SceneProbe::Outputs got = probe().run("escape", all.scene, all.params, rays);
    const auto weight = [](double a, double b) { return a == 0 ? 1 : a * a / (a * a + b * b); };
    size_t in_disc = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const dvec3 d = to_dvec3(rays[i]), sky(got.second[i].y, got.second[i].z, got.second[i].w);
        const double angle = std::acos(std::clamp(glm::dot(glm::normalize(d), disc), -1.0, 1.0));
        if (std::abs(angle - 0.2) < 1e-6)
            continue;
        const double pdf = rays[i].w;
        dvec3 exact = sky * weight(pdf, 0.45 * got.second[i].x);
        if (angle < 0.2) {
            exact += dvec3(90, 80, 70) * weight(pdf, 0.3 * 0.5 / (2 * PI * (1 - std::cos(0.2))));
            ++in_disc;
        }
        ASSERT_LE(glm::length(to_dvec3(got.first[i]) - exact), 1e-5 * (1 + glm::length(exact))) << i;
    }
    EXPECT_GT(in_disc, 5000u);

    // A constant sky is left to BSDF sampling: full weight whatever the density.
    RenderParams constant{};
    constant.environment = {1, 2, 3, 0};
    for (const vec4& radiance : probe().run("escape", Scene{}, constant, rays).first)
        ASSERT_EQ(to_dvec3(radiance), dvec3(1, 2, 3));
}
