// SPDX-License-Identifier: Apache-2.0
// What the command line refuses, and in which words.
#include "app/option_table.h"
#include "app/peer_names.h"
#include "host/command_line_support.h"
#include "probes/scratch_folder.h"

#include <gtest/gtest.h>
#include <regex>

namespace clrt {

TEST(CommandLine, OneSceneIsExpected) {
    EXPECT_NE(refusal({}).find("expected a scene"), std::string::npos);
    EXPECT_NE(refusal({"a.obj", "b.obj"}).find("expected one scene, found 2: 'a.obj' and 'b.obj'"),
              std::string::npos);
    EXPECT_NE(refusal({"a.clrt"}).find("expected a scene such as STEM.obj"), std::string::npos);
    EXPECT_EQ(parse_all({"--", "-odd.obj"}).options.scene.path, "-odd.obj");
}

TEST(CommandLine, UnknownOptionsNameTheNearest) {
    EXPECT_EQ(refusal({"--szie", "3", "s.obj"}),
              "unknown option --szie; the nearest is --size, and `clrt --help` lists all");
    EXPECT_NE(refusal({"--integratr=path", "s.obj"})
                  .find("unknown option --integratr; the nearest is --integrator"),
              std::string::npos);
    EXPECT_NE(refusal({"--dev", "pocl", "s.obj"}).find("the nearest is --device"), std::string::npos);
    EXPECT_EQ(refusal({"-x", "s.obj"}), "unknown option -x; `clrt --help` lists all");
}

TEST(CommandLine, LongNamesWithOneDashAreNotReadAsShortOnes) {
    EXPECT_EQ(refusal({"-spp", "4", "s.obj"}), "option -spp: expected two dashes before a long name, --spp");
    EXPECT_NE(refusal({"-output=a.png", "s.obj"}).find("long name, --output"), std::string::npos);
    EXPECT_NE(refusal({"-quiet", "s.obj"}).find("long name, --quiet"), std::string::npos);
    EXPECT_EQ(parse_all({"-s4", "-q", "--", "-spp"}).options.scene.path, "-spp");
}

TEST(CommandLine, UnknownOptionsWithoutANearOneNameNone) {
    for (const char* name : {"--xyzzy", "--frobnicate", "--caustics"})
        EXPECT_EQ(refusal({name, "s.obj"}),
                  std::string("unknown option ") + name + "; `clrt --help` lists all");
}

TEST(CommandLine, NamesOfOtherRenderersLeadToTheirNameHere) {
    EXPECT_EQ(refusal({"--resolution", "640x480", "s.obj"}),
              "unknown option --resolution; clrt calls it --size WxH, and `clrt --help` lists all");
    const std::vector<std::pair<std::string, std::string>> names = {
        {"--width=640", "--size WxH"},      {"--samples", "--spp N"},
        {"--samplesPerPixel", "--spp N"},   {"--output-file", "--output FILE"},
        {"--gpu", "--device gpu"},          {"--max_bounces=3", "--max-depth N"},
        {"--nthreads", "--threads N"},      {"--cropwindow", "--crop X0,Y0,X1,Y1"},
        {"--hdri", "--env FILE"},           {"--EnvMap", "--env FILE"},
        {"--noise-threshold", "--error X"}, {"--view-transform", "--tonemap NAME"}};
    for (const auto& [typed, here] : names)
        EXPECT_NE(refusal({typed, "s.obj"}).find("; clrt calls it " + here + ", and "), std::string::npos)
            << refusal({typed, "s.obj"});
}

TEST(CommandLine, EveryNameOfOtherRenderersIsForeignAndLeadsToAnOption) {
    for (const auto& [peer, here] : peer_names()) {
        EXPECT_FALSE(find_option(std::string("--") + peer)) << peer << " is an option here";
        EXPECT_EQ(name_here(peer), here) << peer << " is listed twice";
        const std::string text = here;
        const std::regex option("--[a-z-]+");
        for (std::sregex_iterator found(text.begin(), text.end(), option), end; found != end; ++found)
            EXPECT_TRUE(find_option(found->str())) << peer << ": " << found->str();
    }
}

TEST(CommandLine, MissingValuesAreNamed) {
    EXPECT_EQ(refusal({"s.obj", "--spp"}),
              "option --spp: expected a value, found the end of the command line");
    EXPECT_EQ(refusal({"--spp", "--time", "5", "s.obj"}),
              "option --spp: expected a value N, found the option --time");
    EXPECT_EQ(refusal({"--device=", "s.obj"}), "option --device: expected a value after '=', found none");
    EXPECT_EQ(refusal({"--device", "", "s.obj"}), "option --device: expected a name, found ''");
    EXPECT_EQ(refusal({"--no-sidecar=3", "s.obj"}), "option --no-sidecar takes no value, found '3'");
}

TEST(CommandLine, BadValuesNameOptionValueAndExpectation) {
    const std::vector<std::pair<std::string, std::string>> bad = {
        {"--integrator", "pth"},
        {"--spp", "0"},
        {"--spp", "4.5"},
        {"--spp", "4294967296"},
        {"--spp", "-1"},
        {"--spp", "99999999999999999999"},
        {"--error", "-1"},
        {"--error", "101%"},
        {"--error", "small"},
        {"--time", "0"},
        {"--time", "5d"},
        {"--time", "-5s"},
        {"--time", "s"},
        {"--time", "inf"},
        {"--max-depth", "0"},
        {"--max-depth", "65536"},
        {"--roulette-depth", "0"},
        {"--min-contribution", "1.1"},
        {"--shadow-rays", "0"},
        {"--gloss-rays", "65"},
        {"--translucent-rays", "2.5"},
        {"--min-contribution", "-1%"},
        {"--seed", "-1"},
        {"--seed", "0x10"},
        {"--replicates", "0"},
        {"--replicates", "65"},
        {"--sampler", "halton"},
        {"--light-sampler", "uniform"},
        {"--precision", "half"},
        {"--threads", "-1"},
        {"--bvh", "bvh4"},
        {"--bvh", "bvh8,bvh2"},
        {"--bvh", "cwbvh,bvh8"},
        {"--bvh", "high,fast"},
        {"--bvh", "auto,high"},
        {"--bvh", ""},
        {"--material", "wood"},
        {"--size", "800"},
        {"--size", "0x600"},
        {"--size", "800x65536"},
        {"--size", "800x600x3"},
        {"--size", "-800x600"},
        {"--crop", "0,0,10"},
        {"--crop", "5,0,5,10"},
        {"--crop", "-1,0,5,10"},
        {"--crop", "0,0,1.5,10"},
        {"--filter", "sinc"},
        {"--filter", "box:0"},
        {"--filter", "tent:"},
        {"--filter", "tent:nan"},
        {"--exposure", "1e9"},
        {"--exposure", "bright"},
        {"--exposure", "automatic"},
        {"--exposure", "auto+"},
        {"--exposure", "auto+101"},
        {"--tonemap", "film"},
        {"--png-from", "both"},
        {"--aov", "denoised=LDE"},
        {"--aov", "albedo,depth"},
        {"--aov", "N,N"},
        {"--aov", "N,none"},
        {"--aov", ""},
        {"--aov", "N=LDE"},
        {"--aov", "strategies:0"},
        {"--aov", "strategies:9"},
        {"--aov", "strategies:12"},
        {"--aov", "strategies:x"},
        {"--aov", "strategies,strategies:3"},
        {"--eye", "1,2"},
        {"--eye", "1,2,x"},
        {"--eye", "1,2,nan"},
        {"--at", "1,2,1e39"},
        {"--eye", "1,2,3,4"},
        {"--up", "0,0,-0"},
        {"--projection", "ortho"},
        {"--ortho-height", "0"},
        {"--fov", "0"},
        {"--fov", "180"},
        {"--fov", "inf"},
        {"--fov", "360"},
        {"--shift", "1"},
        {"--aperture", "-1"},
        {"--fstop", "0"},
        {"--focus", "0"},
        {"--focus", "1,2"},
        {"--focus", "near"},
        {"--blades", "2"},
        {"--blades", "4.5"},
        {"--blades", "65"},
        {"--end-eye", "1,2"},
        {"--end-up", "0,0,0"},
        {"--shutter", "0.5"},
        {"--shutter", "0.6,0.5"},
        {"--shutter", "0,1.1"},
        {"--shutter", "-0.1,1"},
        {"--focal-length", "0"},
        {"--film-width", "-1"},
        {"--env-scale", "-1"},
        {"--env-rotate", "north"},
        {"--sun", "0,0,0,1,1,1"},
        {"--sun", "0,1,0,1,1"},
        {"--sun", "0,1,0,1,1,-1"},
        {"--sun", "0,1,0,1,1,1,-1"},
        {"--sun", "0,1,0,1,1,1,91"},
        {"--point", "0,1,0,1,1"},
        {"--point", "0,1,0,1,1,-1"},
        {"--spot", "0,1,0,0,0,0,1,1,1"},
        {"--spot", "0,1,0,0,-1,0,1,1,-1"},
        {"--spot", "0,1,0,0,-1,0,1,1"},
        {"--spot", "0,1,0,0,-1,0,1,1,1,30,31"},
        {"--spot", "0,1,0,0,-1,0,1,1,1,181"},
        {"--sky", "30"},
        {"--sky", "91,0"},
        {"--sky", "-13,0"},
        {"--sky", "30,0,0.5"},
        {"--sky", "30,0,3,1.5"},
        {"--studio", "on"},
        {"--ground", "grey"},
        {"--ground", "0.5,0.5,1.01"},
        {"--ground", "0.5,-0.5,0.5"},
        {"--background", "grey"},
        {"--background", "1,1"},
        {"--background", "1,1,-1"},
        {"--effects", "most"},
        {"--check", "yes"},
        {"--cache", "maybe"},
        {"--progress", "1"},
        {"--output", "a.gif"},
        {"--output", "picture"},
        {"--kernels", ""},
        {"--stats", ""},
    };
    for (const auto& [option, value] : bad) {
        const std::string message = refusal({option, value, "s.obj"});
        EXPECT_EQ(message.find("option " + option + ": expected "), 0u)
            << option << " " << value << ": " << message;
        EXPECT_NE(message.find(", found '"), std::string::npos) << message;
    }
    EXPECT_EQ(
        refusal({"--integrator", "pth", "s.obj"}),
        "option --integrator: expected raycast, whitted, distribution, light, path, path+light, bdpt, mlt or "
        "auto, found "
        "'pth'");
}

TEST(CommandLine, ContradictionsAreNamed) {
    const auto expect = [](const std::vector<std::string>& arguments, const std::string& part) {
        std::vector<std::string> all = arguments;
        all.emplace_back("s.obj");
        const std::string message = refusal(all);
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect({"-q", "-v"}, "options --quiet and --verbose: expected one of them");
    expect({"--cache", "on", "--no-cache"}, "options --cache and --no-cache");
    expect({"--env", "1,1,1", "--sky", "30,0"}, "options --env and --sky: expected one of them");
    expect({"--env-rotate", "9", "--sky", "30,0"}, "options --env-rotate and --sky");
    expect({"--fov", "40", "--focal-length", "35", "--film-width", "24"}, "options --fov and --focal-length");
    expect({"--projection", "orthographic", "--fov", "40"}, "option --fov: expected --ortho-height");
    expect({"--projection", "orthographic", "--focal-length", "35", "--film-width", "24"},
           "option --focal-length: expected --ortho-height");
    expect({"--ortho-height", "2"},
           "option --ortho-height: expected --projection orthographic, found perspective");
    expect({"--projection", "orthographic", "--ortho-height", "2", "--fov", "40"},
           "options --fov and --ortho-height");
    expect({"--focal-length", "35"}, "option --focal-length: expected together with --film-width");
    expect({"--film-width", "35"}, "option --film-width: expected together with --focal-length");
    expect(
        {"--projection", "equirectangular", "--fov", "90"},
        "option --fov: expected --projection perspective, found equirectangular, which shows all directions");
    expect({"--projection", "fisheye", "--focal-length", "35", "--film-width", "24"},
           "option --focal-length: expected --projection perspective, found fisheye, whose angle of view is "
           "--fov");
    expect({"--projection", "fisheye", "--fov", "217"},
           "option --fov: expected at most 216 degrees with --projection fisheye and --size 800x600");
    expect({"--projection", "fisheye", "--shift", "0.1,0"},
           "option --shift: expected --projection perspective or orthographic, found fisheye");
    expect({"--projection", "equirectangular", "--aperture", "0.1"},
           "option --aperture: expected --projection perspective or orthographic, found equirectangular");
    expect({"--fstop", "2.8"}, "option --fstop: expected together with --focal-length and --film-width");
    expect({"--fstop", "2.8", "--fov", "40"}, "option --fstop: expected together with --focal-length");
    expect({"--fstop", "2.8", "--aperture", "1"}, "options --aperture and --fstop: expected one of them");
    expect({"--focus", "3"}, "option --focus: expected together with --aperture or --fstop, found alone");
    expect({"--blades", "5"}, "option --blades: expected together with --aperture or --fstop, found alone");
    expect({"--shutter", "0,0.5"}, "option --shutter: expected together with what moves");
    expect({"--frames", "4", "--end-up", "x"}, "options --frames and --end-up: expected one of them");
    expect({"--crop", "0,0,801,10"}, "option --crop: expected a window inside the picture of 800x600 pixels");
    expect({"-r", "65501x2", "-o", "a.JPG"},
           "option --size: expected at most 65500 pixels a side for 'a.JPG', found 65501x2");
    expect({"-r", "65535x2", "--crop", "9,0,65512,1", "-o", "a.jpg"},
           "option --crop: expected at most 65500 pixels a side for 'a.jpg', found 65503x1");
    expect({"-i", "whitted", "--max-depth", "65"}, "option --max-depth: expected at most 64");
    expect({"--first-sample", "4294967232"}, "expected a sum below 4294967296, found 4294967296");
    expect({"--first-sample", "4294967295", "--spp", "1"}, "expected a sum below 4294967296");
    expect({"--first-sample", "4294901760", "--error", "1%"}, "expected a sum below 4294967296");
    expect({"--error", "1%", "--replicates", "3"}, "option --error: expected --replicates 4 or more");
    expect({"--error", "1%", "--denoised-error", "5%"}, "options --error and --denoised-error");
    expect({"--denoised-error", "5%", "--replicates", "2"},
           "option --denoise: expected an even number of --replicates from 4, found 2");
    expect({"--first-sample", "4294901760", "--denoised-error", "1%"}, "expected a sum below 4294967296");
    expect({"--denoise", "--replicates", "2"},
           "option --denoise: expected an even number of --replicates from 4, found 2");
    expect({"--denoise", "--spp", "3"},
           "option --denoise: expected --spp 4 or more with --replicates 4, found 3");
    expect({"--denoise", "--ledger"}, "options --denoise and --ledger: expected one of them");
    expect({"--png-from", "denoised"}, "option --png-from denoised: expected together with --denoise");
    expect({"--adaptive", "--replicates", "2"},
           "option --adaptive: expected an even number of --replicates from 4");
    expect({"--adaptive", "--replicates", "5"},
           "option --adaptive: expected an even number of --replicates from 4");
    expect({"--adaptive", "--spp", "7"},
           "option --adaptive: expected --spp 8 or more with --replicates 4, found 7");
    expect({"--adaptive", "--first-sample", "8"}, "option --adaptive: expected no --first-sample, found 8");
    expect({"--adaptive", "--aov", "c=LSDE", "-o", "a.exr"},
           "option --adaptive: expected no --aov NAME=EXPR, found the "
           "layer 'c'");
    expect({"--adaptive", "--ledger"}, "option --adaptive: expected no --ledger");
    for (const std::string name : {"path", "path+light", "light", "whitted", "auto"})
        expect({"-i", name, "--aov", "strategies", "-o", "a.exr"},
               "option --aov strategies: expected --integrator bdpt, found " + name +
                   ", which has no strategies");
    expect({"-i", "mlt", "--aov", "strategies:3", "-o", "a.exr"},
           "option --aov strategies: expected --integrator bdpt, found mlt, whose chains choose");
    expect({"-i", "bdpt", "--aov", "strategies"},
           "option --aov strategies: expected an output that ends in .exr, found none");
    expect({"-i", "mlt", "--pixel", "1,2"},
           "options --pixel and --integrator mlt: expected one of them, found both; a step of a chain needs");
    expect({"-i", "mlt", "--ledger"},
           "options --ledger and --integrator mlt: expected one of them, found both; the ledger compares");
    expect({"--guide", "on", "--first-sample", "8"},
           "options --guide on and --first-sample: expected one of them, found both; guided samples need");
    for (const std::string name : {"whitted", "mlt"})
        expect({"--guide", "on", "-i", name},
               "options --guide on and --integrator " + name +
                   ": expected one of them, found both; its paths are not guided");
    expect({"--path-reuse", "on", "-i", "bdpt"},
           "options --path-reuse on and --integrator bdpt: expected one of them, found both");
    expect({"--path-reuse", "on", "--crop", "4,0,16,8"},
           "options --path-reuse on and --crop: expected one of them, found both; paths serve the pixels");
    expect({"--path-reuse", "on", "--pixel", "1,1"},
           "options --path-reuse on and --pixel: expected one of them, found both; a replay shows");
    expect({"--guide", "on", "--adaptive"},
           "options --guide on and --adaptive: expected one of them, found both; its halves");
    expect({"--guide", "on", "--replicates", "2"}, "options --guide on and --replicates: expected one of");
    expect({"--eye", "1,2,3", "--at", "1,2,3"}, "expected two different points");
    EXPECT_EQ(parse({"--first-sample", "4294967231"}).sampling.first_sample, 4294967231u);
    EXPECT_EQ(parse({"-i", "whitted", "--max-depth", "64"}).transport.max_depth, 64);
}

TEST(CommandLine, MissingOutputFolderStopsBeforeAnyWork) {
    ScratchFolder folder;
    EXPECT_THROW(parse({"-o", folder.file("absent/a.png")}), SceneError);
    EXPECT_THROW(parse({"--stats", folder.file("absent/s.json")}), SceneError);
    EXPECT_NO_THROW(parse({"-o", folder.file("a.png"), "--stats", folder.file("s.json")}));
    EXPECT_NO_THROW(parse({"-o", folder.file("absent/a.png"), "--explain"}));
}

TEST(CommandLine, AnErrorThatNothingReachesIsRefused) {
    for (const char* none : {"0", "0%"})
        EXPECT_NE(refusal({"--error", none, "s.obj"}).find("above 0"), std::string::npos) << none;
}

} // namespace clrt
