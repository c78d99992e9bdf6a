// SPDX-License-Identifier: Apache-2.0
// How many samples of the shipped scenes take another path in single precision than in double, and at which
// decision: few, and none because of a side or a lobe where the scene is plain.
#include "app/command_line.h"
#include "console/progress.h"
#include "effects/take_out.h"
#include "probes/kernel_probe.h"
#include "replay/flips.h"
#include "replay/quantities.h"
#include "scene/load_scene.h"
#include "support/test_device.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fs = std::filesystem;

namespace clrt {

namespace {

/// A scene and the shares of its samples that may flip, and flip by a side or a lobe.
struct FlippingScene {
    const char* name;
    double most, most_by_side_or_lobe;
};

/// A sample has some ten decisions, each on a number that is off by about 1e-6 of its range: 1e-5 of the
/// samples flip, ten times as many are still few. Curved glass and mirrors widen a difference about tenfold
/// at every bounce: behind the three or four of them inside the balls of every_effect it is 1e-3, for a few
/// paths in a hundred that get there. Sides and lobes of plain scenes are decided by numbers that are off by
/// one rounding, 6e-8: less than one sample in a million flips by them, none of the suite's.
constexpr FlippingScene SCENES[] = {
    {"cornell_box", 1e-4, 1e-6}, {"spheres_over_plane", 1e-4, 1e-6}, {"every_effect", 5e-3, 1e-4}};

/// Flips whose first decision is one of these.
double flips_by(const FlipStatistics& flips, const std::vector<u32>& decisions) {
    double sum = 0;
    for (const auto& [where, count] : flips.counts())
        for (const u32 decision : decisions)
            sum += where.first == quantity(decision).name ? double(count) : 0;
    return sum;
}

FlipStatistics flips_of(const std::string& name, Integrator integrator) {
    const std::string path = (fs::path(CLRT_SCENES_FOLDER) / name / (name + ".obj")).string();
    const char* const command[] = {"clrt", path.c_str()};
    Options options = parse_command_line(2, command).options;
    options.transport.integrator = integrator;
    options.transport.max_depth.reset();
    options.film.size = {64, 64};
    options.sampling.spp = tests_are_long() ? 256 : 16;
    Progress silent(Toggle::OFF, true);
    return find_flips(prepare_scene(test_device(), plan_scene(load_scene(options, silent), options)));
}

} // namespace

TEST(Flips, FewSamplesOfTheShippedScenesTakeAnotherPathInDouble) {
    if (!test_device().info.fp64)
        GTEST_SKIP() << "the device has no fp64";
    for (const FlippingScene& scene : SCENES) {
        const FlipStatistics flips = flips_of(scene.name, Integrator::PATH);
        fmt::print("{}, path: {}", scene.name, format_flips(flips));
        EXPECT_GE(flips.samples, 64u * 64u * 16u);
        EXPECT_LT(flips.share(), scene.most) << scene.name;
        EXPECT_LE(flips_by(flips, {TRACE_FRONT, TRACE_LOBE}),
                  scene.most_by_side_or_lobe * double(flips.samples))
            << scene.name;
        // Whatever a flip does, it may not make a bad sample.
        for (const Flip& flip : flips.flips)
            for (size_t c = 0; c < 3; ++c)
                EXPECT_TRUE(std::isfinite(flip.single[c]) && std::isfinite(flip.in_double[c])) << scene.name;
    }
}

} // namespace clrt
