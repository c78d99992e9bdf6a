// SPDX-License-Identifier: Apache-2.0
// Bidirectional path tracing changes no mean: compared with `path`, and with `path+light` under lights that
// no ray meets, tile by tile; and with closed forms. Its weights sum to 1:
// tests/kernel/bdpt_weights_test.cpp.
#include "device/kernel_source.h"
#include "render/bdpt_oracle.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

void expect_bdpt_is(const Room& room, Integrator integrator, double sharpness) {
    expect_equal(tile_means(room, room.options, Integrator::BDPT, ""),
                 tile_means(room, room.options, integrator, ""), sharpness);
}

/// The mean radiance in a closed box whose walls reflect `albedo` and emit 1 - albedo.
Estimate closed_furnace(double albedo, int depth) {
    TestScene scene;
    scene.build.material("wall", fmt::format("Kd {0} {0} {0}\nKe {1} {1} {1}", albedo, 1 - albedo))
        .use("wall")
        .box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    scene.look({0.1, 0.2, 0.7}, {0.2, -0.1, -0.5}, 70);
    scene.options.transport.integrator = Integrator::BDPT;
    scene.options.transport.max_depth = depth;
    return film_estimate(scene.render().film);
}

/// The kernels with the oracle in place of the integrator.
std::string oracle_kernels(const ScratchFolder& folder) {
    KernelFiles files = kernels_under_test();
    std::string& entry = files.at("integrators/bdpt.cl");
    const std::string define = "#define INTEGRATOR_RADIANCE bdpt_radiance";
    const size_t at = entry.find(define);
    if (at == std::string::npos)
        throw std::runtime_error("not in integrators/bdpt.cl: " + define);
    entry.replace(at, define.size(),
                  BDPT_ORACLE + std::string("#define INTEGRATOR_RADIANCE oracle_radiance"));
    for (const auto& [file, text] : files) {
        const std::filesystem::path to = folder.file(file);
        std::filesystem::create_directories(to.parent_path());
        folder.write(file, text);
    }
    return folder.file("");
}

/// A lamp in a tube under the ceiling: the camera sees its light scattered twice, off a spot that few paths
/// from the eye meet.
struct TubeRoom : Room {
    TubeRoom() {
        build.use("lamp").raw("o lamp").polygon(
            {{-0.2, 1.6, -0.2}, {-0.2, 1.6, 0.2}, {0.2, 1.6, 0.2}, {0.2, 1.6, -0.2}});
        build.use("matte").box({-0.25, 1.5, -0.25}, {0.25, 1.55, 0.25});
        for (const double side : {-1.0, 1.0}) {
            build.box({side * 0.25 - 0.02, 1.5, -0.25}, {side * 0.25 + 0.02, 2.7, 0.25});
            build.box({-0.25, 1.5, side * 0.25 - 0.02}, {0.25, 2.7, side * 0.25 + 0.02});
        }
        build.polygon({{-3, 3, -2}, {3, 3, -2}, {3, 3, 2}, {-3, 3, 2}});
    }
};

} // namespace

TEST(Bidirectional, WeightsAreThoseOfAllDensitiesMultipliedOut) {
    const ScratchFolder folder;
    for (const Precision precision : {Precision::SINGLE, Precision::DOUBLE}) {
        if (precision == Precision::DOUBLE && !test_device().info.fp64)
            continue;
        Room room;
        room.add_lamp();
        room.add_caustics();
        room.options.transport.integrator = Integrator::BDPT;
        room.options.transport.max_depth = 7;
        room.options.device.precision = precision;
        room.options.device.kernels_folder = oracle_kernels(folder);
        room.options.transport.emission_rays = 1; // weights are of paths
        room.options.effects.all = false;         // no other test shares the program
        const Film film = room.render().film;
        const double paths = film_estimate(film, 0).mean;
        EXPECT_GT(paths, 0.02);
        // Next to an edge a few paths lose digits.
        for (const int wrong : {1, 2})
            EXPECT_LT(film_estimate(film, wrong).mean, 2e-3 * paths) << wrong;
    }
}

TEST(Bidirectional, ChangesNoMeanUnderAnyKindOfLight) {
    for (const Lighting& lighting : lightings()) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.options.transport.roulette_depth = 1; // it has no part in the weights
        if (lighting.is_delta)
            room.add_hidden_mirrors();
        else
            room.add_caustics();
        // Where `path` cannot meet the light, splats find what mirrors do with it.
        expect_bdpt_is(room, lighting.is_delta ? Integrator::PATH_LIGHT : Integrator::PATH, 0.08);
    }
}

TEST(Bidirectional, LeavesBentNormalsAndCurvedFacetsToTheEye) {
    Room room;
    room.add_lamp();
    room.add_caustics();
    room.add_bent_normals();
    room.options.sampling.spp = 2048;
    expect_bdpt_is(room, Integrator::PATH, 0.05);
}

TEST(Bidirectional, LeavesNormalsThatAreSeenFromFarBehindToTheEye) {
    // Ridges along a floor that the camera looks at flatly.
    Room room;
    room.add_lamp();
    room.texture8("ridges.png", 2, 2, 1, {60, 200, 60, 200});
    room.build.material("ridges", "Kd 0.7 0.7 0.7\nbump -bm 20 -s 1 1 1 ridges.png").use("ridges");
    room.build.textured_quad({{-1.5, 0.1, 1.5}, {1.5, 0.1, 1.5}, {1.5, 0.1, -1}, {-1.5, 0.1, -1}});
    room.look({1.5, 0.8, 3.5}, {0, 0.1, 0.2}, 40);
    room.options.transport.max_depth = 2;
    room.options.sampling.spp = 2048;
    expect_bdpt_is(room, Integrator::PATH, 0.02);
}

TEST(Bidirectional, ConnectsAtOneTimeThroughALens) {
    // All that is seen has moved in between, the lamp has not; what is in front of the focus is blurred.
    Room room;
    room.add_lamp();
    room.add_caustics();
    SceneBuilder& build = room.build;
    const auto add_mover = [](SceneBuilder& to, double x) {
        to.use("metal").box({x, 0.4, 0.6}, {x + 0.3, 1.3, 0.9});
    };
    SceneBuilder at_end = build;
    add_mover(build, -1);
    add_mover(at_end, 0.5);
    room.options.scene.end_path = room.folder.write("end.obj", at_end.obj("scene.mtl"));
    room.options.camera.end_eye = glm::dvec3(0.3, 1.7, 4);
    room.options.camera.aperture = 0.3;
    room.options.camera.focus = 4;
    room.options.sampling.spp = 1024;
    expect_bdpt_is(room, Integrator::PATH, 0.05);
}

TEST(Bidirectional, ConnectsInsideGlassWithTheSquaredIndexOnce) {
    // The eye is in a glass sea whose bottom and a wall in it are lit through the surface.
    Room room;
    room.build.use("glass").floor(8, 1.8);
    room.options.light.environment = glm::dvec3(1);
    room.options.sampling.spp = 1024;
    room.look({0, 1.5, 2}, {0, 0.5, -1}, 60);
    expect_bdpt_is(room, Integrator::PATH, 0.05);
}

TEST(Bidirectional, AClosedFurnaceHasItsSeriesUpToTheWholePathsDepth) {
    // The sum of (1 - a) a^k over the segments that max_depth allows, from all strategies together.
    for (const int depth : {2, 3, 4, 16})
        EXPECT_TRUE(agrees(closed_furnace(0.5, depth), 1 - std::pow(0.5, depth), 1e-2)) << depth;
}

TEST(Bidirectional, PathsThatScatterMoreOftenThanVerticesAreKeptLoseNoLight) {
    // A third of the light is missing where a kept vertex counts for itself alone.
    EXPECT_TRUE(agrees(closed_furnace(0.98, USUAL_PATH_DEPTH), 1, 1e-2));
}

TEST(Bidirectional, ACropIsAPartOfThePictureToTheBit) {
    expect_crop_is_a_part(Integrator::BDPT);
}

TEST(Bidirectional, InnerConnectionsTakeTheNoiseFromALampInATube) {
    TubeRoom room;
    const auto variance = [&](Integrator integrator) {
        double sum = 0;
        for (const double of_tile : tile_means(room, room.options, integrator, "").variance)
            sum += of_tile;
        return sum;
    };
    EXPECT_LT(variance(Integrator::BDPT), 0.3 * variance(Integrator::PATH));
}

} // namespace clrt
