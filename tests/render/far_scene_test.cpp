// SPDX-License-Identifier: Apache-2.0
// A scene in map coordinates has the bits of the same scene at the origin.
#include "console/progress.h"
#include "scene/load_scene.h"
#include "support/render_scene.h"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace clrt {

namespace {

/// The Cornell box that is shipped, each position moved by whole numbers. Its coordinates have one decimal,
/// and so have the moved ones.
///
/// Why the bits are the same: coordinates below 2^23 are doubles within 2^-31 of their decimals; so is the
/// centre, half a sum of two of them, within 2^-30, and a difference of both is within 2^-29 = 2e-9 of the
/// decimal that it stands for. Rounding that to float gives another result only if a middle between two
/// floats lies in between. In units 2^-m of such floats (m at least 1) a decimal k / 10 is k 2^(m-1) / 5, a
/// whole number of fifths, so at least a tenth of a unit away from a middle, which is a whole number and a
/// half. The smallest difference that occurs, 1.4 (the eye's height), has the unit 2^-23: a tenth of it
/// is 1.2e-8.
std::string moved_box(const ScratchFolder& folder, const glm::ivec3& by) {
    const std::string from = CLRT_SCENES_FOLDER "/cornell_box/";
    std::ifstream file(from + "cornell_box.obj");
    std::string text, line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string keyword;
        glm::dvec3 p;
        if (words >> keyword && keyword == "v" && words >> p.x >> p.y >> p.z)
            line = fmt::format("v {:.1f} {:.1f} {:.1f}", p.x + by.x, p.y + by.y, p.z + by.z);
        text += line + "\n";
    }
    folder.write("box.obj", text);
    std::ifstream materials(from + "cornell_box.mtl");
    folder.write("cornell_box.mtl", std::string(std::istreambuf_iterator<char>(materials), {}));
    return folder.file("box.obj");
}

Options box_options(const glm::dvec3& by) {
    Options options;
    options.film.size = {48, 40};
    options.sampling.spp = 16;
    options.light.points.push_back({glm::dvec3(100, 500, 100) + by, glm::dvec3(3000, 2000, 1000)});
    options.camera.eye = glm::dvec3(278, 273, -800) + by;
    options.camera.at = glm::dvec3(278, 273, 0) + by;
    options.camera.fov_degrees = 39.3;
    return options;
}

Render render_box(const glm::ivec3& by) {
    const ScratchFolder folder;
    Options options = box_options(by);
    options.scene.path = moved_box(folder, by);
    Progress silent(Toggle::OFF, true);
    return render_loaded(load_scene(options, silent), options);
}

} // namespace

TEST(FarScene, MapCoordinatesGiveTheBitsOfTheOrigin) {
    const Render near = render_box({0, 0, 0});
    EXPECT_EQ(near.counts.bad(), 0u);
    for (const glm::ivec3& by : {glm::ivec3(5400000, 0, 0), glm::ivec3(691608, 5337000, -8000000)}) {
        const Render far = render_box(by);
        EXPECT_TRUE(near.film.sums == far.film.sums) << by.x;
        EXPECT_EQ(near.counts.rays(), far.counts.rays());
    }
}

} // namespace clrt
