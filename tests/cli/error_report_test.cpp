// SPDX-License-Identifier: Apache-2.0
// What a run says about its error: stop rules and their exit codes, printed lines, JSON, metadata.
#include "clrt_command.h"

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

TEST_F(ErrorReport, AReachedTargetEndsWithZeroAtADoubling) {
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
    EXPECT_EQ(spp & (spp - 1), 0u) << spp;
    EXPECT_EQ(json["passes"], spp);
    // With a quarter of the samples it was not reached yet: the render did not go on in vain.
    EXPECT_EQ(render({"--error", "2%", "--spp", std::to_string(spp / 2)}).exit_code, 5);
}

// The error that ended the render, against two long runs with other seeds: mean((x - a)(x - b)) is the
// squared error of x without the noise of a and b.
TEST_F(ErrorReport, AReachedTargetIsTrueOnTheCornellBox) {
    const auto box = [&](const std::string& name, std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {CLRT_SCENES_FOLDER "/cornell_box/cornell_box.obj", "-r", "64x64",
                                           "--aov", "none", "--stats", "s.json", "-o", name});
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ReadPicture(folder.file(name));
    };
    const ReadPicture a = box("a.exr", {"--spp", "512", "--seed", "1"}),
                      b = box("b.exr", {"--spp", "512", "--seed", "2"});
    const ReadPicture x = box("x.exr", {"--error", "10%"});
    double squared = 0, mean = 0;
    for (size_t i = 0; i < x.values.size(); ++i) {
        squared +=
            double(x.values[i] - a.values[i]) * double(x.values[i] - b.values[i]) / double(x.values.size());
        mean += double(x.values[i]) / double(x.values.size());
    }
    const double printed = stats()["error"]["rel_rmse"];
    std::printf("printed %.2f %%, true over printed %.3f\n", 100 * printed,
                std::sqrt(squared) / mean / printed);
    EXPECT_LE(printed, 0.1);
    EXPECT_NEAR(std::sqrt(squared) / mean / printed, 1, 0.15);
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

TEST_F(ErrorReport, TheReportHasErrorPriceWorstTileAndTails) {
    write_lamp();
    const CommandResult result = render({"--spp", "128", "-o", "a.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"ended after 128 spp: --spp 128 is complete"}));
    const std::string number = "[0-9.]+ %";
    for (const std::string& line :
         {"error    " + number + " relative RMSE \\(95 %: " + number + " to " + number +
              "\\), slope -[0-9.]+ \\+- [0-9.]+ from 8 to 128 spp\n",
          "price    " + number +
              " takes [0-9.]+ times the samples, [0-9.]+ s more \\(extrapolated by the measured slope",
          "worst    " + number + " of the picture's mean in the 32 x 32 tile at 0,0\n",
          std::string("tails    the noisiest [a-z]+ of the pixels hold [0-9]+ % of the squared error; [0-9]+ "
                      "% was seen by one "
                      "replicate alone, which makes it uncertain by [0-9.]+ %: the error can be believed\n"),
          std::string("checked  NaN 0, infinite 0"), std::string("absent   "), std::string("seconds  load")})
        EXPECT_TRUE(std::regex_search(result.out, std::regex(line))) << line << "\n" << result.out;

    const nlohmann::json json = stats(), error = json["error"];
    EXPECT_LT(error["low"], error["rel_rmse"]);
    EXPECT_GT(error["high"], error["rel_rmse"]);
    EXPECT_LT(error["slope"]["value"], -0.4);
    EXPECT_EQ(error["half"]["slope_measured"], true);
    EXPECT_NEAR(error["half"]["rel_rmse"], 0.5 * error["rel_rmse"].get<double>(), 1e-12);
    const double factor = std::exp2(-1 / error["slope"]["value"].get<double>());
    EXPECT_NEAR(error["half"]["samples_factor"], factor, 1e-9);
    EXPECT_NEAR(error["half"]["seconds"], json["seconds"]["render"].get<double>() * (factor - 1), 1e-6);
    EXPECT_NEAR(error["worst_tile"]["rel_rmse"], error["rel_rmse"].get<double>(), 1e-6)
        << "there is one tile";
    EXPECT_LT(error["tails"]["once_share"], 0.2);
    EXPECT_LT(error["tails"]["once_error"], 0.1);
    EXPECT_EQ(error["tails"]["usable"], true);
    EXPECT_EQ(json["stop"]["error_reached"], nullptr);

    const ReadPicture picture(folder.file("a.exr"));
    for (const char* name : {"clrt.error", "clrt.error.low", "clrt.error.high", "clrt.error.slope",
                             "clrt.error.usable", "clrt.stop"})
        EXPECT_NE(picture.spec.find_attribute(name), nullptr) << name;
}

TEST_F(ErrorReport, WhatIsNotKnownIsNull) {
    write_lamp();
    EXPECT_EQ(render({"--spp", "64"}).exit_code, 0);
    EXPECT_EQ(stats()["error"]["slope"], nullptr) << "three octaves from 8 to 64";
    EXPECT_EQ(stats()["error"]["half"]["slope"], -0.5) << "of independent samples";
    EXPECT_EQ(render({"--spp", "64", "--replicates", "3"}).exit_code, 0);
    EXPECT_EQ(stats()["error"]["low"], nullptr);
    EXPECT_GT(stats()["error"]["rel_rmse"], 0);
    EXPECT_EQ(render({"--spp", "1"}).exit_code, 0);
    EXPECT_EQ(stats()["error"]["rel_rmse"], nullptr);
}

} // namespace clrt
