// SPDX-License-Identifier: Apache-2.0
// No file that was read is ever written, however it is named, and no two results share a file.
#include "clrt_command.h"

namespace clrt {

namespace {

class FileSafety : public ClrtCommand {
protected:
    FileSafety() {
        folder.write("leaf.ppm", PIXEL);
        folder.write("sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(12, '\0'));
        folder.write("broken.png", "no picture");
        folder.write("scene.mtl", "newmtl leaf\nmap_Kd leaf.ppm\nmap_d broken.png\n");
        folder.write("empty.mtl", "# no material\n");
        write_square("scene", "mtllib scene.mtl\nmtllib empty.mtl\nusemtl leaf\n");
        folder.write("scene.clrt", "--point 0,0,3,9,9,9\n");
    }
    /// What all files hold, by their names; links count as what they point to.
    std::vector<std::pair<std::string, std::string>> contents() const {
        std::vector<std::pair<std::string, std::string>> all;
        for (const std::string& name : listing())
            all.emplace_back(name, std::filesystem::is_directory(folder.file(name)) ? "" : folder.read(name));
        return all;
    }
    /// Expects a usage error that names option and file, and that no file is new or changed.
    void expect_refusal(const std::vector<std::string>& arguments, const std::vector<std::string>& message) {
        const auto before = contents();
        const CommandResult result = clrt(quick(arguments));
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt: error: option"}));
        EXPECT_TRUE(holds(result.err, message));
        EXPECT_EQ(result.out, "");
        EXPECT_TRUE(contents() == before) << testing::PrintToString(arguments);
    }

    const std::string PIXEL = "P6\n1 1\n255\n\x80\xff\x20"; ///< a green one
};

} // namespace

TEST_F(FileSafety, NoFileThatWasReadIsWritten) {
    expect_refusal({"scene.obj", "-o", "leaf.ppm"}, {"--output", "leaf.ppm", "texture"});
    expect_refusal({"scene.obj", "-o", "a.png", "-o", "broken.png"}, {"--output", "broken.png"});
    expect_refusal({"scene.obj", "--stats", "scene.mtl"}, {"--stats", "scene.mtl", "material library"});
    expect_refusal({"scene.obj", "--stats", "empty.mtl"}, {"--stats", "empty.mtl"});
    expect_refusal({"scene.obj", "--stats", "scene.obj"}, {"--stats", "scene.obj", "the scene"});
    expect_refusal({"scene.obj", "--stats", "scene.clrt"}, {"--stats", "scene.clrt", "options file"});
    expect_refusal({"scene.obj", "--checkpoint", "leaf.ppm"}, {"--checkpoint", "leaf.ppm"});
    expect_refusal({"scene.obj", "--env", "sky.pfm", "-o", "sky.pfm"},
                   {"--output", "sky.pfm", "environment"});
    // What does not render writes as well.
    expect_refusal({"scene.obj", "--pixel", "3,3", "--stats", "scene.mtl"}, {"--stats", "scene.mtl"});
    expect_refusal({"scene.obj", "--ledger", "--stats", "leaf.ppm"}, {"--stats", "leaf.ppm"});
}

TEST_F(FileSafety, LinksAndOtherSpellingsAreTheFile) {
    std::filesystem::create_directory(folder.file("sub"));
    std::filesystem::create_symlink("leaf.ppm", folder.file("link.ppm"));
    std::filesystem::create_symlink("link.ppm", folder.file("twice.ppm"));
    std::filesystem::create_hard_link(folder.file("leaf.ppm"), folder.file("hard.ppm"));
    std::filesystem::create_directory_symlink(".", folder.file("here"));
    for (const std::string& name :
         std::vector<std::string>{"./leaf.ppm", "sub/../leaf.ppm", "here/leaf.ppm", "link.ppm", "twice.ppm",
                                  "hard.ppm", folder.file("leaf.ppm")})
        expect_refusal({"scene.obj", "-o", name}, {"--output", name, "leaf.ppm"});
    // The texture is a link, too.
    folder.write("scene.mtl", "newmtl leaf\nmap_Kd twice.ppm\n");
    expect_refusal({"scene.obj", "-o", "leaf.ppm"}, {"--output", "leaf.ppm", "twice.ppm"});
}

TEST_F(FileSafety, WhatWasNotReadIsNoConcern) {
    folder.write("scene.mtl", "newmtl leaf\nmap_Kd none.ppm\nnewmtl unused\nmap_Kd leaf.ppm\n");
    EXPECT_EQ(clrt(quick({"scene.obj", "-o", "none.ppm"})).exit_code, 0) << "a texture that is not there";
    EXPECT_EQ(clrt(quick({"scene.obj", "-o", "a.ppm"})).exit_code, 0);
    EXPECT_EQ(clrt(quick({"scene.obj", "-o", "a.ppm"})).exit_code, 0) << "older results are replaced";
}

TEST_F(FileSafety, TheDefaultNameOfThePictureMayBeATexture) {
    folder.write("scene.png", PIXEL);
    folder.write("scene.mtl", "newmtl leaf\nmap_Kd scene.png\n");
    expect_refusal({"scene.obj"}, {"--output (by default)", "scene.png", "texture"});
    EXPECT_EQ(clrt(quick({"scene.obj", "-o", "a.png"})).exit_code, 0);
}

TEST_F(FileSafety, TwoResultsNeedTwoFiles) {
    folder.write("old.png", "an older picture");
    std::filesystem::create_symlink("old.png", folder.file("link.png"));
    expect_refusal({"scene.obj", "-o", "a.png", "-o", "./a.png"}, {"--output", "a.png", "./a.png"});
    expect_refusal({"scene.obj", "-o", "old.png", "-o", "link.png"}, {"--output", "old.png", "link.png"});
    expect_refusal({"scene.obj", "-o", "a.png", "--stats", "a.png"}, {"--output", "--stats", "a.png"});
    expect_refusal({"scene.obj", "--checkpoint", "a.film", "--stats", "./a.film"},
                   {"--checkpoint", "a.film"});
}

TEST_F(FileSafety, DumpedKernelsDoNotReplaceThoseThatWereRead) {
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("mine"), std::filesystem::copy_options::recursive);
    const std::string kernel = folder.read("mine/integrators/raycast.cl");
    expect_refusal({"scene.obj", "--kernels", "mine", "--dump-kernels", "mine/integrators"},
                   {"--dump-kernels", "mine/integrators/raycast.cl", "kernel"});
    EXPECT_EQ(folder.read("mine/integrators/raycast.cl"), kernel);
    EXPECT_EQ(clrt(quick({"scene.obj", "--kernels", "mine", "--dump-kernels", "mine/dump"})).exit_code, 0);
}

TEST_F(FileSafety, FilmsThatAreMergedOrResumedAreRead) {
    for (const char* part : {"0", "1"})
        ASSERT_EQ(
            clrt(quick({"scene.obj", "--first-sample", part, "--checkpoint", std::string(part) + ".film"}))
                .exit_code,
            0);
    const auto before = contents();
    CommandSettings settings;
    settings.folder = path();
    std::filesystem::create_symlink("0.film", folder.file("link.film"));
    for (const char* name : {"./0.film", "1.film", "link.film"}) {
        const CommandResult result =
            run_command({CLRT_MERGE_EXECUTABLE, "0.film", "1.film", "-o", name}, settings);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_TRUE(holds(result.err, {"--output", name}));
    }
    EXPECT_EQ(
        run_command({CLRT_MERGE_EXECUTABLE, "0.film", "1.film", "-o", "a.film", "-o", "./a.film"}, settings)
            .exit_code,
        2);
    std::filesystem::remove(folder.file("link.film"));
    EXPECT_TRUE(contents() == before);
    expect_refusal({"scene.obj", "--resume", "0.film", "--stats", "0.film"}, {"--stats", "0.film"});
    expect_refusal({"scene.obj", "--resume", "0.film", "--pixel", "3,3", "--stats", "./0.film"},
                   {"--stats", "0.film"});
}

} // namespace clrt
