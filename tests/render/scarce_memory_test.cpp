// SPDX-License-Identifier: Apache-2.0
// Memory that runs out after the last sample costs layers, never the picture: each of the large allocations
// behind a finished render fails once.
#include "error.h"
#include "probes/kernel_probe.h"
#include "run/saving.h"
#include "support/render_scene.h"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <new>
#include <OpenImageIO/imageio.h>

namespace {

/// Allocations from this size on are counted: three floats a pixel of the picture below.
constexpr size_t LARGE_BYTES = size_t(3) * 4 * 64 * 512;
/// How many of them still succeed before one fails; negative: all do.
std::atomic<int> successes_left{-1};

} // namespace

// Not inline: compilers take malloc and free beside new and delete for a mistake.
[[gnu::noinline]] void* operator new(size_t bytes) {
    if (bytes >= LARGE_BYTES && successes_left >= 0 && successes_left-- == 0)
        throw std::bad_alloc();
    if (void* memory = std::malloc(bytes))
        return memory;
    throw std::bad_alloc();
}

[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}

[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept {
    std::free(memory);
}

namespace clrt {

TEST(ScarceMemory, CostsLayersAndNeverThePicture) {
    TestScene test;
    test.build.material("matte", "Kd 0.5 0.5 0.5").use("matte").floor(4);
    test.look({0, 1.5, 3}, {0, 0, 0}, 45);
    test.options.transport.integrator = Integrator::RAYCAST;
    test.options.film.size = {64, 512};
    test.options.sampling.spp = 8;
    test.options.sampling.replicates = 8;
    const std::string file = test.folder.file("a.exr");
    test.options.output.files = {file};
    const Scene scene = test.load();
    const Options& options = test.options;
    const Effects effects = find_effects(scene, options);
    const Render render = render_loaded(scene, options);
    ASSERT_FALSE(render.hits.empty());

    const std::optional<DeviceFacts> facts;
    const Bvh bvh;
    int failed = 0, without_layers = 0;
    for (;; ++failed) {
        std::filesystem::remove(file);
        FinalFiles files;
        successes_left = failed;
        Report report{options, scene, effects, test_device().info,
                      facts,   bvh,   render,  make_error_report(render, {}, 0, 0),
                      "",      {},    0,       0,
                      0};
        write_outputs(report, files);
        const bool all_succeeded = successes_left >= 0;
        successes_left = -1;
        const auto input = OIIO::ImageInput::open(file);
        ASSERT_TRUE(input) << "allocation " << failed << ": no picture";
        EXPECT_GE(input->spec().channelindex("G"), 0);
        if (all_succeeded)
            break;
        if (input->spec().channelindex("N.X") < 0) {
            ++without_layers;
            EXPECT_FALSE(files.complete()) << "it is said";
        }
    }
    EXPECT_GE(failed, 5) << "the picture, albedo, N, P, variance";
    EXPECT_GE(without_layers, 5);
}

} // namespace clrt
