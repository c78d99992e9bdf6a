// SPDX-License-Identifier: Apache-2.0
// What clrt writes: pictures with their layers and metadata, statistics, dumped kernels; where, and which way
// up.
#include "clrt_command.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class PictureFile : public ClrtCommand {
protected:
    /// Writes scene.obj: a lamp in the upper left quarter of a picture taken with CAMERA, black elsewhere.
    void write_corner_lamp() const {
        folder.write("scene.mtl", "newmtl lamp\nKd 0 0 0\nKe 0.5 0.25 1\n");
        folder.write("scene.obj",
                     "mtllib scene.mtl\nusemtl lamp\nv -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nf 1 2 3 4\n");
    }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(folder.read(name)); }

    const std::vector<std::string> CAMERA = {"--eye", "0,0,3", "--at", "0,0,0", "--fov", "30"};
    std::vector<std::string> with_camera(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), CAMERA.begin(), CAMERA.end());
        return arguments;
    }
};

} // namespace

TEST_F(PictureFile, PixelZeroIsTopLeftInEveryFormat) {
    write_corner_lamp();
    const auto result =
        clrt(with_camera(quick({"scene.obj", "-o", "a.png", "-o", "a.exr", "-o", "a.hdr", "-o", "a.pfm", "-o",
                                "a.tif", "-o", "a.ppm", "-o", "a.jpg"})));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const char* name : {"a.png", "a.exr", "a.hdr", "a.pfm", "a.tif", "a.ppm", "a.jpg"}) {
        const ReadPicture picture(folder.file(name));
        ASSERT_EQ(picture.spec.width, 16) << name;
        ASSERT_EQ(picture.spec.height, 12) << name;
        const std::string format = name;
        const bool display = format == "a.png" || format == "a.ppm" || format == "a.jpg";
        // sRGB of 0.25 is 0.537.
        EXPECT_NEAR(picture.at(0, 0, "G"), display ? 0.537 : 0.25, format == "a.jpg" ? 0.03 : 0.003) << name;
        EXPECT_NEAR(picture.at(15, 0, "G"), 0, 0.03) << name;
        EXPECT_NEAR(picture.at(0, 11, "G"), 0, 0.03) << name;
        EXPECT_NEAR(picture.at(15, 11, "G"), 0, 0.03) << name;
    }
}

TEST_F(PictureFile, TheDefaultIsAPngInTheCurrentFolder) {
    write_corner_lamp();
    std::filesystem::create_directory(folder.file("elsewhere"));
    CommandSettings settings;
    settings.folder = folder.file("elsewhere");
    ASSERT_EQ(clrt(quick({"../scene.obj"}), settings).exit_code, 0);
    EXPECT_TRUE(exists("elsewhere/scene.png"));
    EXPECT_EQ(listing(), (std::vector<std::string>{"elsewhere", "scene.mtl", "scene.obj"}));
    const ReadPicture picture(folder.file("elsewhere/scene.png"));
    EXPECT_EQ(picture.spec.nchannels, 3) << "no alpha";
    EXPECT_EQ(picture.spec.format, OIIO::TypeDesc::UINT8);
}

TEST_F(PictureFile, WithoutFlagsThePictureHas800By600Pixels) {
    write_square("scene");
    ASSERT_EQ(clrt({"scene.obj", "-s", "1", "-i", "raycast"}).exit_code, 0);
    const ReadPicture picture(folder.file("scene.png"));
    EXPECT_EQ(picture.spec.width, 800);
    EXPECT_EQ(picture.spec.height, 600);
}

TEST_F(PictureFile, ExposureAndTonemapChangeDisplayFilesOnly) {
    write_corner_lamp();
    ASSERT_EQ(
        clrt(with_camera(quick({"scene.obj", "-o", "a.png", "-o", "a.exr", "--exposure", "1"}))).exit_code,
        0);
    EXPECT_NEAR(ReadPicture(folder.file("a.png")).at(0, 0, "G"), 0.735, 0.003) << "sRGB of 0.5";
    EXPECT_NEAR(ReadPicture(folder.file("a.exr")).at(0, 0, "G"), 0.25, 1e-6);
    ASSERT_EQ(clrt(with_camera(quick({"scene.obj", "-o", "b.png", "--tonemap", "reinhard"}))).exit_code, 0);
    EXPECT_LT(ReadPicture(folder.file("b.png")).at(0, 0, "G"), 0.5);
}

TEST_F(PictureFile, LayersDescribeWhatThePixelsSee) {
    folder.write("m.mtl", "newmtl a\nKd 0.25 0.5 0.75\nnewmtl b\nKd 0.1 0.2 0.3\n");
    folder.write("scene.obj",
                 "mtllib m.mtl\nv -1 -1 2\nv 0 -1 2\nv 0 1 2\nv -1 1 2\nv 0 -1 2\nv 1 -1 2\nv 1 1 2\n"
                 "v 0 1 2\no left\nusemtl a\nf 1 2 3 4\no right\nusemtl b\nf 5 6 7 8\n");
    // Sixteen units wide at distance 4: the squares fill eight columns and six rows around the centre.
    const auto result = clrt({"scene.obj", "-r", "16x12", "-s", "4", "-i", "raycast", "-o", "a.exr", "--eye",
                              "0,0,6", "--at", "0,0,0", "--focal-length", "1", "--film-width", "1", "--aov",
                              "albedo,N,Z,P,objectId,materialId,variance,samples,alpha"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ReadPicture picture(folder.file("a.exr"));
    EXPECT_EQ(picture.spec.channelnames[0], "R");
    EXPECT_EQ(picture.spec.channelnames[1], "G");
    EXPECT_EQ(picture.spec.channelnames[2], "B");
    const int inside_y = 6;
    for (const auto& [x, id, green] : {std::tuple{5, 1, 0.5f}, {10, 2, 0.2f}}) {
        EXPECT_EQ(picture.at(x, inside_y, "objectId"), float(id));
        EXPECT_EQ(picture.at(x, inside_y, "materialId"), float(id));
        EXPECT_NEAR(picture.at(x, inside_y, "albedo.G"), green, 1e-6);
        EXPECT_NEAR(picture.at(x, inside_y, "N.Z"), 1, 1e-6);
        EXPECT_NEAR(picture.at(x, inside_y, "Z"), 4, 1e-5);
        EXPECT_NEAR(picture.at(x, inside_y, "P.Z"), 2, 1e-5);
        EXPECT_NEAR(picture.at(x, inside_y, "P.X"), (x + 0.5 - 8) / 4, 0.1);
        EXPECT_NEAR(picture.at(x, inside_y, "P.Y"), (6 - inside_y - 0.5) / 4, 0.1);
        EXPECT_EQ(picture.at(x, inside_y, "A"), 1);
        EXPECT_EQ(picture.at(x, inside_y, "samples"), 4);
        EXPECT_GE(picture.at(x, inside_y, "variance.R"), 0);
    }
    EXPECT_EQ(picture.at(0, 0, "objectId"), 0) << "nothing";
    EXPECT_EQ(picture.at(0, 0, "A"), 0);
    EXPECT_TRUE(std::isinf(picture.at(0, 0, "Z")));
    EXPECT_EQ(picture.spec.channelformat(picture.spec.channelindex("objectId")), OIIO::TypeDesc::UINT32);
}

TEST_F(PictureFile, AllLayersButAlphaComeByDefaultAndNoneOnRequest) {
    write_square("scene");
    ASSERT_EQ(clrt({"scene.obj", "-r", "16x12", "-s", "8", "-i", "raycast", "-o", "a.exr"}).exit_code, 0);
    const ReadPicture all(folder.file("a.exr"));
    for (const char* channel :
         {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "Z", "P.X", "P.Y", "P.Z",
          "objectId", "materialId", "variance.R", "variance.B", "samples"})
        EXPECT_GE(all.spec.channelindex(channel), 0) << channel;
    EXPECT_LT(all.spec.channelindex("A"), 0);
    ASSERT_EQ(clrt(quick({"scene.obj", "-o", "b.exr", "--aov", "none"})).exit_code, 0);
    EXPECT_EQ(ReadPicture(folder.file("b.exr")).spec.nchannels, 3);
}

TEST_F(PictureFile, MetadataTellHowThePictureWasMade) {
    write_square("scene");
    ASSERT_EQ(clrt({"scene.obj", "-r", "16x12", "-s", "16", "-i", "raycast", "-o", "a.exr", "--seed", "7"})
                  .exit_code,
              0);
    const ReadPicture picture(folder.file("a.exr"));
    for (const char* name : {"version", "command", "device", "driver", "seed", "spp", "seconds.load",
                             "seconds.bvh", "seconds.compile", "seconds.render", "effects", "error", "nan",
                             "infinite", "device.same_bits", "device.facts"})
        EXPECT_FALSE(picture.spec.get_string_attribute(std::string("clrt.") + name).empty()) << name;
    EXPECT_EQ(picture.spec.get_string_attribute("clrt.seed"), "7");
    EXPECT_EQ(picture.spec.get_string_attribute("clrt.spp"), "16");
    EXPECT_TRUE(holds(picture.spec.get_string_attribute("clrt.command"), {"clrt", "scene.obj", "--seed 7"}));
}

TEST_F(PictureFile, BitsArePromisedInSingleOnlyAndWhereTheDeviceWasAsked) {
    write_square("scene");
    const std::vector<std::string> render = {"scene.obj", "-r",      "16x12",   "-s",    "1",
                                             "-i",        "raycast", "--stats", "s.json"};
    const auto device = [&](std::initializer_list<std::string> more) {
        std::vector<std::string> arguments = render;
        arguments.insert(arguments.end(), more);
        EXPECT_EQ(clrt(arguments).exit_code, 0);
        return json("s.json")["device"];
    };
    EXPECT_EQ(device({"--precision", "fast"})["same_bits"], false);
    const auto unasked = device({"--no-cache"});
    EXPECT_TRUE(unasked["same_bits"].is_null());
    EXPECT_TRUE(unasked["facts"].is_null());
}

TEST_F(PictureFile, AWindowKeepsItsPlaceInTheWholePicture) {
    write_corner_lamp();
    const std::vector<std::string> whole = {"scene.obj", "-r", "16x12", "-s", "2", "-i", "raycast"};
    std::vector<std::string> first = with_camera(whole), second = with_camera(whole);
    first.insert(first.end(), {"-o", "whole.exr"});
    second.insert(second.end(), {"--crop", "5,3,12,9", "-o", "part.exr", "-o", "part.png"});
    ASSERT_EQ(clrt(first).exit_code, 0);
    ASSERT_EQ(clrt(second).exit_code, 0);
    const ReadPicture all(folder.file("whole.exr")), part(folder.file("part.exr")),
        png(folder.file("part.png"));
    EXPECT_EQ(part.spec.x, 5);
    EXPECT_EQ(part.spec.y, 3);
    EXPECT_EQ(part.spec.full_width, 16);
    EXPECT_EQ(part.spec.full_height, 12);
    ASSERT_EQ(part.spec.width, 7);
    ASSERT_EQ(part.spec.height, 6);
    EXPECT_EQ(png.spec.width, 7);
    EXPECT_EQ(png.spec.height, 6);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 7; ++x)
            for (const char* channel : {"R", "G", "B", "P.X", "samples"})
                EXPECT_EQ(part.at(x, y, channel), all.at(x + 5, y + 3, channel)) << channel;
}

TEST_F(PictureFile, StatisticsAreJsonInSiUnits) {
    write_square("scene");
    const auto result = clrt({"scene.obj", "-r", "16x12", "-s", "16", "-i", "raycast", "--point",
                              "0,0,3,9,9,9", "--stats", "s.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto stats = json("s.json");
    EXPECT_EQ(stats["spp"], 16);
    EXPECT_EQ(stats["passes"], 16);
    for (const char* stage : {"load", "pilots", "bvh", "compile", "first_launch", "render", "total"}) {
        EXPECT_TRUE(stats["seconds"][stage].is_number()) << stage;
        EXPECT_GE(stats["seconds"][stage], 0) << stage;
    }
    EXPECT_GE(stats["seconds"]["total"], stats["seconds"]["render"]);
    EXPECT_EQ(stats["rays"]["primary"], 16 * 12 * 16);
    EXPECT_GT(stats["rays"]["shadow"], 0);
    EXPECT_EQ(stats["rays"]["secondary"], 0);
    EXPECT_GT(stats["peak_memory_bytes"], 1000000);
    EXPECT_GT(stats["error"]["rel_rmse"], 0);
    EXPECT_LE(stats["error"]["low"], stats["error"]["rel_rmse"]);
    EXPECT_GE(stats["error"]["high"], stats["error"]["rel_rmse"]);
    for (const char* kind : {"nan", "infinite", "negative", "overflow"})
        EXPECT_EQ(stats["nonfinite"][kind], 0) << kind;
    for (const char* key : {"platform", "name", "driver"})
        EXPECT_TRUE(stats["device"][key].is_string()) << key;
    EXPECT_TRUE(stats["device"]["same_bits"].is_boolean());
    EXPECT_TRUE(stats["device"]["facts"]["rules"]["fma rounded once"].is_boolean());
    EXPECT_GE(stats["device"]["facts"]["errors_ulp"]["exp"], 0.5);
    EXPECT_TRUE(stats["effects"].is_array());
    EXPECT_TRUE(stats["version"].is_string());
    EXPECT_TRUE(holds(stats["command"], {"--stats s.json"}));
    // Without enough replicates there is no interval.
    ASSERT_EQ(clrt(quick({"scene.obj", "--stats", "t.json"})).exit_code, 0);
    EXPECT_TRUE(json("t.json")["error"]["low"].is_null());
}

TEST_F(PictureFile, TheNumberOfThreadsChangesNoBit) {
    write_corner_lamp();
    for (const char* integrator : {"path", "distribution", "whitted", "raycast"}) {
        for (const char* threads : {"1", "2"})
            ASSERT_EQ(clrt({"scene.obj", "-r", "40x30", "-s", "16", "-i", integrator, "-j", threads, "--env",
                            "1,1,1", "-o", std::string(threads) + ".exr", "-q"})
                          .exit_code,
                      0);
        const ReadPicture one(folder.file("1.exr")), two(folder.file("2.exr"));
        ASSERT_EQ(one.spec.channelnames, two.spec.channelnames);
        EXPECT_TRUE(one.values == two.values) << integrator;
    }
}

TEST_F(PictureFile, DumpedKernelsAreWhatIsCompiledAndCanBeUsedAgain) {
    write_square("scene");
    ASSERT_EQ(clrt(quick({"scene.obj", "--dump-kernels", "dump/here"})).exit_code, 0);
    const std::string source = folder.read("dump/here/raycast.cl");
    EXPECT_TRUE(holds(source, {"render_raycast", "#line"}));
    EXPECT_EQ(source.find("#include \""), std::string::npos);
    EXPECT_TRUE(holds(folder.read("dump/here/raycast.options.txt"), {"-cl-std=CL1.2", "CLRT_EFFECTS="}));
    std::filesystem::create_directories(folder.file("mine/integrators"));
    std::filesystem::copy_file(folder.file("dump/here/raycast.cl"),
                               folder.file("mine/integrators/raycast.cl"));
    const auto again = clrt(quick({"scene.obj", "--kernels", "mine", "-o", "again.png"}));
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(ReadPicture(folder.file("scene.png")).values, ReadPicture(folder.file("again.png")).values);
}

TEST_F(PictureFile, ResultsGoToStdoutAndTheLogToStderr) {
    write_square("scene");
    const auto loud = clrt(quick({"scene.obj"}));
    EXPECT_TRUE(holds(loud.out, {"scene.png, 16 x 12, 1 spp", "time", "memory", "error"}));
    EXPECT_TRUE(holds(loud.err, {"wrote scene.png", "a studio", "--eye"}));
    const auto quiet = clrt(quick({"scene.obj", "-q"}));
    EXPECT_EQ(quiet.exit_code, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(PictureFile, TheFittedCameraCanBeCopiedFromTheLog) {
    write_square("scene");
    const auto fitted = clrt(quick({"scene.obj", "-o", "a.exr", "--aov", "none"}));
    const size_t begin = fitted.err.find("--eye");
    ASSERT_NE(begin, std::string::npos) << fitted.err;
    std::istringstream words(fitted.err.substr(begin, fitted.err.find('\n', begin) - begin));
    std::vector<std::string> arguments = quick({"scene.obj", "-o", "b.exr", "--aov", "none"});
    for (std::string word; words >> word;)
        arguments.push_back(word);
    ASSERT_EQ(clrt(arguments).exit_code, 0);
    EXPECT_TRUE(ReadPicture(folder.file("a.exr")).values == ReadPicture(folder.file("b.exr")).values);
}

} // namespace clrt
