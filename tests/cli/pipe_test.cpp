// SPDX-License-Identifier: Apache-2.0
// clrt between other programs: the scene from the standard input, a picture or the statistics to the standard
// output, the report out of the way.
#include "clrt_command.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class Pipe : public ClrtCommand {
protected:
    Pipe() {
        folder.write("leaf.ppm", "P6\n1 1\n255\n\x80\xff\x20");
        folder.write("leaf.mtl", "newmtl leaf\nmap_Kd leaf.ppm\n");
        write_square("scene", "mtllib leaf.mtl\nusemtl leaf\n");
        folder.write("scene.clrt", "# none\n");
    }
    /// Runs a line of the shell in which "clrt" is the program, on a picture that takes no time.
    CommandResult shell(std::string line) const {
        const std::string program =
            std::string(CLRT_EXECUTABLE) + " -i raycast -s 1 -r 16x12 --point 0,0,3,9,9,9 ";
        for (size_t at = line.find("clrt "); at != line.npos; at = line.find("clrt ", at + program.size()))
            line.replace(at, std::strlen("clrt "), program);
        CommandSettings settings;
        settings.folder = path();
        settings.environment["CLRT_DEVICE"] = test_device_name();
        return run_command({"/bin/bash", "-o", "pipefail", "-c", line}, settings);
    }
};

} // namespace

TEST_F(Pipe, APictureGoesToTheStandardOutputInEveryFormat) {
    for (const std::string format : {"png", "jpg", "bmp", "tga", "ppm", "exr", "tif", "hdr", "pfm"}) {
        ASSERT_EQ(shell("clrt scene.obj -q -o file." + format).exit_code, 0);
        const CommandResult result = shell("clrt scene.obj -o " + format + ":- | cat > piped." + format);
        ASSERT_EQ(result.exit_code, 0) << format << "\n" << result.err;
        const ReadPicture file(folder.file("file." + format)), piped(folder.file("piped." + format));
        EXPECT_EQ(piped.spec.channelnames, file.spec.channelnames) << format;
        EXPECT_EQ(piped.values == file.values, true) << format;
        EXPECT_TRUE(holds(result.err, {"16 x 12, 1 spp", "wrote " + format + ":-"})) << "the report";
    }
    EXPECT_FALSE(exists("scene.png")) << "the standard output is the output";
}

TEST_F(Pipe, FilesAndStatisticsMayGoBeside) {
    const CommandResult result = shell("clrt scene.obj -o png:- -o a.exr --stats s.json > a.png");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(ReadPicture(folder.file("a.png")).spec.width, 16);
    EXPECT_EQ(ReadPicture(folder.file("a.exr")).spec.width, 16);
    EXPECT_TRUE(exists("s.json"));
}

TEST_F(Pipe, StatisticsGoToTheStandardOutput) {
    for (const std::string arguments : {"-o a.png", "-q", "--pixel 3,3"}) {
        const CommandResult result = shell("clrt scene.obj --stats - " + arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const auto json = nlohmann::json::parse(result.out, nullptr, false);
        EXPECT_TRUE(json.is_object()) << arguments << ": not only JSON:\n" << result.out;
    }
    EXPECT_TRUE(holds(shell("clrt scene.obj --stats -").err, {"16 x 12, 1 spp", "wrote scene.png"}));
    EXPECT_TRUE(holds(shell("clrt scene.obj --stats - --pixel 3,3").err, {"sample 0 of pixel 3,3"}));
    // From the options file as well: no file of that name beside it.
    std::filesystem::create_directory(folder.file("sub"));
    std::filesystem::copy_file(folder.file("scene.obj"), folder.file("sub/scene.obj"));
    folder.write("sub/scene.clrt", "--stats -\n--output a.png\n");
    EXPECT_TRUE(nlohmann::json::accept(shell("clrt sub/scene.obj").out));
    folder.write("sub/scene.clrt", "--output ppm:-\n");
    EXPECT_EQ(shell("clrt sub/scene.obj").out.substr(0, 2), "P6");
}

TEST_F(Pipe, TheStandardOutputTakesOneOfThem) {
    const auto before = listing();
    for (const std::string arguments :
         {"-o png:- -o exr:-", "-o png:- -o png:-", "-o png:- --stats -", "-o png:- --save-every 1"}) {
        const CommandResult result = shell("clrt scene.obj " + arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments << "\n" << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt: error: option", "standard output"}));
        EXPECT_EQ(result.out, "");
    }
    for (const std::string output : {"-", "gif:-", ":-"}) {
        const CommandResult result = shell("clrt scene.obj -o " + output);
        EXPECT_EQ(result.exit_code, 2) << output;
        EXPECT_TRUE(holds(result.err, {"--output", "png:-"})) << "what it is called";
    }
    EXPECT_EQ(shell("clrt scene.obj --checkpoint -").exit_code, 2);
    EXPECT_EQ(listing(), before);
}

TEST_F(Pipe, TheSceneComesFromTheStandardInput) {
    ASSERT_EQ(shell("clrt scene.obj").exit_code, 0);
    std::filesystem::create_directory(folder.file("sub"));
    for (const std::string line : {"cat scene.obj | clrt -", "clrt - < scene.obj"}) {
        const CommandResult result = shell(line);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(ReadPicture(folder.file("stdin.png")).values ==
                    ReadPicture(folder.file("scene.png")).values)
            << "the material library in the current folder";
        std::filesystem::remove(folder.file("stdin.png"));
    }
    // Through and through.
    const CommandResult whole =
        shell("cat scene.obj | clrt - -q -o ppm:- | cmp - <(clrt scene.obj -q -o ppm:-)");
    EXPECT_EQ(whole.exit_code, 0) << whole.out << whole.err;
    EXPECT_EQ(shell("cat scene.obj | clrt - --explain").exit_code, 0);
    // A scene of that name has its path.
    std::filesystem::copy_file(folder.file("scene.obj"), folder.file("-"));
    EXPECT_EQ(shell("clrt ./- -o a.png < /dev/null").exit_code, 0);
}

TEST_F(Pipe, AnStlOnTheStandardInputIsKnownByItsBytes) {
    folder.write("a.stl",
                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                 "endloop\nendfacet\nendsolid a\n");
    ASSERT_EQ(shell("clrt a.stl").exit_code, 0);
    const CommandResult result = shell("clrt - < a.stl");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"stdin: z is taken as up, --up z, since it is an STL file"}));
    EXPECT_TRUE(ReadPicture(folder.file("stdin.png")).values == ReadPicture(folder.file("a.png")).values);
    const CommandResult cut = shell("head -c 60 a.stl | clrt -");
    EXPECT_EQ(cut.exit_code, 1);
    EXPECT_TRUE(holds(cut.err, {"clrt: error: stdin:5: expected a number, found the end of the file"}));
}

TEST_F(Pipe, WhatIsWrongWithTheStandardInputIsSaid) {
    for (const auto& [line, part] : {std::pair{"printf 'v 0 0 0\\nv 0 zero 0\\n' | clrt -", "stdin:2: "},
                                     {"clrt - < /dev/null", "stdin: "},
                                     {"clrt - <&-", "stdin: "},
                                     {"clrt - < .", "stdin: "}}) {
        const CommandResult result = shell(line);
        EXPECT_EQ(result.exit_code, 1) << line << "\n" << result.err;
        EXPECT_TRUE(holds(result.err, {std::string("clrt: error: ") + part})) << line;
    }
    EXPECT_FALSE(exists("stdin.png"));
}

TEST_F(Pipe, FilesBehindTheStreamsAreFiles) {
    const std::string scene = folder.read("scene.obj"), leaf = folder.read("leaf.ppm");
    CommandResult result = shell("clrt - --stats scene.obj < scene.obj");
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(folder.read("scene.obj") == scene);
    result = shell("clrt scene.obj -o png:- >> leaf.ppm");
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(holds(result.err, {"--output", "texture", "leaf.ppm"}));
    EXPECT_TRUE(folder.read("leaf.ppm") == leaf);
    result = shell("clrt scene.obj -o png:- --stats a.png > a.png");
    EXPECT_EQ(result.exit_code, 2) << result.err;
}

TEST_F(Pipe, ABrokenPipeOrAFullDiskIsAnError) {
    for (const auto& [arguments, part] : {std::pair{"-o png:- > /dev/full", "No space left on device"},
                                          {"--stats - > /dev/full", "No space left on device"},
                                          {"-o png:- >&-", "Bad file descriptor"},
                                          {"--stats - >&-", "Bad file descriptor"},
                                          {">&-", "Bad file descriptor"}}) {
        const CommandResult result = shell(std::string("clrt scene.obj ") + arguments);
        EXPECT_EQ(result.exit_code, 1) << arguments << "\n" << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt: error: ", "standard output", part})) << arguments;
    }
    // The reader goes before the first byte comes.
    const CommandResult result = shell("{ clrt scene.obj -o exr:- ; echo code $? >&2; } | exec true");
    EXPECT_TRUE(holds(result.err, {"Broken pipe", "code 1"}));
    EXPECT_TRUE(holds(shell("{ clrt scene.obj -o a.png; echo code $? >&2; } | exec true").err,
                      {"Broken pipe", "code 1"}));
    EXPECT_TRUE(exists("a.png")) << "the report is lost, the picture is not";
}

TEST_F(Pipe, AStreamThatIsClosedIsNoFileOfOurs) {
    // Their numbers are those that the next files would get.
    const CommandResult result =
        shell("clrt scene.obj -t 60 -s 2000000 --checkpoint begun.film,0.01 <&- >&- 2>&- & "
              "while ! [ -e begun.film ] && kill -0 $!; do sleep .05; done; "
              "readlink /proc/$!/fd/0 /proc/$!/fd/1 /proc/$!/fd/2; kill -9 $!");
    EXPECT_EQ(result.out, "/dev/null\n/dev/null\n/dev/null\n") << result.err;
}

} // namespace clrt
