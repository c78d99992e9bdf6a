// SPDX-License-Identifier: Apache-2.0
// Lights: tiny, huge, in the surface's own plane, of all powers; weights of multiple importance sampling.
#include "stability/cases/shading_expressions.h"
#include "stability/catalogue.h"
#include "stability/choices.h"
#include "stability/mean_figure.h"
#include "stability/path_probe.h"

#include "probes/random_inputs.h"

#include <fmt/format.h>

namespace clrt {

namespace {

using glm::dvec3;

const Integrator TREE_AND_PATH[] = {Integrator::WHITTED, Integrator::PATH};

/// a, b: densities of both techniques. The weights of both.
const ProbedExpression MIS = {
    "mis", 2, 2, "out[0] = mis_weight(a, b); out[1] = mis_weight(b, a);",
    "const real a2 = a * a, b2 = b * b; out[0] = a2 / (a2 + b2); out[1] = b2 / (a2 + b2);"};

/// A matte floor of reflectance 1/2, light by one reflection.
struct FloorScene : ScratchScene {
    FloorScene() {
        build.material("floor", "Kd 0.5 0.5 0.5").use("floor").floor(1);
        options.transport.max_depth = 2;
    }
};

/// Standard error of a mean over its value: a factor of two in a density or a weight is far outside six of
/// them, a lamp of one part in twenty just.
constexpr double SHARPNESS = 8e-3;

/// The exitant radiance of the floor for an irradiance.
double floor_radiance(double irradiance) {
    return 0.5 / PI * irradiance;
}

std::vector<double> reds(const std::vector<dvec3>& colours) {
    std::vector<double> values;
    for (const dvec3& colour : colours)
        values.push_back(colour.x);
    return values;
}

/// The last triangle of a scene.
std::vector<dvec3> last_triangle(const Scene& scene) {
    const Triangle& t = scene.triangles.back();
    return {to_dvec3(scene.positions[t.v0]), to_dvec3(scene.positions[t.v1]),
            to_dvec3(scene.positions[t.v2])};
}

void tiny_lamp(CaseRun& run) {
    Figure& error = run.figure("relative error of a sample", 1e-4);
    FloorScene scene;
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
    const dvec3 at(0.3, 1, 0.2);
    scene.build.polygon({at, at + dvec3(1e-6, 0, 0), at + dvec3(0, 0, 1e-6)});
    const PathProbe probe(run.device, scene);
    // The corners as the scene holds them; the floor at the middle of its box.
    const std::vector<dvec3> c = last_triangle(probe.scene());
    const double height = probe.scene().positions[0].y;
    const dvec3 area = 0.5 * glm::cross(c[1] - c[0], c[2] - c[0]),
                way = (c[0] + c[1] + c[2]) / 3.0 - dvec3(0, height, 0);
    const double irradiance = std::abs(glm::dot(area, way)) * way.y / std::pow(glm::dot(way, way), 2);
    const double middle = -probe.scene().normalisation.centre.x;
    const std::vector<TestRay> rays = {probe.ray({-0.4 - middle, 0.5, 0.3}, {-middle, 0, 0})};
    for (const Build build : path_builds(run))
        for (const Integrator integrator : TREE_AND_PATH)
            for (const dvec3& value : probe.radiance(build, integrator, rays, 256))
                error[build].see(std::abs(value.x / floor_radiance(irradiance) - 1),
                                 [&] { return fmt::format("radiance {}", value.x); });
}

void huge_lamp(CaseRun& run) {
    MeanFigure mean(run, "the mean", SHARPNESS);
    FloorScene scene;
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
    const double half = 5e4;
    const std::vector<dvec3> corners = {
        {-half, 1, -half}, {half, 1, -half}, {half, 1, half}, {-half, 1, half}};
    scene.build.polygon(corners);
    const PathProbe probe(run.device, scene);
    const double expected = floor_radiance(polygon_irradiance({0, 0, 0}, {0, 1, 0}, corners));
    const std::vector<TestRay> rays = {probe.ray({0.3, 0.5, 0.2}, {0, 0, 0})};
    for (const Build build : path_builds(run))
        mean.see(build, reds(probe.radiance(build, Integrator::PATH, rays, run.count(2e4, 1e6, 1e7))),
                 expected);
}

/// A floor and a lamp side by side in one plane, turned by a quarter turn at most; rays to points on it.
void in_the_lamps_plane(CaseRun& run) {
    Figure& bad = run.figure("radiances that are no finite number", 0);
    Figure& level = run.figure("radiance, the plane level", 0);
    Figure& tilted = run.figure("radiance, the plane tilted", 1e-5);
    for (const bool is_tilted : {false, true}) {
        const dvec3 x = is_tilted ? glm::normalize(dvec3(0.8, 0.37, 0.1)) : dvec3(1, 0, 0);
        const dvec3 z = is_tilted ? glm::normalize(glm::cross(x, dvec3(0.2, 0.9, -0.3))) : dvec3(0, 0, 1),
                    up = glm::cross(z, x);
        ScratchScene scene;
        scene.options.transport.max_depth = 2;
        scene.build.material("floor", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 0 1 0");
        scene.build.use("floor").polygon({z, x + z, x - z, -z}).use("lamp").polygon({dvec3(0), -z, -x});
        const PathProbe probe(run.device, scene);
        std::vector<TestRay> rays;
        for (const double along : {1e-7, 1e-5, 1e-3, 0.1, 0.9})
            for (const double across : {-1.0 + 1e-6, -0.7, -1e-5, 0.0, 1e-5, 0.5})
                for (const double height : {1e-3, 0.5, 3.0}) {
                    const dvec3 at = along * x + across * z;
                    rays.push_back(probe.ray(at + height * (up + 0.3 * x), at));
                }
        for (const Build build : path_builds(run))
            for (const Integrator integrator : TREE_AND_PATH) {
                const std::vector<dvec3> got = probe.radiance(build, integrator, rays, 64);
                for (size_t i = 0; i < got.size(); ++i) {
                    const auto describe = [&] { return fmt::format("ray {}: {}", i / 64, got[i].y); };
                    bad[build].count(!(got[i].y >= 0 && std::isfinite(got[i].y)), describe);
                    if (got[i].y != 1) // the lamp itself was hit
                        (is_tilted ? tilted : level)[build].see(got[i].y, describe);
                }
            }
    }
}

void all_powers(CaseRun& run) {
    Figure& bad = run.figure("samples that are no finite number", 0);
    MeanFigure mean(run, "the mean", SHARPNESS);
    FloorScene scene;
    double irradiance = 0;
    for (int k = -20; k <= 20; k += 5) {
        const double radiance = std::pow(10, k), at = 0.03 * k;
        const std::vector<dvec3> corners = {{at, 1, 0}, {at + 0.1, 1, 0}, {at, 1, 0.2}};
        scene.build
            .material(fmt::format("lamp{}", k), fmt::format("Kd 0 0 0\nKe {0:e} {0:e} {0:e}", radiance))
            .use(fmt::format("lamp{}", k))
            .polygon(corners);
        irradiance += radiance * polygon_irradiance({0, 0, 0}, {0, 1, 0}, corners);
    }
    const PathProbe probe(run.device, scene);
    const std::vector<TestRay> rays = {probe.ray({0.3, 0.5, 0.2}, {0, 0, 0})};
    for (const Build build : path_builds(run)) {
        const std::vector<double> got =
            reds(probe.radiance(build, Integrator::PATH, rays, run.count(2e4, 1e6, 1e7)));
        for (const double value : got)
            bad[build].count(!std::isfinite(value), [&] { return fmt::format("{}", value); });
        mean.see(build, got, floor_radiance(irradiance));
    }
}

void mis_grid(CaseRun& run) {
    ProbeSet probes(run.device, {"numerics/mis.h"}, {MIS});
    Figure& sum = run.figure("|w_a + w_b - 1|", 4 * FLOAT_U);
    Figure& error = run.figure("|w_a - a^2 / (a^2 + b^2)|", 4 * FLOAT_U);
    Figure& bad = run.figure("weights outside [0, 1] with a density of 0 or infinity", 0);
    Columns inputs(2), ends(2);
    for (double x = -38; x <= 38; x += 0.5)
        for (double y = -38; y <= 38; y += 0.5) {
            inputs[0].push_back(float(std::pow(10, x)));
            inputs[1].push_back(float(std::pow(10, y)));
        }
    Random random(1);
    for (size_t i = 0; i < run.count(1e5, 2e6, 8e6); ++i) {
        inputs[0].push_back(float(random.between(0.5, 2)));
        inputs[1].push_back(float(random.between(0.5, 2)));
    }
    const float inf = std::numeric_limits<float>::infinity();
    for (const float a : {0.0f, 1e-38f, 1.0f, 1e38f, inf})
        for (const float b : {0.0f, 1e-38f, 1.0f, 1e38f, inf}) {
            if (a == inf && b == inf) // two delta functions never meet
                continue;
            ends[0].push_back(a);
            ends[1].push_back(b);
        }
    for (const Build build : run.builds()) {
        const auto got = probes.run(build, "mis", inputs), at_ends = probes.run(build, "mis", ends);
        for (size_t i = 0; i < got[0].size(); ++i) {
            const auto describe = [&] { return fmt::format("{:a} {:a}", inputs[0][i], inputs[1][i]); };
            const double a = double(inputs[0][i]), b = double(inputs[1][i]);
            sum[build].see(std::abs(got[0][i] + got[1][i] - 1), describe);
            error[build].see(std::abs(got[0][i] - a * a / (a * a + b * b)), describe);
        }
        for (size_t i = 0; i < at_ends[0].size(); ++i)
            for (const double w : {at_ends[0][i], at_ends[1][i]})
                bad[build].count(!(w >= 0 && w <= 1),
                                 [&] { return fmt::format("{} {}", ends[0][i], ends[1][i]); });
    }
}

void light_in_a_box(CaseRun& run) {
    Figure& leaks = run.figure("paths from outside that see the light", 0);
    Figure& edges = run.figure("share of paths to edges and corners that do", 0);
    ScratchScene scene;
    scene.build.material("wall", "Kd 0.8 0.8 0.8").material("lamp", "Kd 0 0 0\nKe 1e6 1e6 1e6");
    scene.build.use("wall")
        .floor(4, -1.5)
        .box({-1, -1, -1}, {1, 1, 1})
        .use("lamp")
        .icosphere({0, 0, 0}, 0.5, 1);
    scene.options.light.points.push_back({{0.7, 0.7, 0.7}, dvec3(1e6)});
    scene.options.transport.max_depth = 8;
    const PathProbe probe(run.device, scene);
    Random random(2);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < run.count(2e4, 1e6, 1e7); ++i) {
        // Through the box, to its faces, edges and corners, and to the floor below.
        dvec3 at = random.in_cube(1), from = 3.0 * random.direction();
        for (size_t k = 0; k < i % 5 && i % 5 < 4; ++k)
            at[int((i + k) % 3)] = random.word() & 1 ? 1 : -1;
        if (i % 5 == 4) {
            at.y = -1.5;
            from.y = -1.2;
        }
        rays.push_back(probe.ray(from, at));
    }
    for (const Build build : path_builds(run))
        for (const Integrator integrator : TREE_AND_PATH) {
            const std::vector<dvec3> got = probe.radiance(build, integrator, rays);
            double at_edges = 0;
            for (size_t i = 0; i < got.size(); ++i)
                if (i % 5 == 2 || i % 5 == 3)
                    at_edges += got[i].x != 0;
                else
                    leaks[build].count(got[i].x != 0, [&] { return fmt::format("ray {}: {}", i, got[i].x); });
            edges[build].see(at_edges / (0.4 * double(got.size())),
                             [&] { return fmt::format("{} of {}", at_edges, got.size() * 2 / 5); });
        }
}

void delta_lights(CaseRun& run) {
    Figure& point = run.figure("relative error of a sample, point light", 16 * FLOAT_U);
    Figure& sun = run.figure("relative error of a sample, sun", 8 * FLOAT_U);
    Random random(3);
    for (const bool is_sun : {false, true})
        for (int round = 0; round < 8; ++round) {
            FloorScene scene;
            const dvec3 towards = direction_at(random.between(0.1, 1), 2 * PI * random.unit());
            const dvec3 light = 1.5 * dvec3(towards.x, towards.z, towards.y);
            if (is_sun)
                scene.options.light.suns.push_back({light, dvec3(3), 0});
            else
                scene.options.light.points.push_back({light, dvec3(3)});
            const PathProbe probe(run.device, scene);
            std::vector<TestRay> rays;
            std::vector<double> expected;
            for (int i = 0; i < 64; ++i) {
                const dvec3 at(random.between(-0.9, 0.9), 0, random.between(-0.9, 0.9));
                rays.push_back(probe.ray(at + dvec3(0.1, 0.5, 0.2), at));
                // Where the rounded ray meets the floor, in the scene's units.
                const dvec3 o = to_dvec3(rays.back().origin), d = to_dvec3(rays.back().direction);
                const double floor = probe.scene().positions[0].y;
                const dvec3 hit = (o + d * ((floor - o.y) / d.y)) / probe.scene().normalisation.scale +
                                  probe.scene().normalisation.centre;
                const dvec3 way = light - hit;
                expected.push_back(floor_radiance(is_sun ? 3 * glm::normalize(light).y
                                                         : 3 * way.y / std::pow(glm::length(way), 3)));
            }
            for (const Build build : path_builds(run))
                for (const Integrator integrator : TREE_AND_PATH) {
                    const std::vector<dvec3> got = probe.radiance(build, integrator, rays);
                    for (size_t i = 0; i < got.size(); ++i)
                        (is_sun ? sun : point)[build].see(std::abs(got[i].x / expected[i] - 1), [&] {
                            return fmt::format("round {}, ray {}", round, i);
                        });
                }
        }
}

} // namespace

ProbeTime time_mis_weight(const ProbeDevice& device, int rounds) {
    Random random(1);
    Columns inputs(2);
    for (int i = 0; i < 1 << 20; ++i) {
        inputs[0].push_back(float(random.between(0.01, 10)));
        inputs[1].push_back(float(random.between(0.01, 10)));
    }
    return ProbeSet(device, {"numerics/mis.h"}, {MIS}).time("mis", inputs, rounds);
}

const std::vector<StabilityCase>& light_cases() {
    static const std::vector<StabilityCase> cases = {
        {"L01", "TinyLamp", "a triangle of side 1e-6 at distance 1 over a floor",
         "area times both cosines over the squared distance",
         "its side is a few thousand roundings of its place", tiny_lamp},
        {"L02", "HugeLamp", "a square of side 1e5 at distance 1", "Lambert's formula for polygons in double",
         "noise", huge_lamp},
        {"L03", "InTheLampsPlane",
         "a floor beside a lamp in one plane, points up to 1e-7 from edge and corner", "no light",
         "a law; a tilted plane's corners are off it by a rounding, which lights as much as it is wide",
         in_the_lamps_plane},
        {"L04", "DarkLights", "lamps without area or power among 1e4",
         "never chosen, by enumeration of the table", "a law", dark_lights},
        {"L06", "SolidAngle", "triangles from 1e-10 to 6.2 sr, seen at 75 degrees at most",
         "van Oosterom and Strackee in double",
         "a triangle below 3e-4 sr at a distance of 1 has edges of few roundings; the sum of the angles less "
         "pi (naive) "
         "cancels",
         solid_angles},
        {"L07", "ManyLights", "a million lights of powers over eight decades",
         "enumeration of the integer table", "thresholds are multiples of 2^-32 of a share", many_lights},
        {"L08", "AllPowers", "lamps of radiance 1e-20 to 1e20 in one estimate",
         "the sum of Lambert's formulas", "noise", all_powers},
        {"L09", "MisGrid", "densities from 1e-38 to 1e38, 0 and infinity",
         "w_a + w_b = 1, the power heuristic", "four roundings of values up to 1", mis_grid},
        {"L10", "LightInABox",
         "lamps inside a closed box over a floor, seen from outside at faces, edges, corners, and on the "
         "floor",
         "0",
         "a law; a ray that meets an edge hits both faces at one distance but for roundings, and where that "
         "is the "
         "face seen from behind, the face before it hides its point",
         light_in_a_box},
        {"L11", "DeltaLights", "points and suns over a floor", "I cos / d^2 and E cos",
         "4 ULP, and the place of the hit: half an ULP of the floor's size changes d^3 threefold",
         delta_lights},
    };
    return cases;
}

} // namespace clrt
