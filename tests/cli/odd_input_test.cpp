// SPDX-License-Identifier: Apache-2.0
// Odd files of every kind: each gives a picture or a clear error with the right exit code, never a crash.
#include "clrt_command.h"

#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

const std::string SQUARE = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";

class OddInput : public ClrtCommand {
protected:
    CommandResult render(const std::string& obj, const std::vector<std::string>& more = {}) const {
        folder.write("odd.obj", obj);
        std::filesystem::remove(folder.file("odd.png"));
        std::vector<std::string> arguments = quick({"odd.obj", "--env", "1,1,1"});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return clrt(arguments);
    }
    /// Expects a picture with something in its middle, and these parts in the log.
    void expect_seen(const std::string& what, const std::string& obj,
                     const std::vector<std::string>& log = {}) const {
        SCOPED_TRACE(what);
        const CommandResult result = render(obj);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, log));
        const ReadPicture picture(folder.file("odd.png"));
        EXPECT_NEAR(picture.at(8, 6, "G"), 0.906, 0.01) << "0.8 under a white sky";
    }
    /// Expects exit 0 and a picture in which nothing but the sky can be seen.
    void expect_sky(const std::string& what, const std::string& obj,
                    const std::vector<std::string>& log) const {
        SCOPED_TRACE(what);
        const CommandResult result = render(obj);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, log));
        EXPECT_EQ(ReadPicture(folder.file("odd.png")).at(8, 6, "G"), 1);
    }
    /// Expects exit 1, these parts in the message, and no picture.
    void expect_error(const std::string& what, const std::string& obj,
                      const std::vector<std::string>& message) const {
        SCOPED_TRACE(what);
        const CommandResult result = render(obj);
        EXPECT_EQ(result.exit_code, 1) << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt: error: "}));
        EXPECT_TRUE(holds(result.err, message));
        EXPECT_FALSE(exists("odd.png"));
    }
};

/// A text with every line end replaced.
std::string with_line_ends(const std::string& text, const std::string& end) {
    std::string result;
    for (const char c : text)
        result += c == '\n' ? end : std::string(1, c);
    return result;
}

} // namespace

TEST_F(OddInput, LineEndsMarksAndIndicesAreAsWritersMakeThem) {
    expect_seen("CRLF", with_line_ends(SQUARE + "f 1 2 3 4\n", "\r\n"));
    expect_seen("CR only", with_line_ends(SQUARE + "f 1 2 3 4\n", "\r"));
    expect_seen("byte order mark", "\xEF\xBB\xBF" + SQUARE + "f 1 2 3 4\n");
    expect_seen("no last line end", SQUARE + "f 1 2 3 4");
    expect_seen("a line that goes on", SQUARE + "f 1 2 \\\n3 4\n");
    expect_seen("negative indices", SQUARE + "f -4 -3 -2 -1\n");
    expect_seen("a long line", SQUARE + "# " + std::string(3000000, 'x') + "\nf 1 2 3 4\n");
    expect_seen("vertices with weights", with_line_ends(SQUARE, " 1\n") + "f 1 2 3 4\n");
    // 0.906 is sRGB's for a linear 0.8, the grey of squares without a colour.
    expect_seen("vertices with colours", with_line_ends(SQUARE, " 1 0.906 0\n") + "f 1 2 3 4\n",
                {"odd.obj:1: vertex colours"});
    std::string utf16 = "\xff\xfe";
    for (const char c : SQUARE + "f 1 2 3 4\r\n")
        utf16 += {c, '\0'};
    expect_seen("UTF-16", utf16);
}

TEST_F(OddInput, FilesOfOtherFormatsAreErrorsThatSayWhatToDo) {
    expect_error("a Blender file", "BLENDER-v300",
                 {"odd.obj: expected a Wavefront OBJ, an STL file", "found a Blender file", "assimp export"});
    expect_error("an empty glTF", "{\"asset\":{\"version\":\"2.0\"}}",
                 {"odd.obj: the file's scene has no triangles"});
    expect_error("a GLB that ends early", std::string("glTF\2\0\0\0\x10\0\0\0", 12),
                 {"odd.obj: byte 8: expected a length up to that of the file, 12, found 16"});
    expect_error("a PLY of points", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n",
                 {"no faces to render"});
    expect_error("MTL", "newmtl red\nKd 1 0 0\n", {"a material library (MTL): give the OBJ that names it"});
    expect_error("a picture", "\x89PNG\r\n\x1a\n", {"a PNG picture"});
}

TEST_F(OddInput, MapCoordinatesAreRenderedAndTheirLimitsAreSaid) {
    const std::string far =
        "v 5399999.6 -1 0\nv 5400000.4 -1 0\nv 5400000.4 1 0\nv 5399999.6 1 0\nf 1 2 3 4\n";
    expect_seen("far away", far);
    expect_seen("digits of single precision",
                "v 5400000 -1 0\nv 5400001 -1 0\nv 5400001 1 0\nv 5400000 1 0\nf 1 2 3 4\n",
                {"odd.obj: x is written in steps of 1 near 5.4e+06"});
    // Single precision has steps of half a unit there: layer P keeps what lies between.
    const CommandResult result = render(far, {"-o", "odd.exr", "-o", "odd.png"});
    EXPECT_TRUE(holds(result.err, {"layer P counts from 5400000,", "clrt.P.origin"}));
    const ReadPicture picture(folder.file("odd.exr"));
    EXPECT_EQ(std::string(picture.spec.get_string_attribute("clrt.P.origin")), "5400000 0 0");
    const float middle = picture.at(8, 6, "P.X"), next = picture.at(9, 6, "P.X");
    EXPECT_GT(middle, 0);
    EXPECT_GT(next, middle);
    EXPECT_LT(next, 0.49f) << "within the square, between two floats of its coordinates";
}

TEST_F(OddInput, OptionsInOtherCoordinatesThanTheFilesAreSaid) {
    const std::string far = "v 5399999 -1 0\nv 5400001 -1 0\nv 5400001 1 0\nv 5399999 1 0\nf 1 2 3 4\n";
    const CommandResult away = render(far, {"--eye", "0,0,5", "--at", "0,0,0", "--point", "0,5,0,1,1,1"});
    EXPECT_EQ(away.exit_code, 0);
    EXPECT_TRUE(holds(away.err, {"camera: --eye 0,0,5 is 5.4e+06 from the scene, whose centre is 5400000,0,0",
                                 "less than a pixel", "--point 0,5,0 is 5.4e+06 from the scene"}));
    const CommandResult past = render(far, {"--eye", "5400000,0,5", "--at", "0,0,0"});
    EXPECT_TRUE(holds(past.err, {"camera: --at 0,0,0 is 5.4e+06 from the scene", "out of view"}));
    const CommandResult there = render(far, {"--eye", "5400000,0,5", "--at", "5400000,0,0"});
    EXPECT_EQ(there.err.find("from the scene"), std::string::npos) << there.err;
}

TEST_F(OddInput, SmoothingGroupsMakeCornersRound) {
    // Two squares that meet in a ridge towards the eye: by one smoothing group its normal looks at the sky
    // half and half, and the picture has no edge.
    const std::string ridge = "v -1 -1 0\nv 0 -1 1\nv 0 1 1\nv -1 1 0\nv 1 -1 0\nv 1 1 0\n";
    const auto layer = [&](const std::string& group) {
        EXPECT_EQ(render(ridge + group + "f 1 2 3 4\nf 2 5 6 3\n",
                         {"-o", "odd.exr", "--eye", "0,0,6", "--at", "0,0,0"})
                      .exit_code,
                  0);
        const ReadPicture picture(folder.file("odd.exr"));
        return picture.at(8, 6, "N.X") - picture.at(7, 6, "N.X");
    };
    EXPECT_NEAR(layer(""), std::sqrt(2.0), 1e-3);
    EXPECT_NEAR(layer("s off\n"), std::sqrt(2.0), 1e-3);
    EXPECT_LT(layer("s 1\n"), 0.7);
}

TEST_F(OddInput, PolygonsHaveAnyShape) {
    // Concave: the notch reaches below the middle, so the middle is open.
    expect_sky("concave", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 -0.9 0\nv -1 1 0\nf 1 2 3 4 5\n", {});
    std::string circle, face = "f";
    for (int i = 0; i < 20000; ++i) {
        circle +=
            fmt::format("v {} {} 0\n", std::cos(i / 20000.0 * 6.2831853), std::sin(i / 20000.0 * 6.2831853));
        face += fmt::format(" {}", i + 1);
    }
    expect_seen("twenty thousand corners", circle + face + "\n");
    expect_seen("a face of two corners", SQUARE + "f 1 2\nf 1 2 3 4\n", {"odd.obj:5: ", "fewer than three"});
    std::string repeated = SQUARE;
    for (int i = 0; i < 50; ++i)
        repeated += "f 1 2 3 4\n";
    expect_seen("the same face fifty times", repeated);
}

TEST_F(OddInput, MissingNormalsAndTextureCoordinatesAreLeftOut) {
    expect_seen("vn out of range", SQUARE + "f 1//9 2//9 3//9 4//9\n", {"odd.obj:5: ", "vn"});
    expect_seen("vt out of range", SQUARE + "f 1/9 2/9 3/9 4/9\n", {"odd.obj:5: ", "vt"});
    expect_seen("vn at some corners", SQUARE + "vn 0 0 1\nf 1//1 2 3//1 4\n");
    expect_seen("vn of no length", SQUARE + "vn 0 0 0\nf 1//1 2//1 3//1 4//1\n", {"vn"});
    expect_seen("vt that is no number", SQUARE + "vt nan nan\nf 1/1 2/1 3/1 4/1\n", {"vt"});
    expect_seen("curves between", SQUARE + "vp 0.3\ncstype bezier\ncurv 0 1 1 2 3\nend\nf 1 2 3 4\n",
                {"curve"});
}

TEST_F(OddInput, VerticesThatAreNoNumbersTakeTheirFacesWithThem) {
    expect_seen("NaN", "v nan 0 0\n" + SQUARE + "f 1 2 3\nf 2 3 4 5\n", {"odd.obj:6: ", "not finite"});
    expect_seen("infinite", "v inf 0 0\n" + SQUARE + "f 1 2 3\nf 2 3 4 5\n", {"odd.obj:6: ", "not finite"});
    expect_error("all of them", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"not finite"});
    expect_error("beyond float", "v -1e300 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n", {"not finite"});
}

TEST_F(OddInput, GeometryWithoutAreaGivesThePictureOfTheSky) {
    expect_sky("faces of one or two points", SQUARE + "f 1 1 1\nf 1 2 2\n", {"2 triangles of zero area"});
    expect_sky("a line", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", {"zero area"});
    expect_sky("a point", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n", {"zero area"});
}

TEST_F(OddInput, AnySizeAndPlaceFits) {
    const auto square = [](const char* size) {
        return fmt::format("v -{0} -{0} 0\nv {0} -{0} 0\nv {0} {0} 0\nv -{0} {0} 0\nf 1 2 3 4\n", size);
    };
    expect_seen("1e30", square("1e30"));
    expect_seen("1e-30", square("1e-30"));
    expect_seen("below the smallest normal float", square("1e-42"));
    expect_seen("far away", "v 9999999 -1 0\nv 10000001 -1 0\nv 10000001 1 0\nv 9999999 1 0\nf 1 2 3 4\n");
}

TEST_F(OddInput, FilesWithoutFacesAreErrors) {
    expect_error("empty", "", {"odd.obj: ", "no faces"});
    expect_error("a comment", "# nothing\n", {"no faces"});
    expect_error("vertices only", SQUARE, {"no faces", "4 vertices"});
    expect_error("points and lines", SQUARE + "p 1 2\nl 1 2 3\n", {"no faces"});
    expect_error("zero bytes", std::string(5000, '\0'), {"odd.obj"});
    std::string garbage;
    for (int i = 0; i < 20000; ++i)
        garbage += char((i * 7919 + i * i) % 256);
    expect_error("garbage", garbage, {"odd.obj"});
}

TEST_F(OddInput, NumbersThatCannotBeMeantAreErrorsWithTheirLine) {
    expect_error("index 0", SQUARE + "f 0 1 2\n", {"odd.obj:5: ", "found 0"});
    expect_error("huge index", SQUARE + "f 1 2 99999999999999999999\n",
                 {"odd.obj:5: ", "99999999999999999999"});
    expect_error("huge negative index", SQUARE + "f 1 2 -99999999999999999999\n",
                 {"odd.obj:5: ", "from -4 to -1"});
    expect_error("index beyond the last", SQUARE + "f 1 2 5\n", {"odd.obj:5: ", "from 1 to 4", "found 5"});
    expect_error("broken index", SQUARE + "f 1.5 2 3\n", {"odd.obj:5: ", "1.5"});
    expect_error("zero byte in a number", SQUARE + std::string("f 1 2 3\0 4\n", 11), {"odd.obj:5: "});
    expect_error("two coordinates", "v 1 2\nf 1 1 1\n", {"odd.obj:1: ", "found 2"});
}

TEST_F(OddInput, LibrariesAreFoundWhateverTheirNames) {
    folder.write("a.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("b.mtl", "newmtl b\nKd 0.8 0.8 0.8\n");
    folder.write("my colours.mtl", "newmtl my grey\r\nKd 0.8 0.8 0.8\r\n");
    folder.write("garbage.mtl", "\x01\xff\xfe Kd\n\x80 3\n");
    expect_seen("several on a line", "mtllib a.mtl b.mtl\n" + SQUARE + "usemtl b\nf 1 2 3 4\n");
    expect_seen("several lines", "mtllib a.mtl\nmtllib b.mtl\n" + SQUARE + "usemtl b\nf 1 2 3 4\n");
    expect_seen("names with spaces",
                "mtllib my colours.mtl\n" + SQUARE + "o my thing\nusemtl my grey\nf 1 2 3 4\n");
    expect_seen("none", "mtllib none.mtl\n" + SQUARE + "usemtl x\nf 1 2 3 4\n",
                {"odd.obj:1: ", "none.mtl", "odd.obj:6: ", "usemtl 'x'"});
    expect_seen("garbage", "mtllib garbage.mtl\n" + SQUARE + "usemtl x\nf 1 2 3 4\n", {"garbage.mtl:1: "});
}

TEST_F(OddInput, TexturesThatCannotBeReadAreIgnoredWithANotice) {
    folder.write("empty.png", "");
    folder.write("text.png", "this is no picture");
    folder.write("cut.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x10", 20));
    for (const char* file : {"none.png", "empty.png", "text.png", "cut.png", "m.mtl", "."}) {
        folder.write("m.mtl", std::string("newmtl m\nKd 0.8 0.8 0.8\nmap_Kd ") + file + "\n");
        expect_seen(file, "mtllib m.mtl\n" + SQUARE + "usemtl m\nf 1 2 3 4\n",
                    {"m.mtl:3: ", file, "the map is ignored"});
    }
}

TEST_F(OddInput, MaterialsThatMakeNoSenseAreErrorsWithTheirLine) {
    for (const auto& [keys, found] : {std::pair{"Kd red", "'red'"}, {"Kd nan 0 0", "'nan'"}, {"Ni", "Ni"}}) {
        folder.write("m.mtl", std::string("newmtl m\n") + keys + "\n");
        expect_error(keys, "mtllib m.mtl\n" + SQUARE + "usemtl m\nf 1 2 3 4\n", {"m.mtl:2: ", found});
    }
}

TEST_F(OddInput, EnvironmentsThatAreNoPicturesAreErrors) {
    folder.write("text.exr", "this is no picture");
    const CommandResult result = render(SQUARE + "f 1 2 3 4\n", {"--env", "text.exr"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(holds(result.err, {"text.exr"}));
}

TEST_F(OddInput, FilesMayHaveAnyName) {
    for (const char* name : {"with space.obj", "-dash.obj", "\xC3\xBC.obj", "noextension", "two.dots.obj"}) {
        folder.write(name, SQUARE + "f 1 2 3 4\n");
        const CommandResult result = clrt({"-i", "raycast", "-s", "1", "-r", "16x12", "--", name});
        EXPECT_EQ(result.exit_code, 0) << name << ": " << result.err;
        EXPECT_TRUE(exists(std::filesystem::path(name).stem().string() + ".png")) << name;
    }
}

} // namespace clrt
