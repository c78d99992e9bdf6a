// SPDX-License-Identifier: Apache-2.0
// The film does not depend on how its samples are dealt out to launches: at once, one by one, tiles last to
// first.
#include "film/film_buffers.h"
#include "probes/kernel_probe.h"
#include "render/launcher.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr u32 SAMPLES = 9;

/// A launch: samples from `first` on, tiles from `tile` up to `end`.
struct Launch {
    u32 first, count, tile, end;
};

/// Glass, a rough ball, a sky and a lamp: all kinds of light, long and short paths side by side.
PreparedScene make_scene(Integrator integrator, Toggle path_reuse) {
    TestScene scene;
    scene.build.material("white", "Kd 0.7 0.7 0.7").material("glass", "Ni 1.5\nillum 7");
    scene.build.material("rough", "Kd 0.2 0.2 0.2\nKs 0.6 0.6 0.6\nNs 30\nillum 2")
        .material("lamp", "Ke 8 7 5");
    scene.build.use("white").floor(4);
    scene.build.use("glass").icosphere({-0.5, 0.6, 0}, 0.5, 1, Facing::OUTWARD, Shading::SMOOTH);
    scene.build.use("rough").icosphere({0.6, 0.5, 0.2}, 0.4, 1);
    scene.build.use("lamp").polygon({{-0.4, 2, -0.4}, {0.4, 2, -0.4}, {0.4, 2, 0.4}, {-0.4, 2, 0.4}});
    scene.options.light.points.push_back({{-1, 2, 1}, {2, 2, 4}});
    scene.options.film.filter = Filter::GAUSSIAN;
    scene.options.film.size = {44, 29}; // tiles at the edges are not whole
    scene.options.sampling.replicates = 4;
    scene.options.transport.integrator = integrator;
    scene.options.transport.path_reuse = path_reuse;
    scene.look({0, 1.5, 3}, {0, 0.4, 0}, 45);
    return prepare_loaded(test_device(), scene.load(), scene.options);
}

/// A prepared scene and the films that launches leave.
class LaunchedScene {
public:
    explicit LaunchedScene(Integrator integrator, Toggle path_reuse = Toggle::OFF)
        : prepared_(make_scene(integrator, path_reuse)), params_(launch_params(*prepared_.planned)) {}

    u32 tiles() const { return params_.tile_count; }

    std::vector<std::int64_t> sums(const std::vector<Launch>& launches) const {
        FilmBuffers film(test_device(), params_, 0);
        Launcher launcher(test_device(), prepared_.programs->picture,
                          integrator_kernel(prepared_.planned->options.transport.integrator), params_,
                          prepared_.buffers);
        film.bind(launcher.kernel());
        for (const Launch& launch : launches)
            launcher.run(launch.first, launch.count, launch.tile, launch.end);
        RenderProgress render;
        render.film.width = int(params_.crop_width);
        render.film.height = int(params_.crop_height);
        render.film.replicates = int(params_.replicates);
        film.read_sums(render);
        return render.film.sums;
    }

    /// Seconds of all tiles with so many samples, as `device` counts them.
    double device_seconds(const Device& device, u32 samples) const {
        FilmBuffers film(device, params_, 0);
        Launcher launcher(device, prepared_.programs->picture,
                          integrator_kernel(prepared_.planned->options.transport.integrator), params_,
                          prepared_.buffers);
        film.bind(launcher.kernel());
        launcher.run(0, samples, 0, tiles());
        const double once = launcher.device_seconds();
        launcher.run(samples, samples, 0, tiles());
        EXPECT_GT(launcher.device_seconds(), once) << "they add up";
        return launcher.device_seconds();
    }

private:
    PreparedScene prepared_;
    RenderParams params_;
};

} // namespace

// By the processor's clock, and as for a device with one of its own: PoCL has that too.
TEST(Launcher, CountsTheDevicesOwnSeconds) {
    const LaunchedScene scene(Integrator::PATH);
    Device other = test_device();
    other.info.type = "GPU";
    const Device* const devices[] = {&test_device(), &other};
    for (const Device* device : devices) {
        scene.device_seconds(*device, 1); // the driver compiles
        const double few = scene.device_seconds(*device, 4);
        EXPECT_GT(few, 0) << device->info.type;
        EXPECT_GT(scene.device_seconds(*device, 256), 4 * few) << device->info.type;
    }
}

TEST(LaunchBits, DoNotDependOnTheSizesOrTheOrderOfLaunches) {
    for (const auto& [integrator, path_reuse] : {std::pair{Integrator::PATH, Toggle::OFF},
                                                 {Integrator::PATH, Toggle::ON},
                                                 {Integrator::DISTRIBUTION, Toggle::OFF},
                                                 {Integrator::WHITTED, Toggle::OFF},
                                                 {Integrator::RAYCAST, Toggle::OFF},
                                                 {Integrator::LIGHT, Toggle::OFF},
                                                 {Integrator::PATH_LIGHT, Toggle::OFF},
                                                 {Integrator::PATH_LIGHT, Toggle::ON},
                                                 {Integrator::BDPT, Toggle::OFF}}) {
        const LaunchedScene scene(integrator, path_reuse);
        const u32 tiles = scene.tiles();
        const std::vector<std::int64_t> at_once = scene.sums({{0, SAMPLES, 0, tiles}});
        EXPECT_NE(at_once, std::vector<std::int64_t>(at_once.size(), 0));

        std::vector<Launch> singly, backwards;
        for (u32 sample = 0; sample < SAMPLES; ++sample)
            for (u32 tile = 0; tile < tiles; ++tile)
                singly.push_back({sample, 1, tile, tile + 1});
        EXPECT_TRUE(scene.sums(singly) == at_once) << name_of(integrator);

        for (u32 end = tiles; end > 0; end -= std::min(end, 7u))
            for (const auto& [first, count] : {std::pair{5u, 4u}, {0u, 1u}, {1u, 4u}})
                backwards.push_back({first, count, end - std::min(end, 7u), end});
        EXPECT_TRUE(scene.sums(backwards) == at_once) << name_of(integrator);

        singly.pop_back();
        EXPECT_FALSE(scene.sums(singly) == at_once) << "a sample less must show";
    }
}

} // namespace clrt
