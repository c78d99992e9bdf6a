// SPDX-License-Identifier: Apache-2.0
// camera/camera.h: pixel filters by their distributions, rays against double precision.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"
#include "render/render_params.h"
#include "scene/camera_fit.h"
#include "scene/camera_params.h"
#include "support/test_device.h"

#include <gtest/gtest.h>
#include <set>
#include <tuple>

using namespace clrt;
using glm::dvec2;
using glm::dvec3;

namespace {

constexpr size_t SAMPLES = 300000;
constexpr double GAUSSIAN_SIGMAS = 3;        // the radius of the Gaussian filter
constexpr double LARGEST_RAY_ERROR = 1.5e-7; // radians, whatever the angle of view
constexpr double RESOLVED_PITCH = 2.4e-7;    // radians between pixels whose rays of single precision differ

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"geometry/scene.h", "camera/camera.h", "film/tile.h"});
        made.add("filter", "first = (vec4)(camera_filter_sample(params, (real2)(a.x, a.y)), 0.0f, 0.0f);");
        made.add("tent", "first.x = camera_tent(a.x);");
        // a: pixel x, y, sample
        made.add(
            "ray",
            "const uint x = as_uint(a.x), y = as_uint(a.y);"
            "const Sampler s = sampler_make(params->seed, tile_pixel_number(params, x, y), 0u, as_uint(a.z));"
            "const Ray ray = camera_ray(params, &s, x, y);"
            "first = probe_vec4(ray.direction, ray.t_max); second = probe_vec4(ray.origin, REAL(0.0));"
            "const real2 u = sampler_pair(&s, 0u, SAMPLE_FILM);"
            "third = (vec4)(u.x, u.y, 0.0f, 0.0f);");
        // a: film position, lens numbers; b.x: how far from the lens; c: film position to project to
        made.add("project", R"(
            const Ray ray = camera_generate(&params->camera, (real2)(a.x, a.y), (real2)(a.z, a.w), REAL(0.0));
            const real3 point = ray.origin + ray.direction * (real)b.x;
            const CameraConnection got = camera_project(&params->camera, point, (real2)(a.z, a.w));
            const real3 off = got.lens - ray.origin;
            first = (vec4)(got.film.x, got.film.y, got.pdf_a, vector_length(off));
            second = probe_vec4(ray.direction, camera_importance(&params->camera, ray.direction));
            const CameraPdf pdf = camera_pdf(&params->camera, ray.direction);
            third = (vec4)(pdf.pdf_a, pdf.pdf_w, as_float(camera_pixel(params, got.film)),
                           camera_project(&params->camera, ray.origin - ray.direction * (real)b.x, (real2)(a.z, a.w)).pdf_a);)");
        // a: film position
        made.add("start",
                 "const Ray ray = camera_generate(&params->camera, (real2)(a.x, a.y), (real2)(0.5f), "
                 "REAL(0.0)); first = probe_vec4(ray.origin, REAL(0.0));");
        // a: a point
        made.add("see", "const CameraConnection got = camera_project(&params->camera, vector_from(a), "
                        "(real2)(0.5f, 0.5f));"
                        "first = (vec4)(got.film.x, got.film.y, got.pdf_a, 0.0f);");
        return made;
    }();
    return instance;
}

RenderParams filter_params(u32 filter, double radius) {
    RenderParams params{};
    params.filter = filter;
    params.filter_radius = float(radius);
    return params;
}

std::vector<vec4> filter_offsets(u32 filter, double radius, const std::vector<vec4>& u) {
    return probe().run("filter", Scene{}, filter_params(filter, radius), u).first;
}

std::vector<vec4> random_pairs(size_t count, u32 seed) {
    Random random(seed);
    std::vector<vec4> pairs;
    for (size_t i = 0; i < count; ++i) {
        const double x = random.unit();
        pairs.push_back(to_vec4({x, random.unit(), 0}));
    }
    return pairs;
}

/// p-value of numbers in [0, 1) being uniform and independent of their partner.
double uniform_p_value(const std::vector<std::pair<double, double>>& points) {
    constexpr size_t SIDE = 40;
    std::vector<double> counts(SIDE * SIDE);
    for (const auto& [x, y] : points) {
        EXPECT_TRUE(x >= 0 && x <= 1 && y >= 0 && y <= 1);
        ++counts[std::min(size_t(x * SIDE), SIDE - 1) * SIDE + std::min(size_t(y * SIDE), SIDE - 1)];
    }
    return chi_squared_test(counts, std::vector<double>(counts.size(), double(points.size()) / (SIDE * SIDE)))
        .p_value;
}

/// Cumulative distribution of the tent of radius 1.
double tent_share(double x) {
    return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
}

struct Pinhole {
    dvec3 eye, look, up;
    double fov_degrees;
};

/// What the host makes of a camera; parallel rays cover what the pinhole shows at distance 1.
RenderParams camera_params(const Pinhole& view, u32 width, u32 height,
                           Projection projection = PROJECTION_PERSPECTIVE) {
    Scene scene;
    scene.camera = {view.eye,         view.eye + view.look, view.up,
                    view.fov_degrees, projection,           2 * std::tan(view.fov_degrees * PI / 360)};
    Options options;
    options.film.size = {int(width), int(height)};
    options.film.filter = Filter::BOX;
    return make_render_params(scene, options, FilmScale{});
}

/// The axes of a view: right and up.
std::pair<dvec3, dvec3> axes(const Pinhole& view) {
    const dvec3 right = glm::normalize(glm::cross(view.look, view.up));
    return {right, glm::cross(right, view.look)};
}

std::vector<vec4> random_pixels(u32 width, u32 height, size_t count) {
    Random random(1);
    std::vector<vec4> pixels;
    for (size_t i = 0; i < count; ++i) {
        const u32 x = random.word() % width, y = random.word() % height;
        pixels.push_back({bits_to_float(x), bits_to_float(y), bits_to_float(random.word() % 4096), 0});
    }
    return pixels;
}

} // namespace

TEST(Camera, TheBoxFilterIsUniform) {
    for (const double radius : {0.5, 2.0}) {
        std::vector<std::pair<double, double>> points;
        for (const vec4& p : filter_offsets(FILTER_BOX, radius, random_pairs(SAMPLES, 2)))
            points.emplace_back((p.x / radius + 1) / 2, (p.y / radius + 1) / 2);
        EXPECT_GT(uniform_p_value(points), SMALLEST_P);
    }
}

TEST(Camera, TheTentFilterFallsLinearlyFromTheCentre) {
    for (const double radius : {1.0, 1.7}) {
        std::vector<std::pair<double, double>> points;
        for (const vec4& p : filter_offsets(FILTER_TENT, radius, random_pairs(SAMPLES, 3)))
            points.emplace_back(tent_share(p.x / radius), tent_share(p.y / radius));
        EXPECT_GT(uniform_p_value(points), SMALLEST_P);
    }
}

TEST(Camera, TheGaussianFilterIsNormalAndCutAtItsRadius) {
    for (const double radius : {1.5, 0.5}) {
        const double sigma = radius / GAUSSIAN_SIGMAS;
        const double whole = 1 - std::exp(-GAUSSIAN_SIGMAS * GAUSSIAN_SIGMAS / 2);
        std::vector<std::pair<double, double>> points;
        for (const vec4& p : filter_offsets(FILTER_GAUSSIAN, radius, random_pairs(SAMPLES, 4))) {
            const double r = std::hypot(double(p.x), double(p.y));
            ASSERT_LE(r, radius * (1 + 1e-5));
            points.emplace_back(std::min(1.0, (1 - std::exp(-r * r / (2 * sigma * sigma))) / whole),
                                std::atan2(double(p.y), double(p.x)) / (2 * PI) + 0.5);
        }
        EXPECT_GT(uniform_p_value(points), SMALLEST_P);
    }
}

TEST(Camera, FiltersStayWithinTheirRadiusForTheEndsOfTheNumbers) {
    std::vector<vec4> u;
    for (const double x : {FLOAT_U, 0.5 - FLOAT_U, 0.5 + FLOAT_U, 1 - FLOAT_U})
        for (const double y : {FLOAT_U, 0.5 + FLOAT_U, 1 - FLOAT_U})
            u.push_back(to_vec4({x, y, 0}));
    for (const u32 filter : {FILTER_BOX, FILTER_TENT, FILTER_GAUSSIAN})
        for (const vec4& p : filter_offsets(filter, 1.5, u))
            EXPECT_TRUE(std::abs(p.x) <= 1.5 * (1 + 1e-5) && std::abs(p.y) <= 1.5 * (1 + 1e-5)) << filter;
}

TEST(Camera, TheTentIsTheInverseOfItsDistribution) {
    std::vector<vec4> u;
    for (u32 k = 1; k < 1u << 24; k += 16382)
        u.push_back({float(k * FLOAT_U), 0, 0, 0});
    const std::vector<vec4> got = probe().run("tent", Scene{}, RenderParams{}, u).first;
    for (size_t i = 0; i < u.size(); ++i)
        // Half an ulp of the number before the root, which is steep at the ends.
        ASSERT_NEAR(tent_share(got[i].x), u[i].x, 4 * FLOAT_U) << u[i].x;
}

TEST(Camera, RaysAreThoseOfAPinhole) {
    constexpr u32 WIDTH = 800, HEIGHT = 600;
    const std::vector<vec4> pixels = random_pixels(WIDTH, HEIGHT, 50000);
    const dvec3 tilted = glm::normalize(dvec3(0.3, -0.5, -0.8));
    for (const Pinhole& view :
         {Pinhole{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40}, Pinhole{{1, -2, 3}, tilted, {0, 1, 0}, 90},
          Pinhole{{1, -2, 3}, tilted, {0.2, 1, 0.1}, 179.9}, Pinhole{{0, 5, 0}, tilted, {0, 1, 0}, 1e-3}}) {
        const RenderParams params = camera_params(view, WIDTH, HEIGHT);
        const SceneProbe::Outputs got = probe().run("ray", Scene{}, params, pixels);
        const auto [right, up] = axes(view);
        const double tangent = std::tan(view.fov_degrees * PI / 360);
        for (size_t i = 0; i < pixels.size(); ++i) {
            // From the definition: the sample's place in the picture, scaled by the tangent of half the
            // angle.
            const double x = float_to_bits(pixels[i].x) + double(got.third[i].x);
            const double y = float_to_bits(pixels[i].y) + double(got.third[i].y);
            const dvec3 exact = view.look + right * (tangent * (2 * x - WIDTH) / HEIGHT) +
                                up * (tangent * (1 - 2 * y / HEIGHT));
            const dvec3 d = to_dvec3(got.first[i]);
            ASSERT_LE(glm::length(d - glm::normalize(exact)), LARGEST_RAY_ERROR) << view.fov_degrees;
            ASSERT_NEAR(glm::length(d), 1, 4 * FLOAT_U);
            ASSERT_EQ(got.first[i].w, 1e18f);
            ASSERT_EQ(to_dvec3(got.second[i]), view.eye);
        }
    }
}

TEST(Camera, NeighbouringPixelsHaveRaysOfTheirOwn) {
    // Pixel centres of a narrow view, just wide enough to be told apart.
    constexpr u32 SIZE = 256;
    Pinhole view{
        {0, 0, 0}, glm::normalize(dvec3(0.3, -0.5, -0.8)), {0, 1, 0}, RESOLVED_PITCH * SIZE * 180 / PI};
    std::vector<vec4> pixels;
    for (u32 y = 0; y < SIZE; ++y)
        for (u32 x = 0; x < SIZE; ++x)
            pixels.push_back({bits_to_float(x), bits_to_float(y), 0, 0});
    RenderParams params = camera_params(view, SIZE, SIZE);
    params.filter_radius = 0;
    std::set<std::tuple<float, float, float>> distinct;
    for (const vec4& d : probe().run("ray", Scene{}, params, pixels).first)
        distinct.insert({d.x, d.y, d.z});
    EXPECT_GE(double(distinct.size()), 0.99 * SIZE * SIZE);
}

TEST(Camera, AnUpVectorNearTheViewLeavesTheFilmSquare) {
    const dvec3 tilted = glm::normalize(dvec3(0.3, -0.5, -0.8));
    for (const double angle : {0.0, 1e-7, 1e-5}) {
        CameraOptions given;
        given.eye = dvec3(1, -2, 3);
        given.at = *given.eye + tilted;
        given.up = tilted + angle * dvec3(0.5, 0.3, 0);
        NoticeList notices;
        const Bounds box{dvec3(-1), dvec3(1)};
        const Camera camera = fit_camera(given, {64, 64}, Scene(), box, notices);
        const RenderParams params = camera_params({camera.eye, tilted, camera.up, 90}, 64, 64);
        const dvec3 x = to_dvec3(params.camera.film_dx) * 32.0, y = to_dvec3(params.camera.film_dy) * 32.0;
        EXPECT_NEAR(glm::length(x), 1, 4 * FLOAT_U) << angle;
        EXPECT_NEAR(glm::length(y), 1, 4 * FLOAT_U) << angle;
        EXPECT_NEAR(glm::dot(x, y), 0, 4 * FLOAT_U) << angle;
        EXPECT_NEAR(glm::dot(x, tilted), 0, 4 * FLOAT_U) << angle;
        EXPECT_NEAR(glm::dot(y, tilted), 0, 4 * FLOAT_U) << angle;
    }
}

TEST(Camera, PixelZeroIsTopLeftAndRightIsRight) {
    const RenderParams params = camera_params({{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 60}, 40, 30);
    const std::vector<vec4> corners = {{bits_to_float(0), bits_to_float(0), 0, 0},
                                       {bits_to_float(39), bits_to_float(29), 0, 0}};
    const std::vector<vec4> d = probe().run("ray", Scene{}, params, corners).first;
    EXPECT_TRUE(d[0].x < 0 && d[0].y > 0 && d[0].z < 0);
    EXPECT_TRUE(d[1].x > 0 && d[1].y < 0 && d[1].z < 0);
}

TEST(Camera, TheFilterMovesTheSampleByItsOffset) {
    // Looking along -z with film vectors of one unit a pixel, the direction shows the film position.
    constexpr u32 WIDTH = 64, HEIGHT = 64;
    const std::vector<vec4> pixels = random_pixels(WIDTH, HEIGHT, 10000);
    for (const u32 filter : {FILTER_BOX, FILTER_TENT, FILTER_GAUSSIAN}) {
        RenderParams params = filter_params(filter, 1.5);
        params.width = WIDTH;
        params.height = HEIGHT;
        params.camera.look = {0, 0, -1, 0};
        params.camera.film_dx = {1, 0, 0, 0};
        params.camera.film_dy = {0, 1, 0, 0};
        const SceneProbe::Outputs got = probe().run("ray", Scene{}, params, pixels);
        const std::vector<vec4> offsets = filter_offsets(filter, 1.5, got.third);
        for (size_t i = 0; i < pixels.size(); ++i) {
            const dvec3 d = to_dvec3(got.first[i]) / -double(got.first[i].z);
            ASSERT_NEAR(d.x + WIDTH / 2, float_to_bits(pixels[i].x) + 0.5 + offsets[i].x, 64 * 8 * FLOAT_U);
            ASSERT_NEAR(d.y + HEIGHT / 2, float_to_bits(pixels[i].y) + 0.5 + offsets[i].y, 64 * 8 * FLOAT_U);
        }
    }
}

namespace {

/// Every projection of the table, seen from a camera away from all axes.
std::vector<Projection> projections() {
    std::vector<Projection> all;
    for (int i = 0; i < PROJECTION_COUNT; ++i)
        all.push_back(Projection(i));
    return all;
}

constexpr double ANGLES[] = {1e-3, 0.1, 40, 120, 179.9};

Pinhole tilted_view(double fov_degrees) {
    return {{0.4, -0.6, 0.5}, glm::normalize(dvec3(0.3, -0.5, -0.8)), {0.2, 1, 0.1}, fov_degrees};
}

/// Film positions all over a picture, lens numbers beside them.
std::vector<vec4> film_positions(u32 width, u32 height, size_t count) {
    Random random(7);
    std::vector<vec4> positions;
    for (size_t i = 0; i < count; ++i) {
        const double x = random.between(-0.5, 0.5) * width, y = random.between(-0.5, 0.5) * height;
        const double u = random.unit();
        positions.push_back({float(x), float(y), float(u), float(random.unit())});
    }
    return positions;
}

/// The triangle's solid angle (Van Oosterom and Strackee 1983), by differences, which narrow views leave
/// exact.
double solid_angle(const dvec3& a, const dvec3& b, const dvec3& c) {
    const double volume = glm::dot(a, glm::cross(b - a, c - a));
    return 2 * std::atan2(std::abs(volume), 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

/// The solid angle that a pinhole sees through a square of the film, in double.
double cell_angle(const RenderParams& params, const dvec2& centre, double side) {
    const auto direction = [&](double x, double y) {
        return glm::normalize(film_ray(params.camera, centre + side * dvec2(x, y)).direction);
    };
    const dvec3 a = direction(-0.5, -0.5), b = direction(0.5, -0.5), c = direction(0.5, 0.5),
                d = direction(-0.5, 0.5);
    return solid_angle(a, b, c) + solid_angle(a, c, d);
}

/// What a pixel spans: radians, in parallel projection a length.
double pitch_of(const CameraParams& camera) {
    return double(camera.pixel_x) * (is_panorama(Projection(camera.projection)) ? 2 * PI : 1);
}

/// Pixels across a small angle at a film position, over those in the middle; at most half a picture.
double stretch_of(const RenderParams& params, const vec4& film) {
    const double x = film.x * pitch_of(params.camera), y = film.y * pitch_of(params.camera);
    double stretch = 1;
    if (params.camera.projection == PROJECTION_PERSPECTIVE)
        stretch = 1 + x * x + y * y;
    if (params.camera.projection == PROJECTION_EQUIRECTANGULAR)
        stretch = 1 / std::cos(2 * PI * double(params.camera.pixel_y) * film.y);
    if (params.camera.projection == PROJECTION_FISHEYE && std::hypot(x, y) > PI / 2)
        stretch = std::hypot(x, y) / std::sin(std::hypot(x, y));
    return params.camera.projection == PROJECTION_PERSPECTIVE ? stretch : std::min(stretch, 1e5);
}

} // namespace

TEST(Camera, ProjectingToTheFilmInvertsItsRays) {
    constexpr u32 WIDTH = 96, HEIGHT = 64;
    const std::vector<vec4> film = film_positions(WIDTH, HEIGHT, 4000);
    Random random(8);
    std::vector<vec4> distances;
    for (size_t i = 0; i < film.size(); ++i)
        distances.push_back({float(std::exp(random.between(-2, 3))), 0, 0, 0});
    for (const Projection projection : projections())
        for (const double fov : ANGLES) {
            const RenderParams params = camera_params(tilted_view(fov), WIDTH, HEIGHT, projection);
            const SceneProbe::Outputs got = probe().run("project", Scene{}, params, film, distances);
            const double pitch = pitch_of(params.camera);
            for (size_t i = 0; i < film.size(); ++i) {
                // The point is rounded, as seen from the lens by so many radians, and in parallel projection
                // by a length; at the edge of a wide film an angle is many pixels.
                const double t = distances[i].x;
                const double place = 8 * FLOAT_U * (2 + t + pitch * WIDTH);
                const double allowed =
                    projection == PROJECTION_ORTHOGRAPHIC
                        ? place / pitch
                        : (8 * FLOAT_U * (2 + t) / t) * stretch_of(params, film[i]) / pitch;
                ASSERT_NEAR(got.first[i].x, film[i].x, allowed + WIDTH * FLOAT_U)
                    << name_of(projection) << " " << fov << " " << t;
                ASSERT_NEAR(got.first[i].y, film[i].y, allowed + WIDTH * FLOAT_U);
                ASSERT_LE(got.first[i].w, place) << "it starts at another point of the lens";
                ASSERT_GT(got.first[i].z, 0);
                if (!is_panorama(projection))
                    ASSERT_EQ(got.third[i].w, 0) << "the point lies behind the camera";
                if (allowed < 0.01 && std::abs(std::remainder(film[i].x, 1.f)) > 0.02f &&
                    std::abs(std::remainder(film[i].y, 1.f)) > 0.02f) {
                    const u32 column = u32(std::floor(film[i].x + WIDTH / 2.0)),
                              row = u32(std::floor(film[i].y + HEIGHT / 2.0));
                    ASSERT_EQ(float_to_bits(got.third[i].z), row * WIDTH + column);
                }
            }
        }
}

TEST(Camera, FilmPositionsOutsideThePictureHaveNoPixel) {
    RenderParams params = camera_params(tilted_view(60), 96, 64);
    const std::vector<vec4> outside = {
        {-48.5f, 0, 0, 0}, {48.5f, 0, 0, 0}, {0, -32.5f, 0, 0}, {0, 32.5f, 0, 0}};
    const std::vector<vec4> distances(outside.size(), {1, 0, 0, 0});
    for (const vec4& pixel : probe().run("project", Scene{}, params, outside, distances).third)
        EXPECT_EQ(float_to_bits(pixel.z), NO_INDEX);
    const std::vector<vec4> corner = {{-47.5f, -31.5f, 0, 0}, {47.5f, 31.5f, 0, 0}};
    const std::vector<vec4> got =
        probe().run("project", Scene{}, params, corner, {{1, 0, 0, 0}, {1, 0, 0, 0}}).third;
    EXPECT_EQ(float_to_bits(got[0].z), 0u);
    EXPECT_EQ(float_to_bits(got[1].z), 96u * 64 - 1);
}

TEST(Camera, ThePinholesDensityIsFilmOverSolidAngle) {
    // Small squares of the film, in double, whose rays are so many radians apart.
    constexpr u32 WIDTH = 96, HEIGHT = 64;
    constexpr double APART = 3e-3;
    const std::vector<vec4> film = film_positions(WIDTH, HEIGHT, 2000);
    const std::vector<vec4> distances(film.size(), {1, 0, 0, 0});
    for (const double fov : ANGLES) {
        const RenderParams params = camera_params(tilted_view(fov), WIDTH, HEIGHT);
        const SceneProbe::Outputs got = probe().run("project", Scene{}, params, film, distances);
        const double pitch = glm::length(to_dvec3(params.camera.film_dx));
        for (size_t i = 0; i < film.size(); ++i) {
            const dvec2 centre(film[i].x, film[i].y);
            const double side = std::min(APART, pitch) / pitch * std::hypot(1, pitch * glm::length(centre));
            const double angle = cell_angle(params, centre, side);
            ASSERT_NEAR(angle * double(got.third[i].y) / (side * side), 1, 2e-3) << fov;
            ASSERT_EQ(got.third[i].x, 1) << "one point to start from";
            ASSERT_EQ(got.second[i].w, got.third[i].y);
        }
    }
}

TEST(Camera, ThePinholesImportanceIntegratesToOneAPixel) {
    constexpr u32 WIDTH = 24, HEIGHT = 16;
    constexpr int PARTS = 8; // of a pixel's side
    std::vector<vec4> places;
    for (u32 y = 0; y < PARTS * HEIGHT; ++y)
        for (u32 x = 0; x < PARTS * WIDTH; ++x)
            places.push_back({(float(x) + 0.5f) / PARTS - WIDTH / 2.f,
                              (float(y) + 0.5f) / PARTS - HEIGHT / 2.f, 0.5f, 0.5f});
    const std::vector<vec4> distances(places.size(), {1, 0, 0, 0});
    for (const double fov : {1e-3, 40.0, 120.0}) {
        const RenderParams params = camera_params(tilted_view(fov), WIDTH, HEIGHT);
        const SceneProbe::Outputs got = probe().run("project", Scene{}, params, places, distances);
        std::vector<double> pixels(WIDTH * HEIGHT);
        for (size_t i = 0; i < places.size(); ++i)
            pixels[i / (PARTS * PARTS * WIDTH) * WIDTH + i % (PARTS * WIDTH) / PARTS] +=
                double(got.second[i].w) * cell_angle(params, {places[i].x, places[i].y}, 1. / PARTS);
        for (const double pixel : pixels)
            ASSERT_NEAR(pixel, 1, 2e-3) << fov;
    }
}

TEST(Camera, TheDensityAtAPointIsThatOfItsFilmPositions) {
    // Points beside one another across the ray, and the area of the film that they are projected to.
    constexpr u32 WIDTH = 96, HEIGHT = 64;
    const std::vector<vec4> film = film_positions(WIDTH, HEIGHT, 500);
    Random random(9);
    std::vector<vec4> distances;
    for (size_t i = 0; i < film.size(); ++i)
        distances.push_back({float(random.between(0.5, 3)), 0, 0, 0});
    for (const Projection projection : projections())
        for (const double fov : {10.0, 40.0, 120.0}) {
            const RenderParams params = camera_params(tilted_view(fov), WIDTH, HEIGHT, projection);
            const SceneProbe::Outputs at = probe().run("project", Scene{}, params, film, distances);
            const std::vector<vec4> starts = probe().run("start", Scene{}, params, film).first;
            std::vector<vec4> points;
            std::vector<double> sides;
            for (size_t i = 0; i < film.size(); ++i) {
                const dvec3 d = glm::normalize(to_dvec3(at.second[i])),
                            point = to_dvec3(starts[i]) + d * double(distances[i].x);
                const dvec3 x = glm::normalize(glm::cross(d, dvec3(0.1, 1, 0.3))), y = glm::cross(d, x);
                // A side of about a pixel.
                const double side = (is_panorama(projection) ? 0.1 : 1) / std::sqrt(double(at.first[i].z));
                sides.push_back(side);
                for (const auto& [u, v] : {std::pair{-0.5, 0.}, {0.5, 0.}, {0., -0.5}, {0., 0.5}})
                    points.push_back(to_vec4(point + x * (u * side) + y * (v * side)));
            }
            const std::vector<vec4> seen = probe().run("see", Scene{}, params, points).first;
            for (size_t i = 0; i < film.size(); ++i) {
                if (is_panorama(projection) && stretch_of(params, film[i]) > 5)
                    continue; // a pole, where squares are none
                const vec4* p = &seen[4 * i];
                const auto across = [&](int a, int b) { // the ends of a panorama meet
                    const double x = double(p[a].x) - double(p[b].x);
                    return projection == PROJECTION_EQUIRECTANGULAR ? std::remainder(x, double(WIDTH)) : x;
                };
                const double area = std::abs(across(1, 0) * (double(p[3].y) - double(p[2].y)) -
                                             (double(p[1].y) - double(p[0].y)) * across(3, 2));
                ASSERT_NEAR(area / (sides[i] * sides[i]) / double(at.first[i].z), 1, 0.01)
                    << name_of(projection) << " " << fov;
            }
        }
}

TEST(Camera, ACameraWithoutARowSeesNothing) {
    RenderParams params = camera_params(tilted_view(40), 96, 64);
    params.camera.projection = PROJECTION_COUNT;
    const std::vector<vec4> film = film_positions(96, 64, 10);
    for (const vec4& d : probe().run("project", Scene{}, params, film, {}).second)
        EXPECT_EQ(to_dvec3(d), dvec3(0));
}
