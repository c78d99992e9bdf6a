// SPDX-License-Identifier: Apache-2.0
// camera/camera_lens.h: points of the lens, the rays through them, and back from points to the film.
#include "options/camera_options.h"
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "probes/statistics.h"
#include "scene/camera_params.h"
#include "scene/vectors.h"
#include "support/test_device.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;
using glm::dvec3;

namespace {

constexpr size_t SAMPLES = 100000;
constexpr glm::ivec2 SIZE(96, 64);
constexpr Projection WITH_LENS[] = {PROJECTION_PERSPECTIVE, PROJECTION_ORTHOGRAPHIC};

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"geometry/scene.h", "camera/camera.h"});
        made.add("point", "const real2 p = camera_lens_unit(&params->camera, (real2)(a.x, a.y));"
                          "first = (vec4)(p.x, p.y, camera_lens_area(&params->camera), 0.0f);");
        // a: film position, lens numbers; b.x: how far along the ray
        made.add("ray", R"(
            const Ray ray = camera_generate(&params->camera, (real2)(a.x, a.y), (real2)(a.z, a.w), REAL(0.0));
            const real3 point = ray.origin + ray.direction * (real)b.x;
            const CameraConnection got = camera_project(&params->camera, point, (real2)(a.z, a.w));
            first = probe_vec4(ray.origin, got.film.x);
            second = probe_vec4(ray.direction, got.film.y);
            const CameraPdf pdf = camera_pdf(&params->camera, ray.direction);
            third = (vec4)(vector_length(got.lens - ray.origin), got.pdf_a, pdf.pdf_a, pdf.pdf_w);)");
        // a: a point, b: lens numbers
        made.add("see", "const CameraConnection got = camera_project(&params->camera, vector_from(a),"
                        "                                            (real2)(b.x, b.y));"
                        "first = (vec4)(got.film.x, got.film.y, 0.0f, 0.0f);");
        return made;
    }();
    return instance;
}

/// A camera away from all axes whose axis meets the plane in focus at distance 2.
RenderParams lens_params(Projection projection, double aperture, double focus = 2, int blades = 0) {
    Camera camera;
    camera.eye = {0.4, -0.6, 0.5};
    camera.at = camera.eye + dvec3(0.3, -0.5, -0.8);
    camera.up = {0.2, 1, 0.1};
    camera.projection = projection;
    camera.ortho_height = 1;
    camera.aperture = aperture;
    camera.focus = focus;
    camera.blades = blades;
    camera.shift = {0.2, -0.1};
    RenderParams params{};
    params.camera = make_camera_params(camera, Normalisation(), SIZE);
    return params;
}

/// Film positions and lens numbers.
std::vector<vec4> random_samples(size_t count) {
    Random random(5);
    std::vector<vec4> samples;
    for (size_t i = 0; i < count; ++i) {
        const double x = random.between(-0.5, 0.5) * SIZE.x, y = random.between(-0.5, 0.5) * SIZE.y;
        const double u = random.unit();
        samples.push_back({float(x), float(y), float(u), float(random.unit())});
    }
    return samples;
}

std::vector<vec4> random_pairs() {
    Random random(6);
    std::vector<vec4> pairs;
    for (size_t i = 0; i < SAMPLES; ++i) {
        const double x = random.unit();
        pairs.push_back(to_vec4({x, random.unit(), 0}));
    }
    return pairs;
}

/// The triangle of a polygon of unit corners that a point lies in, from the top clockwise, and how far it is
/// from the middle towards the edge.
std::pair<size_t, double> place_in_polygon(int blades, const vec4& p) {
    const double turn = std::atan2(double(p.x), -double(p.y)) / (2 * PI) * blades;
    const size_t blade = size_t(std::floor(turn < 0 ? turn + blades : turn)) % size_t(blades);
    const double middle = 2 * PI * (double(blade) + 0.5) / blades;
    return {blade, (p.x * std::sin(middle) - p.y * std::cos(middle)) / std::cos(PI / blades)};
}

} // namespace

TEST(CameraLens, ARoundLensIsFilledEvenly) {
    constexpr size_t SIDE = 20;
    std::vector<double> counts(SIDE * SIDE);
    for (const vec4& p :
         probe().run("point", Scene{}, lens_params(PROJECTION_PERSPECTIVE, 0.5), random_pairs()).first) {
        const double r2 = double(p.x) * p.x + double(p.y) * p.y;
        ASSERT_LE(r2, 1 + 8 * FLOAT_U);
        ASSERT_NEAR(p.z, PI * 0.0625, 1e-6);
        const double turn = std::atan2(double(p.y), double(p.x)) / (2 * PI) + 0.5;
        ++counts[std::min(size_t(r2 * SIDE), SIDE - 1) * SIDE + std::min(size_t(turn * SIDE), SIDE - 1)];
    }
    EXPECT_GT(
        chi_squared_test(counts, std::vector<double>(counts.size(), double(SAMPLES) / (SIDE * SIDE))).p_value,
        SMALLEST_P);
}

TEST(CameraLens, BladesMakeAPolygonThatIsFilledEvenly) {
    constexpr size_t RINGS = 16;
    for (const int blades : {3, 5, 6, 64}) {
        std::vector<double> counts(RINGS * size_t(blades));
        for (const vec4& p :
             probe()
                 .run("point", Scene{}, lens_params(PROJECTION_PERSPECTIVE, 2, 2, blades), random_pairs())
                 .first) {
            const auto [blade, out] = place_in_polygon(blades, p);
            ASSERT_LE(out, 1 + 8 * FLOAT_U) << blades;
            ASSERT_NEAR(p.z, blades / 2. * std::sin(2 * PI / blades), 1e-5);
            ++counts[std::min(size_t(out * out * RINGS), RINGS - 1) * size_t(blades) + blade];
        }
        EXPECT_GT(chi_squared_test(
                      counts, std::vector<double>(counts.size(), double(SAMPLES) / double(counts.size())))
                      .p_value,
                  SMALLEST_P)
            << blades;
    }
}

TEST(CameraLens, RaysOfAFilmPositionMeetInThePlaneInFocus) {
    constexpr double FOCUS = 2;
    const std::vector<vec4> samples = random_samples(2000), distances(samples.size(), {1, 0, 0, 0});
    for (const Projection projection : WITH_LENS) {
        const RenderParams params = lens_params(projection, 0.7, FOCUS);
        const SceneProbe::Outputs got = probe().run("ray", Scene{}, params, samples, distances);
        const dvec3 look = to_dvec3(params.camera.look), eye = to_dvec3(params.camera.eye);
        for (size_t i = 0; i < samples.size(); ++i) {
            const FilmRay middle = film_ray(params.camera, {samples[i].x, samples[i].y});
            const dvec3 sharp = middle.origin + middle.direction * (FOCUS / glm::dot(middle.direction, look));
            const dvec3 origin = to_dvec3(got.first[i]), d = to_dvec3(got.second[i]);
            const dvec3 found = origin + d * (FOCUS / glm::dot(d, look));
            ASSERT_LE(glm::distance(found, sharp), 2e-6) << name_of(projection);
            ASSERT_LE(std::abs(glm::dot(origin - eye, look)), 1e-6) << "the lens is parallel to the film";
            ASSERT_LE(glm::distance(origin, middle.origin), 0.35 * (1 + 1e-5));
        }
    }
}

TEST(CameraLens, FocusAtInfinityMakesRaysOfAFilmPositionParallel) {
    const std::vector<vec4> samples = random_samples(500), distances(samples.size(), {1, 0, 0, 0});
    for (const Projection projection : WITH_LENS) {
        const RenderParams params = lens_params(projection, 0.7, std::numeric_limits<double>::infinity());
        const std::vector<vec4> d = probe().run("ray", Scene{}, params, samples, distances).second;
        for (size_t i = 0; i < samples.size(); ++i) {
            const FilmRay middle = film_ray(params.camera, {samples[i].x, samples[i].y});
            ASSERT_LE(glm::distance(to_dvec3(d[i]), glm::normalize(middle.direction)), 1.5e-7);
        }
    }
}

TEST(CameraLens, ProjectingThroughTheSamePointInvertsTheRay) {
    const std::vector<vec4> samples = random_samples(2000);
    Random random(8);
    std::vector<vec4> distances;
    for (size_t i = 0; i < samples.size(); ++i)
        distances.push_back({float(std::exp(random.between(-1, 2))), 0, 0, 0});
    for (const Projection projection : WITH_LENS) {
        const SceneProbe::Outputs got =
            probe().run("ray", Scene{}, lens_params(projection, 0.3), samples, distances);
        for (size_t i = 0; i < samples.size(); ++i) {
            ASSERT_NEAR(got.first[i].w, samples[i].x, 2e-3) << name_of(projection);
            ASSERT_NEAR(got.second[i].w, samples[i].y, 2e-3) << name_of(projection);
            ASSERT_LE(got.third[i].x, 3e-6) << "through another point of the lens";
        }
    }
}

TEST(CameraLens, TheDensityAtAPointIsThatOfItsFilmPositions) {
    const std::vector<vec4> samples = random_samples(500), distances(samples.size(), {1.5, 0, 0, 0});
    for (const Projection projection : WITH_LENS) {
        const RenderParams params = lens_params(projection, 0.3);
        const SceneProbe::Outputs at = probe().run("ray", Scene{}, params, samples, distances);
        std::vector<vec4> points, lenses;
        std::vector<double> sides;
        for (size_t i = 0; i < samples.size(); ++i) {
            const dvec3 d = glm::normalize(to_dvec3(at.second[i])), point = to_dvec3(at.first[i]) + d * 1.5;
            const dvec3 x = glm::normalize(glm::cross(d, dvec3(0.1, 1, 0.3))), y = glm::cross(d, x);
            sides.push_back(1 / std::sqrt(double(at.third[i].y)));
            for (const auto& [u, v] : {std::pair{-0.5, 0.}, {0.5, 0.}, {0., -0.5}, {0., 0.5}}) {
                points.push_back(to_vec4(point + (x * u + y * v) * sides.back()));
                lenses.push_back({samples[i].z, samples[i].w, 0, 0});
            }
        }
        const std::vector<vec4> seen = probe().run("see", Scene{}, params, points, lenses).first;
        for (size_t i = 0; i < samples.size(); ++i) {
            const vec4* p = &seen[4 * i];
            const double area = std::abs((double(p[1].x) - p[0].x) * (double(p[3].y) - p[2].y) -
                                         (double(p[1].y) - p[0].y) * (double(p[3].x) - p[2].x));
            ASSERT_NEAR(area, 1, 0.02) << name_of(projection);
        }
    }
}

TEST(CameraLens, DensitiesOfARayAreOverLensAndSolidAngle) {
    // Of a film position all points of the lens, of a point of the lens all film positions: one over the area
    // that the lens shows the ray, one pixel over the solid angle.
    const std::vector<vec4> samples = random_samples(500), distances(samples.size(), {1, 0, 0, 0});
    const RenderParams params = lens_params(PROJECTION_PERSPECTIVE, 0.3);
    const SceneProbe::Outputs got = probe().run("ray", Scene{}, params, samples, distances);
    const double pixel = double(params.camera.pixel_x) * params.camera.pixel_y;
    for (size_t i = 0; i < samples.size(); ++i) {
        const double cosine = glm::dot(to_dvec3(got.second[i]), to_dvec3(params.camera.look));
        ASSERT_NEAR(got.third[i].z * cosine * PI * 0.15 * 0.15, 1, 1e-5);
        ASSERT_NEAR(got.third[i].w * pixel * cosine * cosine * cosine, 1, 1e-5);
    }
}

TEST(CameraLens, ParallelRaysStartOnTheFilmAndAreOneAPixelsArea) {
    const std::vector<vec4> samples = random_samples(2000), distances(samples.size(), {2, 0, 0, 0});
    const RenderParams params = lens_params(PROJECTION_ORTHOGRAPHIC, 0);
    const SceneProbe::Outputs got = probe().run("ray", Scene{}, params, samples, distances);
    const double pixel = 1. / SIZE.y;
    for (size_t i = 0; i < samples.size(); ++i) {
        ASSERT_LE(glm::distance(to_dvec3(got.second[i]), to_dvec3(params.camera.look)), 4 * FLOAT_U);
        ASSERT_NEAR(got.third[i].z * pixel * pixel, 1, 16 * FLOAT_U) << "samples of a pixel over its area";
        ASSERT_EQ(got.third[i].w, 1);
    }
}

TEST(CameraLens, APinholeHasNoPointsToChooseFrom) {
    const std::vector<vec4> samples = random_samples(500), distances(samples.size(), {2, 0, 0, 0});
    std::vector<vec4> other = samples;
    for (vec4& f : other)
        f.z = 1 - f.z, f.w = 1 - f.w;
    for (int i = 0; i < PROJECTION_COUNT; ++i) {
        const RenderParams params = lens_params(Projection(i), 0);
        const SceneProbe::Outputs a = probe().run("ray", Scene{}, params, samples, distances),
                                  b = probe().run("ray", Scene{}, params, other, distances);
        for (size_t k = 0; k < samples.size(); ++k) {
            ASSERT_EQ(to_dvec3(a.first[k]), to_dvec3(b.first[k]));
            ASSERT_EQ(to_dvec3(a.second[k]), to_dvec3(b.second[k]));
        }
    }
}
