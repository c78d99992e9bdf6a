// SPDX-License-Identifier: Apache-2.0
// What clrt loads: the libraries of OpenImageIO take four times as long to load as a small scene to render.
#include "clrt_command.h"

#include <sys/resource.h>

namespace clrt {

namespace {

class Start : public ClrtCommand {
protected:
    void SetUp() override { write_square("scene"); }

    /// Runs clrt; whether it loaded OpenImageIO.
    bool loads_oiio(const std::vector<std::string>& arguments) const {
        CommandSettings settings;
        settings.environment["LD_DEBUG"] = "files"; // the dynamic linker names what it loads on stderr
        const CommandResult result = clrt(arguments, settings);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, {"libstdc++"})) << "the linker says nothing";
        return result.err.find("libOpenImageIO") != std::string::npos;
    }
};

} // namespace

TEST_F(Start, OpenImageIoIsLoadedOnlyForPicturesThatNeedIt) {
    EXPECT_FALSE(loads_oiio({"--version"}));
    EXPECT_FALSE(loads_oiio(quick({"scene.obj", "-o", "a.png", "-o", "a.pfm", "--stats", "a.json"})));
    EXPECT_TRUE(loads_oiio(quick({"scene.obj", "-o", "a.jpg"})));

    folder.write("m.mtl", "newmtl m\nKd 0.8 0.8 0.8\nmap_Kd a.jpg\n");
    write_square("textured", "mtllib m.mtl\nusemtl m\n");
    EXPECT_TRUE(loads_oiio(quick({"textured.obj", "-o", "a.png"})));
}

TEST_F(Start, WhatAPictureNeedsIsLoadedBeforeTheRender) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "needs a limit of memory";
#endif
    // Enough to render a PNG, too little for the library of a JPEG.
    CommandSettings little;
    little.limits[RLIMIT_AS] = size_t(800) << 20;
    EXPECT_EQ(clrt(quick({"scene.obj", "-o", "a.png"}), little).exit_code, 0);
    const CommandResult result = clrt(quick({"scene.obj", "-o", "b.png", "-o", "a.jpg"}), little);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(holds(result.err, {"clrt: error: ", "not enough memory", "picture formats", "ulimit -v"}));
    EXPECT_EQ(listing(), (std::vector<std::string>{"a.png", "scene.obj"}));
}

TEST_F(Start, ALibraryThatCannotBeLoadedIsAnErrorBeforeTheRender) {
    folder.write("clrt-images.so", "this is no library");
    CommandSettings settings;
    settings.environment["LD_LIBRARY_PATH"] = path();
    const CommandResult result = clrt(quick({"scene.obj", "-o", "b.png", "-o", "a.exr"}), settings);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(holds(result.err, {"clrt: error: ", "picture formats cannot be loaded", "clrt-images.so"}));
    EXPECT_EQ(listing(), (std::vector<std::string>{"clrt-images.so", "scene.obj"}));
    EXPECT_EQ(clrt(quick({"scene.obj", "-o", "b.png"}), settings).exit_code, 0);
}

} // namespace clrt
