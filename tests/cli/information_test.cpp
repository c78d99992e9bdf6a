// SPDX-License-Identifier: Apache-2.0
// What clrt says without rendering, and the options file beside a scene.
#include "clrt_command.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class Information : public ClrtCommand {
protected:
    int width_of(const std::string& picture) const { return ReadPicture(folder.file(picture)).spec.width; }
};

} // namespace

TEST_F(Information, HelpNamesEveryOptionAndNeedsNothing) {
    for (const char* flag : {"--help", "-h"}) {
        const auto result = clrt({flag, "--nonsense"});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.err, "");
        EXPECT_TRUE(holds(result.out, {"Usage: clrt [options] scene.obj", "--device", "--spp", "--env",
                                       "--explain", "--kernels", "Exit codes", "130"}));
    }
}

TEST_F(Information, VersionIsOneLine) {
    const auto result = clrt({"--version"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out, "clrt " CLRT_VERSION "\n");
}

TEST_F(Information, DevicesAreListed) {
    const auto result = clrt({"--list-devices"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.out, {"index", "platform", "device", "0:0"}));
    EXPECT_EQ(clrt({"-l"}).out, result.out);
    EXPECT_TRUE(listing().empty());
}

TEST_F(Information, TheVerboseListSaysHowDevicesCompute) {
    const auto result = clrt({"--list-devices", "-v"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.out, {"0:0  ", " bits", "division 0.50", "pow "}));
}

TEST_F(Information, WithoutAnyDriverTheListSaysSo) {
    CommandSettings settings;
    settings.environment["OCL_ICD_VENDORS"] = folder.file("no-drivers");
    const auto result = clrt({"--list-devices"}, settings);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_FALSE(result.out.empty());
}

TEST_F(Information, ExplainTellsWhatWouldBeRenderedAndWritesNothing) {
    write_square("scene", "mtllib none.mtl\n");
    const auto result = clrt({"scene.obj", "--explain"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.out, {"scene.obj (2 triangles)", "present  matte ", "absent   refraction",
                                   "Materials:", "Notices:", "none.mtl", "a studio"}));
    EXPECT_EQ(listing(), std::vector<std::string>{"scene.obj"});
}

TEST_F(Information, ExplainAsJsonCanBeRead) {
    write_square("scene");
    const auto result = clrt({"scene.obj", "--explain=json", "-q"});
    EXPECT_EQ(result.exit_code, 0);
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["triangles"], 2);
    EXPECT_GT(json["effects"].size(), 10u);
}

TEST_F(Information, LeavingAnEffectOutIsSaidAndNearMissesAreToldTheName) {
    write_square("scene");
    const auto result = clrt(quick({"scene.obj", "--effects", "-matte"}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.err, {"leaves out matte: no material has a matte lobe"}));
    const auto wrong = clrt(quick({"scene.obj", "--effects=area-lihts"}));
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_TRUE(holds(wrong.err, {"the nearest to 'area-lihts' is area-lights", "rough-refraction"}));
}

TEST_F(Information, TheLedgerBillsEveryEffectAndWritesNoPicture) {
    write_square("scene");
    const auto result =
        clrt({"scene.obj", "--ledger", "-s", "2", "-r", "16x12", "--env", "1,1,1", "--stats", "bill.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, {"Ledger of scene.obj: 16 x 12, path", "environment", "matte",
                                   "interreflection", "by the full program", "Compiling for the scene"}));
    EXPECT_EQ(listing(), (std::vector<std::string>{"bill.json", "scene.obj"}));
    const auto json = nlohmann::json::parse(folder.read("bill.json"));
    ASSERT_EQ(json["effects"].size(), 3u);
    EXPECT_EQ(json["spp"], 2);
    // All light comes from the sky; a square does not light itself.
    EXPECT_EQ(json["effects"][0]["light_share"]["median"], 1.0);
    EXPECT_EQ(json["effects"][2]["light_share"]["high"], 0.0);
    EXPECT_GT(json["effects"][1]["light_share"]["low"], 0.0);
    EXPECT_LT(json["effects"][1]["light_share"]["high"], 1.0);
}

TEST_F(Information, TheLedgerBillsTheCodeOfAbsentEffects) {
    write_square("scene");
    const auto result = clrt({"scene.obj", "--ledger=absent", "-s", "1", "-r", "16x12", "--env", "1,1,1",
                              "--time", "1", "--stats", "-"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"Ledger of what is not in scene.obj", "by the full program"}));
    EXPECT_EQ(listing(), (std::vector<std::string>{"scene.obj"}));
    const auto json = nlohmann::json::parse(result.out, nullptr, false);
    ASSERT_TRUE(json.is_object()) << "not only JSON:\n" << result.out;
    std::vector<std::string> names = json["not_measured"];
    for (const auto& row : json["absent_effects"])
        names.push_back(row["name"]);
    std::sort(names.begin(), names.end());
    // Without textures and refraction the code of normal maps and rough refraction has no price of its own.
    EXPECT_EQ(names, (std::vector<std::string>{"area lights",
                                               "coat",
                                               "conductors",
                                               "cut-outs",
                                               "depth of field",
                                               "environment map",
                                               "glossy",
                                               "instances",
                                               "light tree",
                                               "measured reflection",
                                               "mirror",
                                               "motion blur",
                                               "path filter",
                                               "pixel filter",
                                               "point lights and suns",
                                               "refraction",
                                               "rotated highlights",
                                               "sheen",
                                               "smooth normals",
                                               "textures",
                                               "thin walls"}));
}

TEST_F(Information, ExplainNeedsNoDevice) {
    write_square("scene");
    CommandSettings settings;
    settings.environment["OCL_ICD_VENDORS"] = folder.file("no-drivers");
    EXPECT_EQ(clrt({"scene.obj", "--explain"}, settings).exit_code, 0);
}

TEST_F(Information, TheOptionsFileBesideASceneIsReadAndNamed) {
    write_square("scene");
    folder.write("scene.clrt",
                 "# a picture of 20 columns\r\n--size 20x10\r\n\r\n--spp 1\r\n--integrator raycast\r\n"
                 "--output from file.png\n");
    const auto result = clrt({"scene.obj"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"options file: scene.clrt"}));
    EXPECT_EQ(width_of("from file.png"), 20);
}

TEST_F(Information, TheCommandLineWinsOverTheOptionsFile) {
    write_square("scene");
    folder.write("scene.clrt",
                 "--size 20x10\n--spp 1\n--integrator raycast\n--fov 40\n--point 0,0,3,1,1,1\n");
    EXPECT_EQ(clrt({"scene.obj", "-r", "24x10"}).exit_code, 0);
    EXPECT_EQ(width_of("scene.png"), 24);
    EXPECT_EQ(clrt({"scene.obj", "--focal-length", "1", "--film-width", "1"}).exit_code, 0)
        << "of two ways to say it, too";
}

TEST_F(Information, NoSidecarLeavesTheOptionsFileUnread) {
    write_square("scene");
    folder.write("scene.clrt", "this is no option\n");
    EXPECT_EQ(clrt(quick({"scene.obj"})).exit_code, 2);
    EXPECT_EQ(clrt(quick({"scene.obj", "--no-sidecar"})).exit_code, 0);
    EXPECT_EQ(width_of("scene.png"), 16);
}

TEST_F(Information, PathsInTheOptionsFileCountFromItsFolder) {
    std::filesystem::create_directory(folder.file("scenes"));
    write_square("scenes/scene");
    folder.write("scenes/scene.clrt", "--output picture.png\n");
    EXPECT_EQ(clrt(quick({"scenes/scene.obj"})).exit_code, 0);
    EXPECT_TRUE(exists("scenes/picture.png"));
}

} // namespace clrt
