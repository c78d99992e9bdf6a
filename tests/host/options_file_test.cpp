// SPDX-License-Identifier: Apache-2.0
// STEM.clrt beside STEM.obj.
#include "app/command_line.h"
#include "app/option_table.h"
#include "error.h"
#include "probes/scratch_folder.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A scene "hall.obj" with an options file of this content.
class OptionsFile : public testing::Test {
protected:
    Options parse(const std::string& content, const std::vector<std::string>& arguments = {}) const {
        folder.write("hall.clrt", content);
        const std::string scene = folder.file("hall.obj");
        std::vector<const char*> argv = {"clrt"};
        for (const std::string& argument : arguments)
            argv.push_back(argument.c_str());
        argv.push_back(scene.c_str());
        return parse_command_line(static_cast<int>(argv.size()), argv.data()).options;
    }

    std::string refusal(const std::string& content, const std::vector<std::string>& arguments = {}) const {
        try {
            parse(content, arguments);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "accepted";
    }

    /// The message starts with the file, the line and this text.
    void expect_refused(const std::string& content, int line, const std::string& text) const {
        const std::string start = folder.file("hall.clrt") + ":" + std::to_string(line) + ": " + text;
        EXPECT_EQ(refusal(content).substr(0, start.size()), start);
    }

    ScratchFolder folder;
};

} // namespace

TEST_F(OptionsFile, GivesOptionsOfItsScene) {
    const Options o = parse("# a camera\n"
                            "--eye -1,2,3\n"
                            "\n"
                            "  --fov\t 35.5  \n"
                            "--size=640x480\n"
                            "--two-sided-lights\n"
                            "--point 0,1,0,1,1,1\n"
                            "--point 1,1,0,1,1,1\n"
                            "--explain json");
    EXPECT_EQ(o.camera.eye, glm::dvec3(-1, 2, 3));
    EXPECT_EQ(o.camera.fov_degrees, 35.5);
    EXPECT_EQ(o.film.size, glm::ivec2(640, 480));
    EXPECT_TRUE(o.light.two_sided);
    EXPECT_EQ(o.light.points.size(), 2u);
    EXPECT_EQ(o.run.explain, Explain::JSON);
    EXPECT_EQ(o.run.sidecar_path, folder.file("hall.clrt"));
}

TEST_F(OptionsFile, MayHaveWindowsLineEndsAndAByteOrderMark) {
    const Options o = parse("\xEF\xBB\xBF--spp 4\r\n\r\n# comment\r\n--device pocl\r\n");
    EXPECT_EQ(o.sampling.spp, 4u);
    EXPECT_EQ(o.device.name, "pocl");
}

TEST_F(OptionsFile, ValuesMayHoldBlanksAndNumberSigns) {
    EXPECT_EQ(parse("--device Portable Computing #1\n").device.name, "Portable Computing #1");
}

TEST_F(OptionsFile, RelativePathsCountFromItsFolder) {
    const Options o =
        parse("--env textures/Sky 19.exr\n--output out.png\n--output /tmp/b.exr\n--stats s.json\n"
              "--kernels k\n--dump-kernels d\n--cache-dir ../c\n");
    EXPECT_EQ(o.light.environment_file, folder.file("textures/Sky 19.exr"));
    EXPECT_EQ(o.output.files, (std::vector<std::string>{folder.file("out.png"), "/tmp/b.exr"}));
    EXPECT_EQ(o.output.stats_path, folder.file("s.json"));
    EXPECT_EQ(o.device.kernels_folder, folder.file("k"));
    EXPECT_EQ(o.device.dump_folder, folder.file("d"));
    EXPECT_EQ(o.device.cache_folder, folder.file("../c"));
    EXPECT_EQ(parse("--env 1,0.5,0\n").light.environment, glm::dvec3(1, 0.5, 0));
    EXPECT_EQ(parse("", {"--env", "sky.exr"}).light.environment_file, "sky.exr");
}

TEST_F(OptionsFile, CommandLineWinsOptionByOption) {
    const Options o =
        parse("--spp 4\n--size 10x10\n--point 0,1,0,1,1,1\n--point 1,1,0,1,1,1\n--env sky.exr\n",
              {"--spp", "8", "--point", "9,9,9,1,1,1", "--env", "1,1,1"});
    EXPECT_EQ(o.sampling.spp, 8u);
    EXPECT_EQ(o.film.size, glm::ivec2(10, 10));
    ASSERT_EQ(o.light.points.size(), 1u);
    EXPECT_EQ(o.light.points[0].position, glm::dvec3(9));
    EXPECT_TRUE(o.light.environment_file.empty());
}

TEST_F(OptionsFile, CommandLineWinsOverWhatContradictsIt) {
    const Options lens = parse("--fov 40\n", {"--focal-length", "35", "--film-width", "24"});
    EXPECT_FALSE(lens.camera.fov_degrees);
    const Options angle = parse("--focal-length 35\n--film-width 24\n", {"--fov", "50"});
    EXPECT_FALSE(angle.camera.focal_length || angle.camera.film_width);
    EXPECT_EQ(parse("--quiet\n", {"-v"}).run.verbosity, 1);
    EXPECT_EQ(parse("--no-cache\n", {"--cache", "on"}).device.cache, Toggle::ON);
}

TEST_F(OptionsFile, ItsAngleOfViewStandsForAHeightWhereTheCommandLineAsksForParallelRays) {
    const Options fitted = parse("--fov 40\n", {"--projection", "orthographic"});
    EXPECT_EQ(fitted.camera.fov_degrees, 40);
    const Options given = parse("--fov 40\n", {"--projection", "orthographic", "--ortho-height", "2"});
    EXPECT_FALSE(given.camera.fov_degrees);
    EXPECT_EQ(given.camera.ortho_height, 2);
    for (const char* const content : {"--projection orthographic\n--fov 40\n", "--projection orthographic\n"})
        EXPECT_NE(refusal(content, {"--fov", "50"}).find("option --fov: expected --ortho-height"),
                  std::string::npos);
}

TEST_F(OptionsFile, IsSkippedOnRequestOrWhenAbsent) {
    const Options skipped = parse("--nonsense\n", {"--no-sidecar"});
    EXPECT_EQ(skipped.run.sidecar_path, "");
    EXPECT_TRUE(skipped.run.no_sidecar);
    const std::string scene = folder.file("other.obj");
    const char* argv[] = {"clrt", scene.c_str()};
    EXPECT_EQ(parse_command_line(2, argv).options.run.sidecar_path, "");
}

TEST_F(OptionsFile, MistakesCarryFileAndLine) {
    expect_refused("# x\n\n--smaple 4\n", 3, "unknown option --smaple; the nearest is ");
    expect_refused("--spp 4\r\n--spp four\r\n", 2, "option --spp: expected a whole number");
    expect_refused("--spp\n", 1, "option --spp: expected a value N on the same line, found none");
    expect_refused("--two-sided-lights yes\n", 1, "option --two-sided-lights takes no value, found 'yes'");
    expect_refused("-s 4\n", 1, "expected a long option with its dashes such as --spp 64, found '-s 4'");
    expect_refused("hall.obj\n", 1, "expected a long option with its dashes");
    expect_refused("spp 4\n", 1, "expected a long option with its dashes");
    expect_refused("--output a.gif\n", 1, "option --output: expected a file name that ends in .png");
    expect_refused("--quiet\n--spp 4\n--verbose\n", 3, "options --quiet and --verbose");
    for (const char* option :
         {"--help", "--version", "--list-devices", "--no-sidecar", "--serve", "--display-server"})
        expect_refused(std::string("--spp 4\n") + option + "\n", 2,
                       std::string("option ") + option + " makes sense on the command line only");
}

TEST_F(OptionsFile, ContradictionsWithTheCommandLineNameTheFile) {
    const std::string message = refusal("--crop 0,0,500,500\n", {"--size", "100x100"});
    EXPECT_NE(message.find("expected a window inside the picture of 100x100"), std::string::npos) << message;
    EXPECT_NE(message.find(folder.file("hall.clrt")), std::string::npos) << message;
}

TEST_F(OptionsFile, IsNamedOnlyWhereTheContradictionIsWithAnOptionOfIt) {
    const std::string place = folder.file("hall.clrt") + ":2";
    EXPECT_EQ(refusal("--spp 4\n--size 100x100\n", {"--crop", "0,0,500,500"}),
              "option --crop: expected a window inside the picture of 100x100 pixels (--size), found "
              "0,0,500,500 (--size is from " +
                  place + ")");
    EXPECT_EQ(refusal("--fov 4\n--replicates 3\n", {"--error", "1%"}),
              "option --error: expected --replicates 4 or more, whose spread is the error, found 3 "
              "(--replicates is from " +
                  place + ")");
    for (const char* content : {"--spp 4\n", "--size 600x400\n"})
        EXPECT_EQ(refusal(content, {"--focal-length", "35"}),
                  "option --focal-length: expected together with --film-width, found alone");
    EXPECT_EQ(refusal("--size 64x64\n", {"--size", "100x100", "--crop", "0,0,500,500"}),
              "option --crop: expected a window inside the picture of 100x100 pixels (--size), found "
              "0,0,500,500");
}

TEST_F(OptionsFile, AFolderOfThatNameIsNoOptionsFile) {
    std::filesystem::create_directory(folder.file("room.clrt"));
    const std::string scene = folder.file("room.obj");
    const char* argv[] = {"clrt", scene.c_str()};
    EXPECT_EQ(parse_command_line(2, argv).options.run.sidecar_path, "");
}

} // namespace clrt
