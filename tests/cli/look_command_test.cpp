// SPDX-License-Identifier: Apache-2.0
// How pictures look: exposure by the picture's tones, tone curves, clay.
#include "clrt_command.h"

#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class LookCommand : public ClrtCommand {
protected:
    /// scene.obj: a lamp of radiance 8, a floor of a texture and normal map, a glass pane and a half-covered
    /// one.
    void write_room() const {
        folder.write("map.ppm", "P3 2 1 255\n255 0 0 0 0 255\n");
        folder.write("scene.mtl", "newmtl lamp\nKd 0 0 0\nKe 8 8 8\n"
                                  "newmtl floor\nKd 1 1 1\nKs 0.3 0.3 0.3\nillum 2\nmap_Kd map.ppm\n"
                                  "norm map.ppm\n"
                                  "newmtl glass\nillum 4\nKd 0 0 0\nTf 1 1 1\nNi 1.5\n"
                                  "newmtl veil\nKd 0.1 0.9 0.1\nd 0.5\n");
        folder.write("scene.obj", "mtllib scene.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                  "v -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\n"
                                  "v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\n"
                                  "v -1.5 0 0\nv -0.5 0 0\nv -0.5 1 0\nv -1.5 1 0\n"
                                  "v 0.5 0 0\nv 1.5 0 0\nv 1.5 1 0\nv 0.5 1 0\n"
                                  "usemtl lamp\nf 1/1 2/2 3/3 4/4\nusemtl floor\nf 5/1 6/2 7/3 8/4\n"
                                  "usemtl glass\nf 9/1 10/2 11/3 12/4\nusemtl veil\nf 13/1 14/2 15/3 16/4\n");
    }
    CommandResult look(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"scene.obj", "--eye", "0,1.2,6", "--at", "0,0.7,0"});
        return clrt(quick(arguments));
    }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(folder.read(name)); }
};

} // namespace

TEST_F(LookCommand, AutoExposureIsSaidAsAFlagThatGivesTheSamePicture) {
    write_room();
    const auto done = look({"--exposure", "auto-0.25", "-o", "a.ppm", "-o", "a.exr", "--stats", "a.json",
                            "--checkpoint", "a.film"});
    EXPECT_EQ(done.exit_code, 0);
    const double ev = json("a.json")["exposure_ev"];
    const std::string flag = ReadPicture(folder.file("a.exr")).spec.get_string_attribute("clrt.exposure_ev");
    EXPECT_EQ(std::stod(flag), ev);
    EXPECT_TRUE(holds(done.err, {"exposure by the picture's tones: --exposure " + flag + "\n"}));

    EXPECT_EQ(look({"--exposure", flag, "-o", "b.ppm"}).err.find("tones"), std::string::npos);
    EXPECT_EQ(folder.read("a.ppm"), folder.read("b.ppm"));
    EXPECT_EQ(look({"-o", "plain.ppm"}).exit_code, 0);
    EXPECT_NE(folder.read("a.ppm"), folder.read("plain.ppm"));

    const auto merged = run_command({CLRT_MERGE_EXECUTABLE, folder.file("a.film"), "--exposure", "auto-0.25",
                                     "-o", folder.file("merged.ppm")});
    EXPECT_TRUE(holds(merged.err, {"exposure by the picture's tones: --exposure " + flag + "\n"}));
    EXPECT_EQ(folder.read("merged.ppm"), folder.read("a.ppm"));
    EXPECT_EQ(run_command({CLRT_MERGE_EXECUTABLE, folder.file("a.film"), "--tonemap", "film", "-o",
                           folder.file("merged.ppm")})
                  .exit_code,
              2);
}

TEST_F(LookCommand, WhereLittleIsSeenStopsAreOffered) {
    folder.write("dim.mtl", "newmtl glow\nKd 0 0 0\nKe 0.005 0.005 0.005\n");
    folder.write("dim.obj",
                 "mtllib dim.mtl\nusemtl glow\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nf 1 2 3 4\n");
    const auto dim = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"dim.obj", "--eye", "0,3,0", "--at", "0,0,0", "--up", "z"});
        return clrt(quick(arguments)).err;
    };
    const std::string hint =
        "8-bit pictures come out dark: --exposure auto would show this one with +5.17 stops";
    EXPECT_TRUE(holds(dim({"-o", "a.png"}), {hint}));
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"-o", "a.exr"}, {"-o", "a.png", "--exposure", "0"}, {"-o", "a.png", "-q"}})
        EXPECT_EQ(dim(arguments).find("8-bit pictures"), std::string::npos);
}

TEST_F(LookCommand, ClayKeepsLightAndCoverageAndNothingElse) {
    write_room();
    folder.write("scene.clrt", "--eye 0,1.2,6\n--material clay\n");
    const auto plan = clrt({"scene.obj", "--explain"});
    EXPECT_TRUE(holds(plan.out, {"present  area lights", "present  cut-outs",
                                 "no material reflects roughly, by --material (scene.clrt:2) clay",
                                 "no material is a dielectric, by --material", "no material has a map, by",
                                 "no material has one, by", "clay: matte Kd 0.8, emission and coverage kept",
                                 "scene.mtl:10: --material clay: glass is opaque"}));
    EXPECT_TRUE(holds(clrt({"scene.obj", "--explain", "--material", "none"}).out,
                      {"present  refraction", "present  textures", "present  normal and bump maps"}));

    // A library of clay's own words is the same scene.
    ASSERT_EQ(look({"-o", "clay.exr", "--aov", "none", "--checkpoint", "clay.film"}).exit_code, 0);
    const auto other = look({"-o", "x.exr", "--material", "none", "--resume", "clay.film"});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_TRUE(holds(other.err, {"clay.film", "scene: it is another one"}));
    folder.write("scene.mtl", "newmtl lamp\nKd 0.8 0.8 0.8\nKe 8 8 8\nnewmtl floor\nKd 0.8 0.8 0.8\n"
                              "newmtl glass\nKd 0.8 0.8 0.8\nnewmtl veil\nKd 0.8 0.8 0.8\nd 0.5\n");
    ASSERT_EQ(look({"-o", "words.exr", "--aov", "none", "--material", "none"}).exit_code, 0);
    EXPECT_EQ(ReadPicture(folder.file("clay.exr")).values, ReadPicture(folder.file("words.exr")).values);
}

TEST_F(LookCommand, ClayCoversColoursOfVerticesAndFacesWithoutAMaterial) {
    folder.write("scene.obj", "v -1 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
    const auto plan = clrt({"scene.obj", "--explain", "--material", "clay"});
    EXPECT_TRUE(holds(plan.out, {"clay: matte Kd 0.8", "no material has a map, by --material clay"}));
    EXPECT_EQ(plan.out.find("vertex colours"), std::string::npos) << plan.out;
}

} // namespace clrt
