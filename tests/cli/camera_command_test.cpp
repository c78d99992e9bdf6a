// SPDX-License-Identifier: Apache-2.0
// The camera as a newcomer meets it: which way is up, --view, turntables, names of outputs, and pictures that
// show nothing.
#include "clrt_command.h"

#include <csignal>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

namespace clrt {

namespace {

class CameraCommand : public ClrtCommand {
protected:
    /// A pyramid that stands at z = 0.
    void write_pyramid(const std::string& name, const std::string& head = "") const {
        folder.write(name + ".obj", head + "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 2\n"
                                           "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    }
    std::string explain_notices(const std::vector<std::string>& arguments) const {
        std::vector<std::string> command{"--explain"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return clrt(command).out;
    }
    nlohmann::json stats(const std::string& name) const { return nlohmann::json::parse(folder.read(name)); }
};

} // namespace

TEST_F(CameraCommand, ZIsUpWhereTheFileStandsOnIt) {
    write_pyramid("pyramid");
    EXPECT_TRUE(holds(explain_notices({"pyramid.obj"}), {"z is taken as up, --up z", "--up 0,0,1 --fov 40"}));
    EXPECT_TRUE(holds(explain_notices({"pyramid.obj", "--up", "y"}), {"--up 0,1,0 --fov 40"}));
    EXPECT_TRUE(holds(explain_notices({"pyramid.obj", "--up", "x"}), {"--up 1,0,0"}));
    EXPECT_TRUE(
        holds(explain_notices({"pyramid.obj", "--eye", "5,5,5"}), {"it looks as if z is up", "--up 0,1,0"}))
        << "a camera that is given stays as it is";
    const CommandResult wrong = clrt({"pyramid.obj", "--up", "w"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_TRUE(holds(wrong.err, {"--up: expected x, y, z, or a direction"}));
}

TEST_F(CameraCommand, AFilmKeepsLensAndMotion) {
    write_pyramid("pyramid");
    folder.write("end.obj", "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nv 0 0 3\n"
                            "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    const std::vector<std::string> scene = {"pyramid.obj", "--end",        "end.obj", "--aperture", "0.2",
                                            "--end-eye",   "3,3,3",        "--eye",   "3,4,2",      "-r",
                                            "8x8",         "--checkpoint", "p.film",  "-q"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), scene.begin(), scene.end());
        return clrt(more);
    };
    EXPECT_EQ(with({"-s", "8", "-o", "a.exr"}).exit_code, 0);
    EXPECT_EQ(clrt({"--resume", "p.film", "-s", "16", "-o", "a.exr", "-q"}).exit_code, 0)
        << "its own command";
    const CommandResult other = with({"--resume", "p.film", "--shutter", "0,0.5", "-s", "16"});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_TRUE(holds(other.err, {"they differ in scene"})) << other.err;
    const CommandResult replay = clrt({"--resume", "p.film", "--pixel", "4,4", "--sample", "3"});
    EXPECT_EQ(replay.exit_code, 0) << replay.err;
}

TEST_F(CameraCommand, AnEndOfOtherFacesIsRefusedByName) {
    write_pyramid("pyramid");
    folder.write("end.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const CommandResult wrong = clrt({"pyramid.obj", "--end", "end.obj"});
    EXPECT_EQ(wrong.exit_code, 1);
    EXPECT_TRUE(holds(wrong.err, {"end.obj: expected the 5 vertices of 'pyramid.obj', found 3"}))
        << wrong.err;
    EXPECT_EQ(clrt({"pyramid.obj", "--end", "none.obj"}).exit_code, 1);
}

TEST_F(CameraCommand, ViewsTurnWithUp) {
    write_pyramid("pyramid");
    EXPECT_TRUE(holds(explain_notices({"pyramid.obj", "--view", "top"}), {"--at 0,0,", "--up 0,1,0"}));
    const CommandResult both = clrt({"pyramid.obj", "--view", "iso", "--eye", "1,2,3"});
    EXPECT_EQ(both.exit_code, 2);
    EXPECT_TRUE(holds(both.err, {"--eye and --view: expected one of them"}));
    EXPECT_EQ(clrt({"pyramid.obj", "--view", "above"}).exit_code, 2);
}

TEST_F(CameraCommand, ParallelProjectionIsAnnouncedAndItsOwnOptionsGiveTheSamePicture) {
    write_pyramid("pyramid");
    const std::string notices = explain_notices({"pyramid.obj", "--projection", "orthographic"});
    const std::string before = "camera: ";
    const size_t start = notices.find(before + "--eye");
    ASSERT_NE(start, std::string::npos) << notices;
    EXPECT_TRUE(holds(notices, {"--projection orthographic --ortho-height "}));
    std::istringstream words(
        notices.substr(start + before.size(), notices.find('\n', start) - start - before.size()));
    std::vector<std::string> same(std::istream_iterator<std::string>(words), {});
    same.insert(same.end(), {"pyramid.obj", "-o", "same.exr"});
    EXPECT_EQ(clrt(quick({"pyramid.obj", "--projection", "orthographic", "-o", "fitted.exr"})).exit_code, 0);
    EXPECT_EQ(clrt(quick(same)).exit_code, 0);
    const ReadPicture fitted(folder.file("fitted.exr"));
    EXPECT_EQ(fitted.values, ReadPicture(folder.file("same.exr")).values);
    EXPECT_EQ(clrt(quick({"pyramid.obj", "-o", "pinhole.exr"})).exit_code, 0);
    EXPECT_NE(fitted.values, ReadPicture(folder.file("pinhole.exr")).values);
}

TEST_F(CameraCommand, ATurntableWritesAPictureAFrame) {
    write_pyramid("pyramid");
    const CommandResult result = clrt(quick({"pyramid.obj", "--frames", "3", "--sun", "1,2,3,3,3,3", "-o",
                                             "turn.png", "-o", "f{frame}.exr", "--stats", "turn.json"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* name : {"turn-0001.png", "turn-0002.png", "turn-0003.png", "f1.exr", "f2.exr", "f3.exr",
                             "turn-0001.json", "turn-0003.json"})
        EXPECT_TRUE(exists(name)) << name;
    EXPECT_FALSE(exists("turn.png"));
    EXPECT_TRUE(holds(result.out, {"frame 1 of 3: 1 spp", "frame 3 of 3: 1 spp"}));
    // The first is the picture without --frames, the others are others.
    EXPECT_EQ(clrt(quick({"pyramid.obj", "--sun", "1,2,3,3,3,3", "-o", "still.exr"})).exit_code, 0);
    const ReadPicture still(folder.file("still.exr")), first(folder.file("f1.exr")),
        second(folder.file("f2.exr"));
    EXPECT_EQ(first.values, still.values);
    EXPECT_NE(second.values, still.values);
    EXPECT_EQ(stats("turn-0001.json")["spp"], 1);
}

TEST_F(CameraCommand, AFrameAloneIsThatOfTheTurn) {
    write_pyramid("pyramid");
    const auto turn = [&](const std::string& frames, const std::string& output) {
        return clrt(quick({"pyramid.obj", "--frames", frames, "--sun", "1,2,3,3,3,3", "-o", output}))
            .exit_code;
    };
    EXPECT_EQ(turn("3", "all{frame}.exr"), 0);
    EXPECT_EQ(turn("3:2", "one{frame}.exr"), 0);
    EXPECT_FALSE(exists("one1.exr") || exists("one3.exr"));
    EXPECT_EQ(ReadPicture(folder.file("one2.exr")).values, ReadPicture(folder.file("all2.exr")).values);
    for (const char* frames : {"3:4", "3:0", "3:", ":2", "3:x"})
        EXPECT_EQ(turn(frames, "no.exr"), 2) << frames;
}

TEST_F(CameraCommand, ATurnedFrameIsThePictureOfItsCamera) {
    write_pyramid("pyramid");
    const std::vector<std::string> scene = {"pyramid.obj", "--up",  "z",          "--at",
                                            "0,0,1",       "--sun", "1,2,3,3,3,3"};
    const auto render = [&](std::vector<std::string> further) {
        further.insert(further.begin(), scene.begin(), scene.end());
        return clrt(quick(further)).exit_code;
    };
    EXPECT_EQ(render({"--eye", "6,0,3", "--frames", "2", "-o", "turn.exr"}), 0);
    EXPECT_EQ(render({"--eye", "-6,7.347880794884119e-16,3", "-o", "half.exr"}), 0);
    EXPECT_EQ(ReadPicture(folder.file("turn-0002.exr")).values, ReadPicture(folder.file("half.exr")).values);
}

TEST_F(CameraCommand, FramesGoWithPicturesOnly) {
    write_pyramid("pyramid");
    const std::vector<std::vector<std::string>> others = {
        {"--resume", "a.film"}, {"--checkpoint", "a.film"}, {"--pixel", "1,1"}, {"--ledger"}, {"--explain"}};
    for (std::vector<std::string> other : others) {
        const std::string name = other[0];
        other.insert(other.end(), {"pyramid.obj", "--frames", "2"});
        const CommandResult result = clrt(other);
        EXPECT_EQ(result.exit_code, 2) << name;
        EXPECT_TRUE(holds(result.err, {"--frames and " + name + ": expected one of them, found both"}));
    }
    EXPECT_EQ(clrt({"pyramid.obj", "--frames", "0"}).exit_code, 2);
}

TEST_F(CameraCommand, TheGravestFrameEndsATurn) {
    write_pyramid("pyramid");
    const CommandResult result =
        clrt(quick({"pyramid.obj", "--frames", "2", "-e", "0.000001", "-o", "turn.png", "--env", "1,1,1"}));
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_TRUE(exists("turn-0002.png"));
}

TEST_F(CameraCommand, ASignalEndsATurnAfterItsPicture) {
    write_pyramid("pyramid");
    CommandSettings settings;
    settings.signals_after_file = "turn-0001.png";
    settings.signals = {{0.1, SIGINT}};
    const CommandResult result = clrt({"pyramid.obj", "--frames", "50", "-t", "1", "-s", "2000000", "-r",
                                       "16x12", "-o", "turn.png", "--env", "1,1,1"},
                                      settings);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_TRUE(exists("turn-0001.png"));
    EXPECT_FALSE(exists("turn-0050.png"));
}

TEST_F(CameraCommand, NamesTellSeedAndSamples) {
    write_pyramid("pyramid");
    const CommandResult result =
        clrt(quick({"pyramid.obj", "--seed", "7", "-o", "p-{seed}-{spp:3}.png", "-o", "{{x}}.png", "--stats",
                    "{spp}.json", "--checkpoint", "{seed}.film"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* name : {"p-7-001.png", "{x}.png", "1.json", "7.film"})
        EXPECT_TRUE(exists(name)) << name;
    EXPECT_TRUE(holds(result.err, {"wrote p-7-001.png"}));
    for (const char* option : {"-o", "--stats", "--checkpoint"}) {
        const CommandResult unknown = clrt(quick({"pyramid.obj", option, "a{name}.png"}));
        EXPECT_EQ(unknown.exit_code, 2) << option;
        EXPECT_TRUE(holds(unknown.err, {"{seed}, {spp} or {frame}", "found '{name}'"}));
    }
    const CommandResult series = clrt(quick({"pyramid.obj", "--checkpoint", "{spp}.film"}));
    EXPECT_EQ(series.exit_code, 2);
    EXPECT_TRUE(holds(series.err, {"--checkpoint: expected no placeholder but {seed}, found '{spp}.film'"}));
    const CommandResult piped = clrt(quick({"pyramid.obj", "--frames", "2", "-o", "png:-"}));
    EXPECT_EQ(piped.exit_code, 2);
    EXPECT_TRUE(holds(piped.err, {"--frames", "the standard output"}));
    const CommandResult alone = clrt(quick({"pyramid.obj", "-o", "a{frame}.png"}));
    EXPECT_EQ(alone.exit_code, 2);
    EXPECT_TRUE(holds(alone.err, {"--output: expected --frames with 'a{frame}.png'"}));
}

TEST_F(CameraCommand, BracesInTheSceneNameAreKept) {
    write_pyramid("a{b}");
    EXPECT_EQ(clrt(quick({"a{b}.obj"})).exit_code, 0);
    EXPECT_TRUE(exists("a{b}.png"));
}

TEST_F(CameraCommand, ADimPictureThatIsExposedIsNotDark) {
    write_pyramid("pyramid");
    const std::vector<std::string> dim = {"pyramid.obj", "--sun", "0,0,1,1e-6,1e-6,1e-6"};
    EXPECT_TRUE(holds(clrt(quick(dim)).err, {"--exposure"}));
    std::vector<std::string> exposed = dim;
    exposed.insert(exposed.end(), {"--exposure", "auto", "--stats", "s.json"});
    EXPECT_EQ(clrt(quick(exposed)).exit_code, 0);
    EXPECT_TRUE(holds(folder.read("s.json"), {"\"empty_picture\": null"}));
}

TEST_F(CameraCommand, APictureThatShowsNothingSaysWhy) {
    write_pyramid("pyramid");
    folder.write("black.mtl",
                 "newmtl black\nKd 0 0 0\nnewmtl white\nKd .8 .8 .8\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n");
    write_pyramid("black", "mtllib black.mtl\nusemtl black\n");
    // A lamp above a floor that shines upwards.
    folder.write("away.obj", "mtllib black.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 1\nv 1 -1 1\n"
                             "v 1 1 1\nv -1 1 1\nusemtl white\nf 1 2 3 4\nusemtl lamp\nf 5 6 7 8\n");
    // One that is a pyramid inside out.
    folder.write("inward.obj",
                 "mtllib black.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 1\nv .1 0 1\nv 0 .1 1\n"
                 "v 0 0 1.1\nusemtl white\nf 1 2 3 4\nusemtl lamp\nf 5 6 7\nf 5 8 6\nf 5 7 8\nf 6 8 7\n");
    const std::string sun = "0,0,1,3,3,3";
    const struct {
        std::vector<std::string> arguments;
        const char* reason;
    } rows[] = {
        {{"pyramid.obj", "--eye", "0,-9,1", "--at", "0,-20,1", "--sun", sun}, "the scene lies behind it"},
        {{"pyramid.obj", "--eye", "0,-9,1", "--at", "0,-20,1", "--env", "1,1,1"},
         "the picture shows no surface"},
        {{"pyramid.obj", "--eye", "0,-9,1", "--at", "9,-8,1", "--sun", sun},
         "the scene lies beside its view"},
        {{"pyramid.obj", "--env", "0,0,0"}, "the scene has no light"},
        {{"black.obj", "--sun", sun}, "every surface is black (Kd and Ks are 0)"},
        {{"away.obj", "--up", "z", "--eye", "0,-4,0.7", "--at", "0,0,0.3", "--env", "0,0,0"},
         "shine away from the scene: --two-sided-lights"},
        {{"inward.obj", "--up", "z", "--eye", "0,-4,0.7", "--at", "0,0,0.3", "--env", "0,0,0"},
         "shine into closed lamps, their corners run the wrong way round: --two-sided-lights"},
        {{"pyramid.obj", "--sun", "0,0,1,1e-6,1e-6,1e-6"}, "the light is weak"},
        {{"pyramid.obj", "--eye", "0,0,0.5", "--at", "0,1,0.5", "--sun", sun}, "it is inside a closed one"},
        {{"pyramid.obj", "--sun", "0,0,-1,3,3,3", "--view", "top"},
         "hardly any of it reaches what the camera sees"},
    };
    for (const auto& row : rows) {
        std::vector<std::string> arguments = quick(row.arguments);
        arguments.insert(arguments.end(), {"--stats", "stats.json"});
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, {"warning", row.reason}));
        EXPECT_TRUE(holds(stats("stats.json")["empty_picture"].get<std::string>(), {row.reason}));
    }
    const CommandResult fine = clrt(quick({"pyramid.obj", "--sun", sun, "--stats", "stats.json"}));
    EXPECT_EQ(fine.err.find("the picture"), std::string::npos) << fine.err;
    EXPECT_TRUE(stats("stats.json")["empty_picture"].is_null());
}

} // namespace clrt
