// SPDX-License-Identifier: Apache-2.0
// What a run says about its error: stop rules and their exit codes, printed lines, JSON, metadata.
#include "clrt_command.h"
#include "render/good_counts.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <regex>

namespace clrt {

namespace {

class ErrorReport : public ClrtCommand {
protected:
    /// A floor lit by a lamp whose shadow edge and distance give some noise.
    void write_lamp() const {
        folder.write("lamp.mtl", "newmtl white\nKd 0.7 0.7 0.7\nnewmtl lamp\nKd 0 0 0\nKe 9 8 6\n");
        folder.write("lamp.obj", "mtllib lamp.mtl\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\n"
                                 "v -.5 1 -.5\nv .5 1 -.5\nv .5 1 .5\nv -.5 1 .5\n"
                                 "usemtl white\nf 1 2 3 4\nusemtl lamp\nf 5 6 7 8\n");
    }
    /// Runs on the lamp with 32 x 32 pixels.
    CommandResult render(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"lamp.obj", "-r", "32x32", "--stats", "s.json", "--eye", "0,3,0.1",
                                           "--at", "0,0,0"});
        return clrt(arguments);
    }
    nlohmann::json stats() const { return nlohmann::json::parse(folder.read("s.json")); }
};

} // namespace

TEST_F(ErrorReport, AReachedTargetEndsWithZeroWhereSamplesAreEven) {
    write_lamp();
    const CommandResult result = render({"--error", "2%"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"--error 2 % is reached"}));
    const nlohmann::json json = stats();
    EXPECT_LE(json["error"]["rel_rmse"], 0.02);
    EXPECT_EQ(json["stop"]["rule"], "error");
    EXPECT_EQ(json["stop"]["error_target"], 0.02);
    EXPECT_EQ(json["stop"]["error_reached"], true);
    const auto spp = json["spp"].get<unsigned>();
    EXPECT_TRUE(is_good_count(spp, 4)) << spp;
    EXPECT_EQ(json["passes"], spp);
    // At the good count before it was not reached yet: the render did not go on in vain.
    const unsigned before = is_doubling(spp, 4) ? spp / 4 * 3 : spp / 3 * 2;
    EXPECT_EQ(render({"--error", "2%", "--spp", std::to_string(before)}).exit_code, 5);
}

// The error that ended the render, against two long runs with other seeds: mean((x - a)(x - b)) is the
// squared error of x without the noise of a and b.
TEST_F(ErrorReport, AReachedTargetIsTrueOnTheCornellBox) {
    const auto box = [&](const std::string& name, std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {CLRT_SCENES_FOLDER "/cornell_box/cornell_box.obj", "-i", "path",
                                           "-r", "64x64", "--aov", "none", "--stats", "s.json", "-o", name});
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ReadPicture(folder.file(name));
    };
    const ReadPicture a = box("a.exr", {"--spp", "512", "--seed", "1"}),
                      b = box("b.exr", {"--spp", "512", "--seed", "2"});
    const auto true_error = [&](const ReadPicture& x) {
        double squared = 0, mean = 0;
        for (size_t i = 0; i < x.values.size(); ++i) {
            squared += double(x.values[i] - a.values[i]) * double(x.values[i] - b.values[i]) /
                       double(x.values.size());
            mean += double(x.values[i]) / double(x.values.size());
        }
        return std::sqrt(squared) / mean;
    };
    for (const char* replicates : {"4", "8"}) {
        const double error = true_error(box("x.exr", {"--error", "10%", "--replicates", replicates}));
        const nlohmann::json said = stats()["error"];
        const auto printed = said["rel_rmse"].get<double>();
        std::printf("%s replicates: printed %.2f %%, true over printed %.3f\n", replicates, 100 * printed,
                    error / printed);
        EXPECT_LE(printed, 0.1);
        EXPECT_GE(error, said["low"].get<double>());
        EXPECT_LE(error, said["high"].get<double>());
        // Few bright pixels may have most of the error, which 4 replicates then tell worse than 8.
        if (replicates == std::string("8"))
            EXPECT_NEAR(error / printed, 1, 0.15);
    }
}

TEST_F(ErrorReport, AMissedTargetEndsWithFiveAndThePicture) {
    write_lamp();
    for (const auto& [budget, rule] : {std::pair{"--spp=24", "spp"}, {"--time=0.3", "time"}}) {
        std::filesystem::remove(folder.file("lamp.png"));
        const CommandResult result = render({"--error", "0.0001%", budget});
        EXPECT_EQ(result.exit_code, 5) << result.err;
        EXPECT_TRUE(holds(result.err, {"warning", "--error 0.0001 % is not reached"}));
        EXPECT_TRUE(exists("lamp.png"));
        EXPECT_EQ(stats()["stop"]["rule"], rule);
        EXPECT_EQ(stats()["stop"]["error_reached"], false);
    }
}

TEST_F(ErrorReport, TheReportLeadsWithWhatPeopleAsk) {
    write_lamp();
    const CommandResult result = render({"--spp", "128", "-o", "a.exr", "-o", "a.png"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::regex lines(
        "picture  a.exr, a.png, 32 x 32, 128 spp; --spp 128 is complete\n"
        "time     [0-9.]+ s, [0-9.]+ s of it rendering, on .*\n"
        "error    [0-9.]+ % of the picture's mean brightness \\(root of mean square\\); with 95 % confidence "
        "[0-9.]+ to [0-9.]+ %\n"
        "relative [0-9.]+ % relative to each pixel's brightness\n"
        "verdict  trust the error\n"
        "price    half the error takes [0-9]+ spp, [0-9.]+ s more, and comes to [0-9.]+ %\n"
        "memory   [0-9]+ MB at most\n"
        "left out nothing that the scene calls for\n");
    EXPECT_TRUE(std::regex_match(result.out, lines)) << result.out;
}

TEST_F(ErrorReport, WhatIsWrongIsAlwaysSaid) {
    write_lamp();
    CommandResult result = render({"--spp", "16", "--error", "0.1%"});
    EXPECT_TRUE(holds(result.out, {"missed   --error 0.1 % is not reached\n"}));
    result = render({"--spp", "16", "--effects=-area-lights"});
    EXPECT_TRUE(holds(result.out, {"left out area lights", ", by --effects\n"}));
    result = render({"--spp", "16", "-i", "whitted"});
    EXPECT_TRUE(holds(result.out,
                      {"left out all indirect light but that of mirrors and smooth glass, by --integrator "
                       "whitted\n"}));
    result = render({"--spp", "16", "--paths", "LSE"});
    EXPECT_TRUE(holds(result.out, {"error    none: no light is asked for\n", "paths    'LSE': no path"}));
    EXPECT_EQ(result.out.find("price"), std::string::npos) << result.out;
}

TEST_F(ErrorReport, VerboseAddsTheRest) {
    write_lamp();
    const CommandResult result = render({"--spp", "128", "-o", "a.exr", "-v"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"ended after 128 spp: --spp 128 is complete"}));
    for (const std::string& line :
         {std::string("by       path, seed 0, sobol sampler, 4 replicates\n"),
          std::string("stages   load [0-9.]+ s, pilots [0-9.]+ s, bvh [0-9.]+ s, compile "),
          std::string("rays     [0-9.]+ a sample, "), std::string("tree     bvh"),
          std::string("slope    -[0-9.]+ \\+- [0-9.]+ from 4 to 128 spp: twice the "),
          std::string("worst    [0-9.]+ % of the picture's mean in the 32 x 32 tile at 0,0\n"),
          std::string(
              "tails    [0-9]+ % of the squared error is in the noisiest [a-z]+ of the pixels; [0-9]+ % "
              "rests "
              "on what one replicate alone saw, which leaves it uncertain by [0-9.]+ % \\(trusted up to 15 "
              "%\\)\n"),
          std::string("checked  NaN 0, infinite 0"), std::string("absent   ")})
        EXPECT_TRUE(std::regex_search(result.out, std::regex(line))) << line << "\n" << result.out;
}

TEST_F(ErrorReport, FilesHaveAllThatIsKnown) {
    write_lamp();
    EXPECT_EQ(render({"--spp", "128", "-o", "a.exr"}).exit_code, 0);
    const nlohmann::json json = stats(), error = json["error"];
    EXPECT_LT(error["low"], error["rel_rmse"]);
    EXPECT_GT(error["high"], error["rel_rmse"]);
    EXPECT_LT(error["slope"]["value"], -0.4);
    EXPECT_EQ(error["half"]["slope_measured"], true);
    EXPECT_LT(error["half"]["rel_rmse"], 0.53 * error["rel_rmse"].get<double>());
    EXPECT_TRUE(is_good_count(error["half"]["spp"], 4)) << error["half"];
    const double factor = error["half"]["samples_factor"];
    EXPECT_EQ(128 * factor, error["half"]["spp"]);
    EXPECT_NEAR(error["half"]["seconds"], json["seconds"]["render"].get<double>() * (factor - 1), 1e-6);
    EXPECT_NEAR(error["worst_tile"]["rel_rmse"], error["rel_rmse"].get<double>(), 1e-6)
        << "there is one tile";
    EXPECT_LT(error["tails"]["once_share"], 0.2);
    EXPECT_LT(error["tails"]["once_error"], 0.1);
    EXPECT_EQ(error["tails"]["usable"], true);
    EXPECT_EQ(error["verdict"], "trusted");
    EXPECT_EQ(json["stop"]["error_reached"], nullptr);

    const ReadPicture picture(folder.file("a.exr"));
    for (const char* name : {"clrt.error", "clrt.error.low", "clrt.error.high", "clrt.error.slope",
                             "clrt.error.usable", "clrt.stop"})
        EXPECT_NE(picture.spec.find_attribute(name), nullptr) << name;
}

/// A closed box of walls that reflect 0.98, and so are as bright as 1 if no path is cut.
TEST_F(ErrorReport, WhatMaxDepthCutsIsABiasBesideTheError) {
    folder.write("box.mtl", "newmtl wall\nKd .98 .98 .98\nKe .02 .02 .02\n");
    folder.write("box.obj",
                 "mtllib box.mtl\nusemtl wall\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 "
                 "1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\nf 8 7 6 5\nf 1 4 8 5\nf 2 6 7 3\nf 1 5 6 2\nf 4 3 7 8\n");
    const auto box = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(),
                         {"box.obj", "-r", "16x16", "--stats", "s.json", "--eye", "0,0,0", "--at", "0,0,-1"});
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    };
    CommandResult result = box({"--spp", "16"});
    EXPECT_EQ(stats()["cut"]["paths"], 0);
    EXPECT_EQ(stats()["cut"]["light_bound"], 0.0);
    EXPECT_EQ(stats()["error"]["complete"], true);
    EXPECT_EQ(result.out.find("--max-depth"), std::string::npos) << result.out;

    result = box({"--spp", "16", "--max-depth", "64", "--checkpoint", "whole.film", "-o", "a.exr"});
    const nlohmann::json whole = stats();
    EXPECT_GT(whole["cut"]["paths"], 0);
    EXPECT_NEAR(whole["cut"]["light_bound"], std::pow(0.98, 64), 0.05);
    EXPECT_EQ(whole["error"]["complete"], false);
    EXPECT_TRUE(
        holds(result.out,
              {"cut      " + std::to_string(whole["cut"]["paths"].get<int>()) + " of " +
                   std::to_string(whole["cut"]["of"].get<int>()),
               " paths ended by --max-depth: beside the error, the picture lacks up to ",
               "verdict  trust the error for what was sampled, which is not all: long paths are cut\n"}));
    EXPECT_EQ(ReadPicture(folder.file("a.exr")).spec.get_string_attribute("clrt.cut.paths"),
              std::to_string(whole["cut"]["paths"].get<int>()));

    // A render that is gone on with, and one in parts, know the same.
    box({"--spp", "8", "--max-depth", "64", "--checkpoint", "half.film"});
    EXPECT_LT(stats()["cut"]["paths"], whole["cut"]["paths"]);
    box({"--spp", "16", "--max-depth", "64", "--resume", "half.film", "--checkpoint", "on.film"});
    EXPECT_EQ(stats()["cut"], whole["cut"]);
    box({"--spp", "8", "--max-depth", "64", "--first-sample", "8", "--checkpoint", "rest.film"});
    const CommandResult merged = run_command({CLRT_MERGE_EXECUTABLE, folder.file("half.film"),
                                              folder.file("rest.film"), "-o", folder.file("m.exr")});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    const size_t line = result.out.find("cut      ");
    EXPECT_TRUE(holds(merged.out, {result.out.substr(line, result.out.find('\n', line) - line)}));

    // Where walls reflect all light, there is no bound.
    folder.write("box.mtl", "newmtl wall\nKd 1 1 1\nKe .02 .02 .02\n");
    result = box({"--spp", "16", "--max-depth", "64"});
    EXPECT_EQ(stats()["cut"]["paths"], 16 * 16 * 16);
    EXPECT_EQ(stats()["cut"]["light_bound"], nullptr);
    EXPECT_TRUE(holds(
        result.out, {"lacks light without a known bound", "left out nothing but what the lines above name"}));

    // One path of them, step by step.
    result = box({"--max-depth", "3", "--pixel", "5,5", "--sample", "1"});
    EXPECT_TRUE(holds(result.out, {"max depth           cuts the path"}));
}

TEST_F(ErrorReport, AnAdaptiveRenderCountsWhatItCuts) {
    write_lamp();
    EXPECT_EQ(render({"--adaptive", "--spp", "64", "--max-depth", "1"}).exit_code, 0);
    EXPECT_GT(stats()["cut"]["paths"], 0);
    EXPECT_GT(stats()["cut"]["light_bound"], 0.0);
}

TEST_F(ErrorReport, WhatNoPathCanShowIsNamed) {
    folder.write("pane.mtl", "newmtl white\nKd 0.7 0.7 0.7\n# behind it\nnewmtl glass\nillum 7\nNi 1.5\n");
    folder.write("pane.obj", "mtllib pane.mtl\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\n"
                             "v -3 1 3\nv 3 1 3\nv 3 1 -3\nv -3 1 -3\nusemtl white\nf 1 2 3 4\n");
    const auto pane = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"pane.obj", "-r", "16x16", "--stats", "s.json", "--eye", "0,.5,2",
                                           "--at", "0,0,0", "--point", "0,3,0,9,9,9", "--spp", "16"});
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    };
    CommandResult result = pane({});
    EXPECT_EQ(stats()["blind_spots"], nlohmann::json::array());
    EXPECT_EQ(result.out.find("not seen"), std::string::npos);

    folder.write("pane.obj", folder.read("pane.obj") + "usemtl glass\nf 5 6 7 8\n");
    result = pane({"--checkpoint", "a.film", "-o", "a.exr"});
    const nlohmann::json spots = stats()["blind_spots"];
    ASSERT_EQ(spots.size(), 1u);
    EXPECT_EQ(spots[0]["paths"], "LpS+D(D|S)*E");
    EXPECT_EQ(spots[0]["where"], "pane.mtl:4");
    EXPECT_EQ(spots[0]["cause"], "point light (1 by --point), next to it material \"glass\" (pane.mtl:4)");
    EXPECT_TRUE(holds(result.err, {"warning", "path does not see LpS+D(D|S)*E (point light (1 by --point)"}));
    EXPECT_TRUE(
        holds(result.out, {"not seen LpS+D(D|S)*E: point light (1 by --point), next to it material"}));
    EXPECT_EQ(ReadPicture(folder.file("a.exr")).spec.get_string_attribute("clrt.blind_spots"),
              "LpS+D(D|S)*E");
    const CommandResult merged =
        run_command({CLRT_MERGE_EXECUTABLE, folder.file("a.film"), "-o", folder.file("m.exr")});
    EXPECT_TRUE(holds(merged.out, {"not seen LpS+D(D|S)*E"}));

    for (const char* integrator : {"whitted", "raycast"}) {
        pane({"-i", integrator});
        EXPECT_EQ(stats()["blind_spots"], nlohmann::json::array()) << integrator;
    }
    pane({"--paths", "LDE"});
    EXPECT_EQ(stats()["blind_spots"], nlohmann::json::array());
}

// A sun that a mirror before the floor reflects on it, which only paths that hit its disc find.
TEST_F(ErrorReport, WhatNoSampleMayHaveMetIsBounded) {
    folder.write("m.mtl", "newmtl white\nKd 0.7 0.7 0.7\nnewmtl mirror\nKd 0 0 0\nKs 1 1 1\nillum 3\n");
    folder.write("m.obj", "mtllib m.mtl\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nv 2 2 -2\nv -2 2 -2\n"
                          "usemtl white\nf 1 2 3 4\nusemtl mirror\nf 4 3 5 6\n");
    const auto mirror = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(),
                         {"m.obj", "-r", "16x16", "--stats", "s.json", "--eye", "0,1,4", "--at", "0,0,0",
                          "-i", "path", "--spp", "16", "--env", "0.1,0.1,0.1"});
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    };
    CommandResult result = mirror({"--sun", "0,1,1,3,3,3,60"});
    EXPECT_EQ(stats()["unmet"], nullptr) << "so large a sun is met often";
    EXPECT_EQ(result.out.find("unmet"), std::string::npos);

    result = mirror({"--sun", "0,1,1,3,3,3,0.5", "--checkpoint", "a.film", "-o", "a.exr"});
    const nlohmann::json unmet = stats()["unmet"];
    EXPECT_EQ(unmet["paths"], "LR+D(D|R)*E");
    EXPECT_GT(unmet["rel_light_bound"], 0.01);
    EXPECT_FALSE(stats()["error"]["complete"]);
    EXPECT_TRUE(
        holds(result.out, {"unmet    hardly any but paths that happen to hit a light find LR+D(D|R)*E"}));
    EXPECT_EQ(ReadPicture(folder.file("a.exr")).spec.get_string_attribute("clrt.unmet"), "LR+D(D|R)*E");
    const CommandResult merged =
        run_command({CLRT_MERGE_EXECUTABLE, folder.file("a.film"), "-o", folder.file("m.exr")});
    EXPECT_TRUE(holds(merged.out, {"LR+D(D|R)*E"}));

    // Nobody knows how much of a black picture that is, nor that there is none.
    result = mirror({"--sun", "0,1,1,3,3,3,0.001", "--paths", "LdS+DE", "--force"});
    EXPECT_EQ(stats()["unmet"]["rel_light_bound"], nullptr);
    EXPECT_GT(stats()["unmet"]["light_bound"], 0.0);
    EXPECT_FALSE(stats()["error"]["complete"]);
    EXPECT_TRUE(holds(result.err, {"are found where one happens to hit a light"}));

    result = mirror({"--sun", "0,1,1,3,3,3,0.5", "--frames", "2", "-o", "t.png"});
    EXPECT_TRUE(holds(result.out, {"frame 1 of 2", "% (", "frame 2 of 2"}));
}

// A small floor before the sky. Whatever colour a backdrop has and however much of it the picture shows, the
// error is that of the floor.
TEST_F(ErrorReport, IsThatOfThePixelsThatShowTheScene) {
    write_lamp();
    const std::vector<std::string> far = {"--eye", "0,9,12", "--at", "0,0,0"};
    const auto before = [&](const char* sky, std::vector<std::string> more) {
        more.insert(more.end(),
                    {"lamp.obj", "--stats", "s.json", "-r", "48x48", "--env", sky, "-o", "a.exr"});
        more.insert(more.end(), far.begin(), far.end());
        return clrt(more);
    };
    CommandResult result = before("1,1,1", {"--spp", "64", "--checkpoint", "a.film"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json white = stats()["error"];
    EXPECT_EQ(white["over"], "scene");
    EXPECT_GT(white["scene_share"], 0.03);
    EXPECT_LT(white["scene_share"], 0.5);
    const double of_scene = white["rel_rmse"], of_all = white["whole_picture"]["rel_rmse"];
    EXPECT_GT(of_scene, 1.5 * of_all) << "a white backdrop hides the error";
    EXPECT_LT(white["whole_picture"]["low"], of_all);
    EXPECT_TRUE(std::regex_search(
        result.out,
        std::regex("scene    the error is that of the [0-9.]+ % of the pixels that show it; over all "
                   "pixels [0-9.]+ %\n")))
        << result.out;
    EXPECT_EQ(ReadPicture(folder.file("a.exr")).spec.get_string_attribute("clrt.error.over"), "scene");

    // --error means it, and so do a merged film and one that is resumed.
    result = before("1,1,1", {"--spp", "64", "--error", std::to_string(0.5 * (of_scene + of_all))});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_EQ(stats()["stop"]["error_reached"], false);
    const CommandResult merged =
        run_command({CLRT_MERGE_EXECUTABLE, folder.file("a.film"), "-o", folder.file("m.exr")});
    EXPECT_TRUE(holds(merged.out, {"scene    the error is that of the "})) << merged.out;
    result = clrt({"--resume", "a.film", "--spp", "64", "--stats", "s.json", "-o", "r.exr"});
    for (const char* fact : {"rel_rmse", "low", "high", "over", "scene_share", "whole_picture", "worst_tile"})
        EXPECT_EQ(stats()["error"][fact], white[fact]) << fact;

    // A black backdrop would make the error over all pixels larger.
    before("0,0,0", {"--spp", "64"});
    const nlohmann::json black = stats()["error"];
    EXPECT_EQ(black["scene_share"], white["scene_share"]);
    EXPECT_LT(black["rel_rmse"], 0.8 * black["whole_picture"]["rel_rmse"].get<double>());

    // Nothing but the scene.
    render({"--spp", "64"});
    const nlohmann::json full = stats()["error"];
    EXPECT_EQ(full["over"], "picture");
    EXPECT_EQ(full["scene_share"], 1);
    EXPECT_EQ(full["whole_picture"]["rel_rmse"], full["rel_rmse"]);
}

TEST_F(ErrorReport, WhatIsNotKnownIsNull) {
    write_lamp();
    EXPECT_EQ(render({"--spp", "32"}).exit_code, 0);
    EXPECT_EQ(stats()["error"]["slope"], nullptr) << "three octaves from 4 to 32";
    EXPECT_EQ(stats()["error"]["half"]["slope_measured"], true) << "but one of the forecast";
    EXPECT_EQ(render({"--spp", "4"}).exit_code, 0);
    EXPECT_EQ(stats()["error"]["half"]["slope"], -0.55) << "of renders in general";
    EXPECT_EQ(stats()["error"]["half"]["slope_measured"], false);
    EXPECT_EQ(render({"--spp", "64", "--replicates", "3"}).exit_code, 0);
    EXPECT_EQ(stats()["error"]["low"], nullptr);
    EXPECT_GT(stats()["error"]["rel_rmse"], 0);
    EXPECT_EQ(render({"--spp", "1"}).exit_code, 0);
    EXPECT_EQ(stats()["error"]["rel_rmse"], nullptr);
}

} // namespace clrt
