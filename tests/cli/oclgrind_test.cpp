// SPDX-License-Identifier: Apache-2.0
// The kernels under Oclgrind: no wrong access to memory and no data race, for integrators, tree layouts and
// precisions. Every effect is compiled in. CLRT_TEST_LONG=1 runs all of them, the suite one of each.
#include "clrt_command.h"

#include <tuple>

namespace clrt {

namespace {

class Oclgrind : public ClrtCommand {
protected:
    Oclgrind() {
        folder.write(
            "m.mtl",
            "newmtl matte\nKd 0.7 0.6 0.5\nmap_Kd t.pfm\nnewmtl lamp\nKd 0 0 0\nKe 9 8 6\nnewmtl glass\n"
            "illum 7\nNi 1.5\nnewmtl gloss\nKd 0.2 0.2 0.2\nKs 0.5 0.5 0.5\nNs 40\nillum 2\n"
            "newmtl mirror\nillum 5\nKs 0.9 0.9 0.9\nnewmtl cut\nKd 0.5 0.5 0.5\nd 0.5\n");
        folder.write("t.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(12, '\0'));
        folder.write(
            "scene.obj",
            "mtllib m.mtl\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nv -.5 2 -.5\nv .5 2 -.5\nv .5 2 .5\n"
            "v -.5 2 .5\nv -1 0 0\nv -.2 0 0\nv -.6 .8 .3\nv .2 0 0\nv 1 0 0\nv .6 .8 .3\nv -1 1.2 0\n"
            "v 1 1.2 0\nv 0 1.5 .2\nv -2 2 -2\nv 2 2 -2\nvn 0 1 0\nvn .1 .1 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
            "usemtl matte\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/2/1\nusemtl mirror\nf 4 3 19 18\n"
            "usemtl lamp\nf 5 6 7 8\nusemtl glass\nf 9//2 10//1 11//2\nusemtl gloss\nf 12 13 14\n"
            "usemtl cut\nf 15 16 17\n");
    }

    void expect_no_finding(const std::string& integrator, const std::string& layout,
                           const std::string& precision, const std::string& path_reuse = "off") const {
        SCOPED_TRACE(integrator + ", " + layout + ", " + precision + ", path reuse " + path_reuse);
        CommandSettings settings;
        settings.folder = path();
        settings.environment["CLRT_DEVICE"] = "oclgrind";
        settings.limit_seconds = 500;
        std::filesystem::remove(folder.file("a.exr"));
        // Oclgrind mistakes what the optimiser makes of vectors for wrong accesses.
        const CommandResult result = run_command({CLRT_OCLGRIND,
                                                  "--build-options",
                                                  "-cl-opt-disable",
                                                  "--data-races",
                                                  "--max-errors",
                                                  "5",
                                                  CLRT_EXECUTABLE,
                                                  "scene.obj",
                                                  "--effects",
                                                  "all",
                                                  "-i",
                                                  integrator,
                                                  "--bvh",
                                                  layout,
                                                  "--precision",
                                                  precision,
                                                  "--path-reuse",
                                                  path_reuse,
                                                  "-r",
                                                  "16x16",
                                                  "-s",
                                                  "1",
                                                  "--replicates",
                                                  "1",
                                                  "--max-depth",
                                                  "4",
                                                  "--eye",
                                                  "0,1.5,5",
                                                  "--at",
                                                  "0,0.8,0",
                                                  "-o",
                                                  "a.exr",
                                                  "--aov",
                                                  "albedo,N,Z,P,objectId,materialId,variance,samples,alpha",
                                                  "-q",
                                                  "--progress",
                                                  "off"},
                                                 settings);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "") << "expected nothing from Oclgrind";
        EXPECT_TRUE(exists("a.exr"));
    }
};

} // namespace

TEST_F(Oclgrind, FindsNothingInAnyKernel) {
    if (!tests_are_long()) {
        expect_no_finding("path", "bvh8", "single", "on");
        expect_no_finding("whitted", "bvh2", "double");
        expect_no_finding("distribution", "bvh8", "double");
        expect_no_finding("raycast", "cwbvh", "single");
        return;
    }
    for (const char* integrator : {"raycast", "whitted", "distribution", "light", "path", "path+light"})
        for (const char* layout : {"bvh8", "bvh2", "cwbvh"})
            for (const char* precision : {"single", "double", "fast"})
                expect_no_finding(integrator, layout, precision);
    expect_no_finding("path", "bvh8", "single", "on");
}

} // namespace clrt
