// SPDX-License-Identifier: Apache-2.0
// How many samples of the shipped scenes take another path in single precision than in double, and at which
// decision: few, and none because of a side or a lobe where the scene is plain.
#include "app/command_line.h"
#include "app/progress.h"
#include "effects/take_out.h"
#include "replay/flips.h"
#include "scene/load_scene.h"
#include "support/kernel_probe.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fs = std::filesystem;

namespace clrt {

namespace {

/// Samples that may flip: a sample has a few dozen decisions on numbers that are off by some 1e-6.
constexpr double MOST_FLIPS = 0.01;

FlipStatistics flips_of(const std::string& name, Integrator integrator) {
    const std::string path = (fs::path(CLRT_SCENES_FOLDER) / name / (name + ".obj")).string();
    const char* const command[] = {"clrt", path.c_str()};
    Options options = parse_command_line(2, command).options;
    options.integrator = integrator;
    options.max_depth.reset();
    options.size = {64, 64};
    options.spp = std::getenv("CLRT_TEST_LONG") ? 256 : 16;
    Progress silent(Toggle::OFF, true);
    return find_flips(test_device(), load_scene(options, silent), options);
}

} // namespace

TEST(Flips, FewSamplesOfTheShippedScenesTakeAnotherPathInDouble) {
    if (!test_device().info.fp64)
        GTEST_SKIP() << "the device has no fp64";
    for (const char* const scene : {"cornell_box", "spheres_over_plane", "every_effect"}) {
        const FlipStatistics flips = flips_of(scene, Integrator::PATH);
        fmt::print("{}, path: {}", scene, format_flips(flips));
        EXPECT_GE(flips.samples, 64u * 64u * 16u);
        EXPECT_LT(flips.share(), MOST_FLIPS) << scene;
        // Whatever a flip does, it may not make a bad sample.
        for (const Flip& flip : flips.flips)
            for (size_t c = 0; c < 3; ++c)
                EXPECT_TRUE(std::isfinite(flip.single[c]) && std::isfinite(flip.in_double[c])) << scene;
    }
}

} // namespace clrt
