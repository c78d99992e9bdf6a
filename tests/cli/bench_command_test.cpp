// SPDX-License-Identifier: Apache-2.0
// clrt-bench as a user runs it: its table and JSON, its errors, and that it finds a traversal that is wrong.
#include "clrt_command.h"

#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class BenchCommand : public ClrtCommand {
protected:
    /// CLRT_EXECUTABLE is clrt-bench in this program.
    CommandResult bench(const std::vector<std::string>& arguments) const { return clrt(arguments); }

    /// Arguments for a comparison that takes no time.
    static std::vector<std::string> quick(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--rays", "4096", "--rounds", "2"});
        return arguments;
    }

    void expect_usage_error(const std::vector<std::string>& arguments,
                            const std::vector<std::string>& message) const {
        const CommandResult result = bench(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt-bench: error: "}));
        EXPECT_TRUE(holds(result.err, message));
        EXPECT_EQ(result.out, "");
    }

    const std::string cornell_box = CLRT_SCENES_FOLDER "/cornell_box/cornell_box.obj";
};

} // namespace

TEST_F(BenchCommand, WritesRatiosOfAllKindsOfRays) {
    const CommandResult result =
        bench(quick({cornell_box, CLRT_SCENES_FOLDER "/furnace/furnace.obj", "--stats", "bench.json"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(
        holds(result.out, {"primary", "shadow", "diffuse", "mirror", "clrt / Embree", "a ray visits"}));
    const auto json = nlohmann::json::parse(folder.read("bench.json"));
    EXPECT_EQ(json.at("scenes").size(), 2u);
    for (const std::string kind : {"primary", "shadow", "diffuse", "mirror"}) {
        EXPECT_GT(json.at("ratio").at(kind), 0) << kind;
        for (const auto& scene : json.at("scenes")) {
            const auto& figures = scene.at("kinds").at(kind);
            EXPECT_GT(figures.at("rays"), 1000) << kind;
            EXPECT_GT(figures.at("clrt_rays_per_second").at("median"), 0) << kind;
            EXPECT_GT(figures.at("embree_rays_per_second").at("median"), 0) << kind;
            EXPECT_LE(figures.at("ratio").at("low"), figures.at("ratio").at("high")) << kind;
            EXPECT_GE(figures.at("visits_per_ray").at("nodes"), 1) << kind;
            EXPECT_EQ(figures.at("hits_compared").at("embree").at("clrt_wrong"), 0) << kind;
        }
    }
    const auto& tree = json.at("scenes")[0].at("tree");
    EXPECT_GT(tree.at("clrt").at("bytes_per_triangle"), 20);
    EXPECT_GT(tree.at("embree").at("bytes_per_triangle"), 20);
    EXPECT_GT(tree.at("clrt").at("sah_cost"), 0);
    EXPECT_EQ(tree.at("embree_builder").at("quality"), "medium");
    EXPECT_GT(tree.at("embree_builder").at("sah_cost"), 0);
    EXPECT_TRUE(holds(result.out, {"Embree's builder (medium)"}));
}

// Cost and time of both builders' trees side by side, of all qualities; clrt's are at least as good.
TEST_F(BenchCommand, ComparesTreesWithEmbreesByOneFormula) {
    for (const char* layout : {"bvh8", "bvh2", "cwbvh"}) {
        const CommandResult result = bench({CLRT_SCENES_FOLDER "/caustic/caustic.obj", "--trees", "--bvh",
                                            layout, "--rounds", "1", "--stats", "trees.json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.out, {layout, "SAH cost", "clrt fast", "clrt high", "Embree low",
                                       "Embree medium", "Embree high"}));
        const auto json = nlohmann::json::parse(folder.read("trees.json"));
        const auto& scene = json.at("scenes").at(0);
        const auto cost = [&](const char* tree) {
            return scene.at("trees").at(tree).at("sah_cost").get<double>();
        };
        EXPECT_LE(cost("clrt fast"), cost("Embree medium")) << layout;
        EXPECT_LE(cost("clrt high"), cost("Embree high")) << layout;
        EXPECT_GT(cost("Embree low"), cost("Embree medium")) << layout;
        for (const char* tree : {"clrt fast", "clrt high", "Embree low", "Embree medium", "Embree high"}) {
            const auto& figures = scene.at("trees").at(tree);
            EXPECT_GT(figures.at("build_seconds").at("median"), 0) << tree;
            EXPECT_GT(figures.at("build_cpu_seconds").at("median"), 0) << tree;
            EXPECT_GE(figures.at("references"), scene.at("triangles")) << tree;
        }
    }
}

TEST_F(BenchCommand, MeasuresCpuTimeAndBothLayoutsOnOneThread) {
    for (const char* layout : {"bvh2", "bvh8"}) {
        const CommandResult result =
            bench(quick({cornell_box, "--cpu-time", "--bvh", layout, "--threads", "1"}));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.out, {layout, "CPU time"}));
    }
}

TEST_F(BenchCommand, HoldsEmbreeToAnInstructionSet) {
    const CommandResult result = bench(quick({cornell_box, "--isa", "sse2", "--stats", "bench.json"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(folder.read("bench.json")).at("embree_isa"), "sse2");
    expect_usage_error({cornell_box, "--isa", "mmx"}, {"--isa", "avx512", "'mmx'"});
}

TEST_F(BenchCommand, FourForAWrongTraversal) {
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    std::string text = folder.read("kernels/geometry/triangle.h");
    const std::string sum = "*det = *u + *v + *w;";
    ASSERT_NE(text.find(sum), std::string::npos);
    folder.write("kernels/geometry/triangle.h",
                 text.replace(text.find(sum), sum.size(), "*det = *u + *v - *w;"));
    const CommandResult result = bench(quick({cornell_box, "--kernels", "kernels"}));
    EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"clrt is WRONG"}));
}

TEST_F(BenchCommand, CountsAimedRaysThatGetOut) {
    const CommandResult result = bench({"--watertight=100000", "--stats", "aimed.json"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"sphere", "needle fans", "noise torus", "1e6 away", "lost rays: 0"}));
    const auto json = nlohmann::json::parse(folder.read("aimed.json"));
    EXPECT_GE(json.at("rays"), 100000);
    EXPECT_EQ(json.at("lost"), 0);
    EXPECT_EQ(json.at("cases").size(), 24u);
}

TEST_F(BenchCommand, FourForRaysThatGetOut) {
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    std::filesystem::copy_file(CLRT_BENCH_FOLDER "/../naive/kernels/triangle.h",
                               folder.file("kernels/geometry/triangle.h"),
                               std::filesystem::copy_options::overwrite_existing);
    const CommandResult result = bench({"--watertight=100000", "--kernels", "kernels"});
    EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"LOST from ("}));
}

TEST_F(BenchCommand, TellsWhatRobustnessCosts) {
    for (const char* layout : {"bvh2", "bvh8"}) {
        const CommandResult result =
            bench(quick({cornell_box, "--robustness=50000", "--stats", "robustness.json", "--bvh", layout}));
        EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
        EXPECT_TRUE(holds(result.out,
                          {layout, "watertight triangles, padded boxes", "Moeller-Trumbore, plain boxes"}));
        const auto json = nlohmann::json::parse(folder.read("robustness.json"));
        const auto& variants = json.at("scenes")[0].at("variants");
        ASSERT_EQ(variants.size(), 4u);
        EXPECT_EQ(variants[0].at("lost"), 0);
        for (size_t plain = 1; plain < 4; ++plain)
            EXPECT_GT(variants[plain].at("lost"), 1000) << plain;
        EXPECT_GT(variants[0].at("kinds").at("diffuse").at("seconds_per_ray").at("median"), 0);
    }
}

TEST_F(BenchCommand, MakesARoughSceneForRobustnessWhereNoneIsGiven) {
    const CommandResult result = bench({"--robustness=1000", "--rays", "4096", "--rounds", "1"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"a rough torus in a ball", "watertight triangles, padded boxes"}));
}

TEST_F(BenchCommand, TwoForWrongUsage) {
    expect_usage_error({}, {"expected a scene"});
    expect_usage_error({"scene.obj", "--round", "3"}, {"--round", "--rounds"});
    expect_usage_error({"scene.obj", "--rounds"}, {"--rounds", "end of the command line"});
    expect_usage_error({"scene.obj", "--rounds", "0"}, {"--rounds", "'0'"});
    expect_usage_error({"scene.obj", "--rays", "many"}, {"--rays", "'many'"});
    expect_usage_error({"scene.obj", "--bvh", "bvh3"}, {"--bvh", "'bvh3'"});
    expect_usage_error({"scene.obj", "--cpu-time=yes"}, {"--cpu-time", "takes no value"});
    expect_usage_error({"scene.obj", "--watertight"}, {"--watertight", "scene.obj"});
    expect_usage_error({"--watertight=0"}, {"--watertight", "'0'"});
    expect_usage_error({"--watertight", "--robustness"}, {"--watertight", "--robustness"});
    expect_usage_error({"--trees"}, {"expected a scene"});
    expect_usage_error({"--trees", "scene.obj", "--bvh", "high"}, {"--trees", "layout"});
}

TEST_F(BenchCommand, OneAndThreeAsClrt) {
    EXPECT_EQ(bench(quick({"none.obj"})).exit_code, 1);
    EXPECT_EQ(bench(quick({cornell_box, "--stats", "no/folder/s.json"})).exit_code, 1);
    EXPECT_EQ(bench(quick({cornell_box, "--kernels", "none"})).exit_code, 1);
    EXPECT_EQ(bench(quick({cornell_box, "--device", "no such device"})).exit_code, 3);
}

TEST_F(BenchCommand, SaysWhatItIs) {
    EXPECT_TRUE(holds(bench({"--help"}).out, {"Usage: clrt-bench", "--stats FILE", "Exit codes:"}));
    EXPECT_TRUE(holds(bench({"--version"}).out, {"clrt-bench "}));
}

} // namespace clrt
