// SPDX-License-Identifier: Apache-2.0
// Layers of the primary hits are sampled as the picture is, whatever ends it and wherever it went on from,
// and never cost the picture.
#include "clrt_command.h"

#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

class HitLayersCommand : public ClrtCommand {
protected:
    /// A slanted triangle of radiance 1, black elsewhere: the picture is the coverage of its pixels.
    HitLayersCommand() {
        folder.write("scene.mtl", "newmtl lamp\nKd 0.4 0.4 0.4\nKe 1 1 1\n");
        folder.write("scene.obj",
                     "mtllib scene.mtl\nusemtl lamp\nv -1 -0.8 0\nv 0.9 -0.3 0.2\nv 0.1 1 -0.1\nf 1 2 3\n");
    }

    /// Renders a picture of 24 x 20 pixels with all layers, the lamp by the samples that alpha is by.
    void render(const std::string& name, std::vector<std::string> further) const {
        for (const char* word : {"scene.obj", "-r", "24x20", "--eye", "0,0,4", "--at", "0,0,0", "--aov",
                                 "alpha,albedo,N,Z,P,objectId,samples", "--emission-rays", "1", "-o"})
            further.emplace_back(word);
        further.push_back(name);
        const CommandResult result = clrt(further);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }

    /// Alpha is the picture in every pixel, and in some it is neither 0 nor 1.
    void expect_alpha_is_the_picture(const std::string& name) const {
        const ReadPicture picture(folder.file(name));
        int edges = 0;
        for (int y = 0; y < picture.spec.height; ++y)
            for (int x = 0; x < picture.spec.width; ++x) {
                const float alpha = picture.at(x, y, "A");
                EXPECT_FLOAT_EQ(alpha, picture.at(x, y, "G")) << name << " " << x << "," << y;
                edges += alpha > 0 && alpha < 1;
            }
        EXPECT_GT(edges, 20) << name;
    }

    /// All channels of both files are the same.
    void expect_same_pictures(const std::string& a, const std::string& b) const {
        const ReadPicture one(folder.file(a)), other(folder.file(b));
        ASSERT_EQ(one.spec.channelnames, other.spec.channelnames);
        for (size_t i = 0; i < one.values.size(); ++i) {
            const bool both_nan = std::isnan(one.values[i]) && std::isnan(other.values[i]);
            ASSERT_TRUE(one.values[i] == other.values[i] || both_nan) << a << ", " << b << ": value " << i;
        }
    }
};

} // namespace

TEST_F(HitLayersCommand, LittleDeviceMemoryCostsNoLayers) {
    if (test_device_name() != "pocl")
        GTEST_SKIP() << "only PoCL's memory can be limited";
    // A gigabyte, of which one buffer takes a quarter: the layers of all pixels at once would not fit.
    CommandSettings little;
    little.environment["POCL_MEMORY_LIMIT"] = "1";
    const CommandResult result =
        clrt({"scene.obj", "-i", "raycast", "-s", "1", "-r", "2600x2300", "--replicates", "1", "--eye",
              "0,0,40", "--at", "0,0,0", "--aov", "alpha", "-o", "a.exr"},
             little);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const ReadPicture picture(folder.file("a.exr"));
    double sum = 0;
    for (int y = 0; y < picture.spec.height; ++y)
        for (int x = 0; x < picture.spec.width; ++x) {
            const float alpha = picture.at(x, y, "A");
            ASSERT_EQ(alpha, picture.at(x, y, "G")) << x << "," << y;
            sum += double(alpha);
        }
    EXPECT_GT(sum, 1000);
}

TEST_F(HitLayersCommand, AlphaIsTheCoverageOfThePicture) {
    for (const char* spp : {"64", "100", "3000"}) {
        render("a.exr", {"-i", "raycast", "-s", spp});
        expect_alpha_is_the_picture("a.exr");
    }
    render("path.exr", {"-s", "40", "--replicates", "5"});
    expect_alpha_is_the_picture("path.exr");
    render("wide.exr", {"-s", "40", "--filter", "gaussian:1.5"});
    expect_alpha_is_the_picture("wide.exr");
}

TEST_F(HitLayersCommand, GuidesOfDenoisersAreAsSoftAsThePicture) {
    render("a.exr", {"-i", "raycast", "-s", "64", "--aov", "denoisingAlbedo,denoisingNormal"});
    const ReadPicture picture(folder.file("a.exr"));
    int edges = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x) {
            const float alpha = picture.at(x, y, "A");
            EXPECT_FLOAT_EQ(picture.at(x, y, "denoisingAlbedo.G"), alpha * picture.at(x, y, "albedo.G"));
            EXPECT_NEAR(picture.at(x, y, "denoisingNormal.Z"), alpha * picture.at(x, y, "N.Z"), 1e-6);
            edges += alpha > 0 && alpha < 1 && picture.at(x, y, "albedo.G") > 0.1f;
        }
    EXPECT_GT(edges, 20);
}

TEST_F(HitLayersCommand, UnaskedLayersAreMeansOverSixteenSamples) {
    const auto depths = [&](const std::string& name, std::vector<std::string> further) {
        for (const char* word :
             {"scene.obj", "-i", "raycast", "-r", "24x20", "--eye", "0,0,4", "--at", "0,0,0", "-o"})
            further.emplace_back(word);
        further.push_back(name);
        EXPECT_EQ(clrt(further).exit_code, 0);
        const ReadPicture picture(folder.file(name));
        std::vector<float> values;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 24; ++x)
                if (const float depth = picture.at(x, y, "Z"); std::isfinite(depth))
                    values.push_back(depth);
        return values;
    };
    const std::vector<float> unasked = depths("a.exr", {"-s", "64"});
    EXPECT_EQ(unasked, depths("b.exr", {"-s", "16"}));
    EXPECT_NE(unasked, depths("c.exr", {"-s", "64", "--aov", "Z"}));
}

TEST_F(HitLayersCommand, AdaptiveTilesHaveTheSamplesOfThePicture) {
    render("a.exr", {"-i", "raycast", "-s", "96", "--adaptive", "--checkpoint", "a.film"});
    expect_alpha_is_the_picture("a.exr");
    const ReadPicture picture(folder.file("a.exr"));
    bool tiles_differ = false;
    for (int x = 0; x < 24; x += 8)
        for (int y = 0; y < 16; y += 8)
            tiles_differ |= picture.at(x, y, "samples") != picture.at(0, 0, "samples");
    EXPECT_TRUE(tiles_differ);
    render("b.exr", {"-i", "raycast", "-s", "192", "--adaptive", "--resume", "a.film"});
    render("c.exr", {"-i", "raycast", "-s", "192", "--adaptive"});
    expect_alpha_is_the_picture("b.exr");
    expect_same_pictures("b.exr", "c.exr");
}

TEST_F(HitLayersCommand, RangesAndResumedRunsAreSampledWhole) {
    render("a.exr", {"-i", "raycast", "-s", "37", "--first-sample", "1000", "--checkpoint", "a.film"});
    expect_alpha_is_the_picture("a.exr");
    render("b.exr", {"-i", "raycast", "-s", "100", "--first-sample", "1000", "--resume", "a.film"});
    render("c.exr", {"-i", "raycast", "-s", "100", "--first-sample", "1000"});
    expect_alpha_is_the_picture("b.exr");
    expect_same_pictures("b.exr", "c.exr");
}

TEST_F(HitLayersCommand, ACropHasTheLayersOfTheWholePicture) {
    render("whole.exr", {"-i", "raycast", "-s", "20"});
    render("part.exr", {"-i", "raycast", "-s", "20", "--crop", "5,3,20,17"});
    const ReadPicture whole(folder.file("whole.exr")), part(folder.file("part.exr"));
    for (int y = 3; y < 17; ++y)
        for (int x = 5; x < 20; ++x)
            for (const char* channel : {"A", "N.X", "N.Z", "P.X", "P.Y", "Z", "objectId"})
                ASSERT_EQ(part.at(x - 5, y - 3, channel), whole.at(x, y, channel)) << channel;
}

TEST_F(HitLayersCommand, LayersThatFailCostNoPicture) {
    // A kernel that no device launches: its work-groups are not those of the launch.
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    std::string source = folder.read("kernels/integrators/aov.cl");
    const std::string size = "reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1)";
    ASSERT_NE(source.find(size), source.npos);
    source.replace(source.find(size), size.size(), "reqd_work_group_size(3, 1, 1)");
    folder.write("kernels/integrators/aov.cl", source);
    const CommandResult result = clrt({"scene.obj", "-i", "raycast", "-r", "24x20", "-s", "4", "--kernels",
                                       "kernels", "-o", "a.exr", "--stats", "s.json"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_TRUE(
        holds(result.err, {"without the layers of hits", "CL_INVALID_WORK_GROUP_SIZE", "wrote a.exr"}));
    const ReadPicture picture(folder.file("a.exr"));
    EXPECT_EQ(picture.spec.channelindex("N.X"), -1);
    EXPECT_GE(picture.spec.channelindex("samples"), 0) << "what comes from the film is there";
    EXPECT_EQ(picture.at(12, 10, "G"), 1);
    EXPECT_TRUE(holds(folder.read("s.json"), {"\"spp\": 4"}));
}

} // namespace clrt
