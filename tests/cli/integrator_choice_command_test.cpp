// SPDX-License-Identifier: Apache-2.0
// --integrator auto on the command line: what is said, that threads change nothing, and films that go on.
#include "cli/clrt_command.h"
#include "probes/scene_builder.h"
#include "support/windowed_room.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// A glass ball between a small lamp and a floor.
class ChoiceCommand : public ClrtCommand {
protected:
    void SetUp() override {
        SceneBuilder build;
        build.material("matte", "Kd 0.6 0.6 0.6").material("lamp", "Kd 0 0 0\nKe 900 800 700");
        build.material("glass", "Ni 1.5\nillum 7");
        build.use("matte").floor(2);
        build.use("lamp").polygon(
            {{-0.05, 2.9, -0.05}, {0.05, 2.9, -0.05}, {0.05, 2.9, 0.05}, {-0.05, 2.9, 0.05}});
        build.use("glass").icosphere({0, 0.8, 0}, 0.5, 2);
        folder.write("scene.mtl", build.mtl());
        folder.write("scene.obj", build.obj("scene.mtl", 1));
    }
    static std::vector<std::string> small(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"scene.obj", "-r", "64x48", "--env", "0,0,0"});
        return arguments;
    }
    nlohmann::json statistics(const std::string& name) const {
        std::ifstream file(folder.file(name));
        return nlohmann::json::parse(file);
    }
    std::vector<float> picture(const std::string& name) const {
        return ReadPicture(folder.file(name)).values;
    }
};

} // namespace

TEST_F(ChoiceCommand, ThePlanIsSaidAndDoesNotDependOnThreads) {
    nlohmann::json choices;
    for (const char* const threads : {"1", "2"}) {
        const auto result =
            clrt(small({"-i", "auto", "-s", "512", "-j", threads, "-o", std::string(threads) + ".exr",
                        "--stats", "a.json", "--aov", "none"}));
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_TRUE(holds(result.out, {"chosen   path+light: efficiency path 1, path+light "}));
        nlohmann::json json = statistics("a.json");
        EXPECT_EQ(json["integrator"], "path+light");
        json["choice"]["pilot"].erase("seconds");
        EXPECT_EQ(json["choice"]["prices"].size(), 3u);
        choices.push_back(json["choice"]);
    }
    EXPECT_EQ(choices[0], choices[1]);
    EXPECT_TRUE(picture("1.exr") == picture("2.exr"));
    clrt(small({"-i", "path+light", "-s", "512", "-o", "named.exr", "--stats", "a.json", "--aov", "none"}));
    EXPECT_TRUE(picture("1.exr") == picture("named.exr"));
    EXPECT_TRUE(statistics("a.json")["choice"].is_null());
}

TEST_F(ChoiceCommand, AFilmGoesOnByItsIntegrator) {
    // Too short for a pilot: by path, and so the film goes on where a pilot would choose otherwise.
    clrt(small({"-i", "auto", "-s", "8", "-o", "a.exr", "--checkpoint", "a.film"}));
    const auto result = clrt({"--resume", "a.film", "-s", "512", "-o", "b.exr", "--stats", "b.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, {"chosen   path: as the film that is gone on with"}));
    EXPECT_EQ(statistics("b.json")["integrator"], "path");
    clrt(small({"-i", "path", "-s", "512", "-o", "c.exr"}));
    EXPECT_TRUE(picture("b.exr") == picture("c.exr"));

    clrt(small({"-i", "path+light", "-s", "8", "-o", "a.exr", "--checkpoint", "b.film"}));
    const auto other = clrt(small({"-i", "auto", "--resume", "b.film", "-s", "16", "-o", "b.exr"}));
    EXPECT_EQ(other.exit_code, 0) << other.err;
    EXPECT_TRUE(holds(other.out, {"chosen   path+light: as the film that is gone on with"}));
    const auto unnamed = clrt(small({"--resume", "b.film", "-s", "24", "-o", "b.exr"}));
    EXPECT_EQ(unnamed.exit_code, 0) << unnamed.err;
    EXPECT_TRUE(holds(unnamed.out, {"chosen   path+light: as the film that is gone on with"}));
}

// bdpt has shorter paths where it is named than where it is chosen.
TEST_F(ChoiceCommand, AFilmGoesOnByPathsAsLongAsItsOwn) {
    const std::vector<std::string> usual, asked = {"--max-depth", "4096"};
    for (const auto& depth : {usual, asked}) {
        std::vector<std::string> named = {"-i", "bdpt", "-s", "8", "-o", "a.exr", "--checkpoint", "c.film"};
        named.insert(named.end(), depth.begin(), depth.end());
        clrt(small(named));
        const auto result = clrt(small({"--resume", "c.film", "-s", "16", "-o", "b.exr"}));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.out, {"chosen   bdpt: as the film that is gone on with"}));
    }
}

TEST_F(ChoiceCommand, ASampleIsReplayedByTheChosenOne) {
    const auto result = clrt(small({"-i", "auto", "-s", "512", "--pixel", "32,40", "--stats", "a.json"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(statistics("a.json")["integrator"], "path+light");
    EXPECT_TRUE(holds(result.err, {"integrator: path+light: efficiency path 1, path+light "}));
}

TEST_F(ChoiceCommand, WhatOnlyPathTakesIsTaken) {
    const auto result = clrt(small({"-i", "auto", "-s", "512", "--guide", "on", "-o", "a.exr"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, {"chosen   path: --guide on guides paths from the eye"}));
}

// A room with a window, and the same in the open.
TEST_F(ChoiceCommand, PortalsAreReported) {
    SceneBuilder build;
    build.material("white", "Kd 0.75 0.75 0.75").use("white");
    add_windowed_room(build);
    folder.write("room.mtl", build.mtl());
    folder.write("room.obj", build.obj("room.mtl", 1));
    const std::vector<std::string> view = {
        "--eye", "-2.8,1.6,1.6", "--at", "1,0.9,-0.8", "-r",    "96x72", "-s",      "4",
        "--env", "1,0.9,0.8",    "-o",   "a.exr",      "--aov", "none",  "--stats", "a.json"};
    const auto rendered = [&](const char* scene) {
        std::vector<std::string> arguments = view;
        arguments.push_back(scene);
        return clrt(arguments);
    };
    EXPECT_TRUE(holds(rendered("room.obj").out,
                      {"portals  100 % of the light samples of the sky go through 1 window\n"}));
    EXPECT_EQ(statistics("a.json")["portals"], (nlohmann::json{{"count", 1}, {"share_of_samples", 1.0}}));
    EXPECT_FALSE(holds(rendered("scene.obj").out, {"portals"}));
    EXPECT_TRUE(statistics("a.json")["portals"].is_null());
}

} // namespace clrt
