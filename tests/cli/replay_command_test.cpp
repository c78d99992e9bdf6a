// SPDX-License-Identifier: Apache-2.0
// --pixel and --sample, and what a run says about bad samples.
#include "clrt_command.h"

#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class ReplayCommand : public ClrtCommand {
protected:
    /// Writes room.obj: two lit walls of different materials.
    void write_room() const {
        folder.write("room.mtl", "newmtl wall\nKd 0.7 0.6 0.5\nnewmtl lamp\nKd 0 0 0\nKe 4 4 4\n");
        folder.write("room.obj", "mtllib room.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                                 "v -1 1 1\nv 1 1 1\nusemtl wall\nf 1 2 3 4\nusemtl lamp\nf 4 3 6 5\n");
    }
    static std::vector<std::string> picture(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"room.obj", "-r", "16x12", "--replicates", "4",
                                             "--two-sided-lights", "--eye", "0,0,4", "--at", "0,0,0"});
        return arguments;
    }
    nlohmann::json read_json(const std::string& name) const {
        return nlohmann::json::parse(folder.read(name));
    }
};

} // namespace

TEST_F(ReplayCommand, TheRecordHasTheBitsOfAOneSampleRender) {
    write_room();
    for (const char* const integrator : {"path", "distribution", "whitted", "raycast"}) {
        const CommandResult replay =
            clrt(picture({"-i", integrator, "--pixel", "5,7", "--sample", "9", "--stats", "r.json"}));
        EXPECT_EQ(replay.exit_code, 0) << replay.err;
        EXPECT_TRUE(
            holds(replay.out, {"sample 9 of pixel 5,7", "vertex 1", "wall", "shading normal", "radiance"}));
        EXPECT_FALSE(exists("room.png"));
        EXPECT_EQ(clrt(picture({"-i", integrator, "--crop", "5,7,6,8", "--first-sample", "9", "-s", "1", "-o",
                                "one.exr"}))
                      .exit_code,
                  0);
        const ReadPicture one(folder.file("one.exr"));
        const auto record = read_json("r.json");
        const char* const channels[] = {"R", "G", "B"};
        for (size_t c = 0; c < 3; ++c)
            EXPECT_EQ(record["traces"][0]["film"][c].get<float>(), one.at(0, 0, channels[c]))
                << integrator << c;
        EXPECT_GT(one.at(0, 0, "G"), 0);
    }
}

TEST_F(ReplayCommand, BothPrecisionsStandSideBySideAndHexOnRequest) {
    write_room();
    const CommandResult plain = clrt(picture({"--pixel", "5,7", "-o", "a.png", "--stats", "r.json"}));
    EXPECT_EQ(plain.exit_code, 0);
    EXPECT_TRUE(holds(plain.err, {"no picture is written"}));
    EXPECT_EQ(plain.out.find("0x1."), std::string::npos);
    const auto record = read_json("r.json");
    EXPECT_EQ(record["pixel"], (std::vector<int>{5, 7}));
    EXPECT_EQ(record["sample"], 0);
    EXPECT_FALSE(exists("a.png"));
    if (record["traces"].size() == 2) {
        EXPECT_TRUE(holds(plain.out, {"single", "double", "largest relative difference"}));
        EXPECT_EQ(record["traces"][1]["precision"], "double");
        EXPECT_TRUE(record["difference"]["decision"].is_null());
    }
    EXPECT_TRUE(holds(clrt(picture({"--pixel", "5,7", "-v"})).out, {"0x1."}));
}

TEST_F(ReplayCommand, WrongRequestsAreUsageErrors) {
    write_room();
    const auto refused = [&](const std::vector<std::string>& arguments,
                             const std::vector<std::string>& message) {
        const CommandResult result = clrt(picture(arguments));
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_TRUE(holds(result.err, message));
        EXPECT_EQ(result.out, "");
    };
    refused({"--pixel", "16,0"}, {"option --pixel", "from 0,0 to 15,11", "found 16,0"});
    refused({"--pixel", "0,12"}, {"option --pixel", "found 0,12"});
    refused({"--crop", "2,2,4,4", "--pixel", "4,2"}, {"option --pixel", "from 2,2 to 3,3", "found 4,2"});
    refused({"--pixel", "3"}, {"option --pixel", "found '3'"});
    refused({"--pixel", "-1,3"}, {"option --pixel", "found '-1,3'"});
    refused({"--pixel", "1.5,3"}, {"option --pixel", "found '1.5,3'"});
    refused({"--sample", "3"}, {"option --sample", "--pixel", "alone"});
    refused({"--pixel", "1,1", "--sample", "x"}, {"option --sample", "found 'x'"});
    refused({"--pixel", "1,1", "--sample", "8", "-s", "8"}, {"option --sample", "from 0 to 7", "found 8"});
    refused({"--pixel", "1,1", "--sample", "8", "-s", "8", "--first-sample", "9"},
            {"option --sample", "from 9 to 16"});
    refused({"--pixel", "1,1", "--ledger"}, {"--pixel", "--ledger", "one of them"});
    refused({"--pixel", "1,1", "--explain"}, {"--pixel", "--explain", "one of them"});
}

TEST_F(ReplayCommand, APlantedFaultIsReportedWithItsCauseAndTheCommandThatReplaysIt) {
    write_room();
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    const std::string from = "    const Bsdf bsdf = vertex_bsdf(scene, &surface, wo);\n";
    std::string text = folder.read("kernels/integrators/raycast.h");
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    // The colour of the wall, seen by sample 5 (number 1 of replicate 1 of 4) of pixel (6, 8).
    text.replace(at, from.size(),
                 "    Bsdf bsdf = vertex_bsdf(scene, &surface, wo);\n"
                 "    if (sampler->word_key == sampler_make(params->seed, 8u * 16u + 6u, 1u, 1u).word_key)\n"
                 "        bsdf.matte.x = -1.0f;\n");
    folder.write("kernels/integrators/raycast.h", text);
    const std::vector<std::string> run = {"-i",      "raycast", "-s",      "8",      "--kernels", "kernels",
                                          "--stats", "s.json",  "--check", "strict", "-o",        "a.exr"};
    const CommandResult result = clrt(picture(run));
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_TRUE(holds(result.err, {"1 samples"}));
    EXPECT_TRUE(holds(result.out,
                      {"negative 1", "cause    1 x negative: BSDF to light, raycast, bounce 1, material wall",
                       "clrt --pixel=6,8 --sample=5 "}));
    const auto nonfinite = read_json("s.json")["nonfinite"];
    EXPECT_EQ(nonfinite["negative"], 1);
    ASSERT_EQ(nonfinite["by_cause"].size(), 1u);
    const auto cause = nonfinite["by_cause"][0];
    EXPECT_EQ(cause["quantity"], "BSDF to light");
    EXPECT_EQ(cause["integrator"], "raycast");
    EXPECT_EQ(cause["bounce"], 1);
    EXPECT_EQ(cause["material"], "wall");
    EXPECT_EQ(cause["count"], 1);

    // The picture marks the pixel.
    const ReadPicture marked(folder.file("a.exr"));
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x)
            EXPECT_EQ(marked.at(x, y, "badSamples"), x == 6 && y == 8 ? 1 : 0);
    // The command replays the sample.
    CommandSettings settings;
    settings.folder = path();
    settings.environment = {{"CLRT_DEVICE", test_device_name()}};
    const std::string programs = std::filesystem::path(CLRT_EXECUTABLE).parent_path().string();
    const CommandResult again = run_command(
        {"/bin/sh", "-c", "PATH=" + programs + ":$PATH; " + cause["replay"].get<std::string>()}, settings);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(holds(again.out, {"sample 5 of pixel 6,8", "counted as negative"}));
}

TEST_F(ReplayCommand, TheLayerOfBadSamplesIsThereWhenAskedFor) {
    write_room();
    EXPECT_EQ(clrt(picture({"-i", "raycast", "-s", "1", "-o", "plain.exr"})).exit_code, 0);
    EXPECT_EQ(ReadPicture(folder.file("plain.exr")).spec.channelindex("badSamples"), -1);
    EXPECT_EQ(clrt(picture({"-i", "raycast", "-s", "1", "-o", "asked.exr", "--aov", "badSamples"})).exit_code,
              0);
    EXPECT_EQ(ReadPicture(folder.file("asked.exr")).at(3, 3, "badSamples"), 0);
}

} // namespace clrt
