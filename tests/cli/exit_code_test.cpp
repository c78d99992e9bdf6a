// SPDX-License-Identifier: Apache-2.0
// Every exit code, the message that goes with it, and that nothing half-written stays behind.
#include "clrt_command.h"

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

namespace clrt {

namespace {

class ExitCode : public ClrtCommand {
protected:
    /// Runs clrt and expects an exit code, parts of the message, and no file that was not there.
    void expect_failure(const std::vector<std::string>& arguments, int code,
                        const std::vector<std::string>& message, CommandSettings settings = {}) const {
        const std::vector<std::string> before = listing();
        const CommandResult result = clrt(arguments, std::move(settings));
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt: error: "}));
        EXPECT_TRUE(holds(result.err, message));
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(listing(), before);
    }

    /// A copy of the kernels to change.
    void copy_kernels() const {
        std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                              std::filesystem::copy_options::recursive);
    }
    void replace_in_kernels(const std::string& file, const std::string& from, const std::string& to) const {
        std::string text = folder.read("kernels/" + file);
        const size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        folder.write("kernels/" + file, text.replace(at, from.size(), to));
    }
};

/// A scene file and options that keep the device busy for a minute.
const std::vector<std::string> LONG_RUN = {"scene.obj", "-r",           "64x64",           "-t",
                                           "60",        "-s",           "2000000",         "-o",
                                           "long.exr",  "--checkpoint", "begun.film,0.01s"};

/// Signals for LONG_RUN once its film shows that some passes are done, however long that takes here.
CommandSettings signals_while_rendering(const std::vector<int>& signals) {
    CommandSettings settings;
    settings.signals_after_file = "begun.film";
    for (const int signal : signals)
        settings.signals.emplace_back(0.1, signal);
    return settings;
}

} // namespace

TEST_F(ExitCode, ZeroWhenThePictureIsWritten) {
    write_square("scene");
    EXPECT_EQ(clrt(quick({"scene.obj"})).exit_code, 0);
    EXPECT_TRUE(exists("scene.png"));
}

TEST_F(ExitCode, OneForASceneThatCannotBeRead) {
    expect_failure(quick({"none.obj"}), 1, {"none.obj"});
    std::filesystem::create_directory(folder.file("folder.obj"));
    expect_failure(quick({"folder.obj"}), 1, {"folder.obj"});
    folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n");
    expect_failure(quick({"bad.obj"}), 1, {"bad.obj:3: ", "zero"});
    folder.write("range.obj", "v 0 0 0\nv 1 0 0\n\nf 1 2 3\n");
    expect_failure(quick({"range.obj"}), 1, {"range.obj:4: ", "found 3"});
}

TEST_F(ExitCode, OneForFilesThatCannotBeReadOrWritten) {
    write_square("scene");
    folder.write("file", "");
    expect_failure(quick({"scene.obj", "-o", "no/folder/a.png"}), 1, {"no/folder"});
    expect_failure(quick({"scene.obj", "-o", "file/a.png"}), 1, {"file"});
    expect_failure(quick({"scene.obj", "--stats", "no/folder/s.json"}), 1, {"no/folder"});
    expect_failure(quick({"scene.obj", "--env", "none.exr"}), 1, {"none.exr"});
    expect_failure(quick({"scene.obj", "--env", "scene.obj"}), 1, {"scene.obj"});
    expect_failure(quick({"scene.obj", "--kernels", "none"}), 1, {"none"});
}

TEST_F(ExitCode, AFailedRunLeavesAnOlderPictureAlone) {
    folder.write("bad.obj", "f 1 2 3\n");
    folder.write("bad.png", "older");
    expect_failure(quick({"bad.obj"}), 1, {"bad.obj:1: "});
    EXPECT_EQ(folder.read("bad.png"), "older");
}

TEST_F(ExitCode, TwoForAWrongCommandLine) {
    write_square("scene");
    expect_failure({}, 2, {"expected a scene"});
    expect_failure({"scene.obj", "other.obj"}, 2, {"expected one scene", "other.obj"});
    expect_failure({"scene.obj", "--ssp", "3"}, 2, {"unknown option --ssp", "--spp"});
    expect_failure({"scene.obj", "--spp", "many"}, 2, {"--spp", "many"});
    expect_failure({"scene.obj", "--spp", "0"}, 2, {"--spp", "0"});
    expect_failure({"scene.obj", "--spp"}, 2, {"--spp"});
    expect_failure({"scene.obj", "-r", "0x5"}, 2, {"--size", "0x5"});
    expect_failure({"scene.obj", "-o", "a.bmx"}, 2, {"--output", "a.bmx"});
    expect_failure({"scene.obj", "--crop", "0,0,900,10"}, 2, {"--crop", "900"});
    expect_failure({"scene.obj", "--eye", "1,1,1", "--at", "1,1,1"}, 2, {"--eye"});
    expect_failure({"scene.obj", "--fov", "40", "--focal-length", "1"}, 2, {"--focal-length"});
    expect_failure({"scene.obj", "-i", "whitted", "--max-depth", "65"}, 2, {"--max-depth", "64"});
    expect_failure({"scene.obj", "-s", "4294967295"}, 2, {"--spp"});
}

TEST_F(ExitCode, TwoForAWrongOptionsFileWithItsLine) {
    write_square("scene");
    folder.write("scene.clrt", "# fine\n--spp 3\n--sizes 3x3\n");
    expect_failure({"scene.obj"}, 2, {"scene.clrt:3: ", "--sizes"});
}

TEST_F(ExitCode, ThreeForADeviceThatIsNotThereWithTheList) {
    write_square("scene");
    expect_failure(quick({"scene.obj", "-d", "abacus"}), 3, {"abacus", "platform"});
    expect_failure(quick({"scene.obj", "-d", "99:0"}), 3, {"99:0"});
    CommandSettings variable;
    variable.environment["CLRT_DEVICE"] = "abacus";
    expect_failure(quick({"scene.obj"}), 3, {"abacus"}, variable);
    CommandSettings no_drivers;
    no_drivers.environment["OCL_ICD_VENDORS"] = folder.file("no-drivers");
    expect_failure(quick({"scene.obj"}), 3, {}, no_drivers);
}

TEST_F(ExitCode, ThreeForKernelsThatDoNotCompileWithLogAndSource) {
    write_square("scene");
    copy_kernels();
    folder.write("kernels/integrators/raycast.cl",
                 folder.read("kernels/integrators/raycast.cl") + "nonsense\n");
    std::filesystem::create_directory(folder.file("tmp"));
    CommandSettings settings;
    settings.environment["TMPDIR"] = folder.file("tmp");
    const std::vector<std::string> arguments = quick({"scene.obj", "--kernels", "kernels"});
    expect_failure(arguments, 3, {"nonsense", "raycast.cl:", "The source is in "}, settings);
    const CommandResult result = clrt(arguments, settings);
    std::smatch match;
    ASSERT_TRUE(std::regex_search(result.err, match, std::regex("The source is in (\\S+)")));
    std::ifstream source(match[1].str());
    const std::string text(std::istreambuf_iterator<char>(source), {});
    EXPECT_TRUE(holds(text, {"nonsense"})) << match[1];
    // With --dump-kernels it is there.
    EXPECT_EQ(clrt(quick({"scene.obj", "--kernels", "kernels", "--dump-kernels", "dump"})).exit_code, 3);
    EXPECT_TRUE(exists("dump/raycast.cl"));
}

TEST_F(ExitCode, FourForSamplesThatAreNoNumbersUnderStrictChecks) {
    write_square("scene");
    copy_kernels();
    replace_in_kernels("film/film.h", "if (real_is_nan(radiance.x) ||",
                       "if (true || real_is_nan(radiance.x) ||");
    const std::vector<std::string> arguments =
        quick({"scene.obj", "--kernels", "kernels", "--stats", "s.json", "--replicates", "1"});
    std::vector<std::string> strict = arguments;
    strict.insert(strict.end(), {"--check", "strict"});
    const CommandResult result = clrt(strict);
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_TRUE(holds(result.err, {"warning", "192 samples"}));
    EXPECT_TRUE(exists("scene.png")) << "the picture is written";
    const auto stats = nlohmann::json::parse(folder.read("s.json"));
    EXPECT_EQ(stats["nonfinite"]["nan"], 16 * 12);
    ASSERT_FALSE(stats["bad_samples"].empty());
    for (const auto& bad : stats["bad_samples"]) {
        EXPECT_LT(bad["x"], 16);
        EXPECT_LT(bad["y"], 12);
        EXPECT_EQ(bad["sample"], 0);
    }
    EXPECT_EQ(clrt(arguments).exit_code, 0) << "counted, not failed, by default";
}

TEST_F(ExitCode, AnInterruptSavesThePictureAndExits130) {
    write_square("scene");
    const CommandResult result = clrt(LONG_RUN, signals_while_rendering({SIGINT}));
    EXPECT_EQ(result.exit_code, 130) << "a run that ends by its --time gives 0\n" << result.err;
    EXPECT_TRUE(holds(result.err, {"signal", "saved"}));
    const ReadPicture picture(folder.file("long.exr"));
    EXPECT_EQ(picture.spec.width, 64);
    EXPECT_GE(picture.at(0, 0, "samples"), 1);
    EXPECT_EQ(listing(), (std::vector<std::string>{"begun.film", "long.exr", "scene.obj"}));
}

TEST_F(ExitCode, ALedgerThatIsInterruptedExits130) {
    write_square("scene");
    CommandSettings settings;
    settings.signals = {{3, SIGINT}};
    const CommandResult result = clrt({"scene.obj", "-r", "512x512", "-s", "4096", "--ledger"}, settings);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_TRUE(holds(result.err, {"the ledger was stopped by a signal"}));
}

TEST_F(ExitCode, ATerminationSavesThePictureAndExits143) {
    write_square("scene");
    const CommandResult result = clrt(LONG_RUN, signals_while_rendering({SIGTERM}));
    EXPECT_EQ(result.exit_code, 143) << result.err;
    EXPECT_TRUE(exists("long.exr"));
}

TEST_F(ExitCode, AnInterruptDoesNotWaitForAPassOfMinutes) {
    // White walls all around: every path has 4096 segments.
    folder.write("box.mtl", "newmtl white\nKd 1 1 1\nKe .01 .01 .01\n");
    folder.write("box.obj",
                 "mtllib box.mtl\nusemtl white\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 "
                 "1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\nf 8 7 6 5\nf 1 4 8 5\nf 2 6 7 3\n"
                 "f 1 5 6 2\nf 4 3 7 8\n");
    CommandSettings settings;
    settings.signals = {{8, SIGINT}};
    const CommandResult result = clrt({"box.obj", "--eye", "0,0,0", "--at", "0,0,-1", "-r", "1600x1200",
                                       "--max-depth", "4096", "-o", "long.png"},
                                      settings);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_LT(result.seconds, 30) << "a pass takes minutes";
    EXPECT_TRUE(holds(result.err, {"before the first pass was complete: there is no picture"}));
    EXPECT_FALSE(exists("long.png"));
}

TEST_F(ExitCode, ASecondSignalStopsAtOnceWithoutAPicture) {
    write_square("scene");
    const CommandResult result = clrt(LONG_RUN, signals_while_rendering({SIGINT, SIGTERM}));
    EXPECT_TRUE(result.exit_code == 143 || result.exit_code == 130) << result.exit_code << result.err;
    EXPECT_FALSE(exists("long.exr"));
}

} // namespace clrt
