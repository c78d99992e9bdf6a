// SPDX-License-Identifier: Apache-2.0
// Kernels and probes become code without a warning for the processors that drivers built on clang know, in
// single and in double; no device of that kind is needed. Some warnings come only with the code: whether a
// vector fits the registers is known there.
#include "bvh/bvh.h"
#include "clang_complaints.h"
#include "kernels/shared/effects.h"
#include "probes/bsdf_probe.h"
#include "probes/ray_device.h"
#include "probes/scratch_folder.h"
#include "render/kernels.h"
#include "stability/bsdf_set.h"
#include "stability/cases/ray_builds.h"
#include "stability/film_bench.h"
#include "stability/path_probe.h"
#include "support/drawn.h"
#include "support/test_device.h"
#include "vector_builtins.h"

#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iostream>
#include <iterator>
#include <regex>

namespace clrt {

namespace {

/// What code is made for. PoCL's Debian packages make code for the first three kinds of x86, and for those
/// between.
struct Target {
    const char* name;
    std::vector<std::string> options;
};

const Target SSE2 = {"x86-64", {"--target=x86_64-unknown-linux-gnu", "-march=x86-64"}};
const Target AVX2 = {"haswell", {"--target=x86_64-unknown-linux-gnu", "-march=haswell"}};
const Target AVX512 = {"skylake-avx512", {"--target=x86_64-unknown-linux-gnu", "-march=skylake-avx512"}};

const Target NVPTX = {"nvptx64",
                      {"--target=nvptx64-nvidia-cuda", "-Xclang", "-target-cpu", "-Xclang", "sm_70"}};

const std::vector<Target>& targets() {
    static const std::vector<Target> all = {
        SSE2,
        AVX2,
        AVX512,
        NVPTX,
        {"amdgcn", {"--target=amdgcn-amd-amdhsa", "-mcpu=gfx900", "-nogpulib"}},
        {"spir64", {"--target=spir64-unknown-unknown"}}};
    return all;
}

/// What clang says when it makes code of a file; empty if nothing. Without optimisation, which takes a fifth
/// of the time and keeps these warnings.
std::string complaints(const std::string& file, const Target& target,
                       const std::vector<std::string>& more = {}) {
    std::vector<std::string> options = {"-cl-std=CL1.2", "-O0", "-S", "-emit-llvm", "-o", "/dev/null"};
    options.insert(options.end(), target.options.begin(), target.options.end());
    options.insert(options.end(), more.begin(), more.end());
    return clang_complaints(file, options);
}

class CodeGeneration : public testing::Test {
protected:
    /// Compiles a text for all targets, for each in single or double: by turns from target to target and from
    /// text to text, where texts with and without effects come in pairs.
    void expect_clean(const std::string& what, const std::string& text,
                      const std::vector<std::string>& defines) {
        const std::string file = folder.write("kernels.cl", text);
        std::vector<std::pair<const Target*, bool>> builds; // target, whether in double
        bool turn = (texts_ ^ texts_ >> 1) & 1;
        for (const Target& target : targets()) {
            builds.insert(builds.end(), {{&target, turn}, {&target, !turn}});
            turn = !turn;
        }
        ++texts_;
        for (const auto& [target, is_double] : drawn(builds, 2)) {
            std::vector<std::string> options = defines;
            if (is_double)
                options.push_back("-DREAL_IS_DOUBLE=1");
            EXPECT_EQ(complaints(file, *target, options), "")
                << what << ", " << (is_double ? "double" : "single") << ", for " << target->name;
        }
    }
    /// The same with all effects and with none.
    void expect_clean_with_and_without_effects(const std::string& what, const std::string& text,
                                               std::vector<std::string> defines) {
        for (const EffectMask effects : {EFFECT_ALL, EffectMask(0)}) {
            defines.push_back(fmt::format("-DCLRT_EFFECTS={:#x}u", effects));
            expect_clean(fmt::format("{}, effects {:#x}", what, effects), text, defines);
            defines.pop_back();
        }
    }
    /// The same of a probe, as it is built.
    void expect_clean(const std::string& what, const KernelProbe& probe) {
        std::vector<std::string> options;
        for (const std::string& define : probe.options().defines)
            options.push_back("-D" + define);
        expect_clean(what, probe.source(), options);
    }

    const ScratchFolder folder;

private:
    unsigned texts_ = 0; ///< so far
};

std::string include(const std::vector<std::string>& files) {
    std::string text;
    for (const std::string& file : files)
        text += fmt::format("#include \"{}\"\n", file);
    return text;
}

/// How many loops of a header clang turns into loops of vectors of eight.
std::ptrdiff_t loops_in_vectors(const std::string& header, const std::string& file, const Target& target) {
    std::vector<std::string> options = {"-cl-std=CL1.2",        "-O2", "-c", "-o", "/dev/null",
                                        "-Rpass=loop-vectorize"};
    options.insert(options.end(), target.options.begin(), target.options.end());
    const std::string said = clang_complaints(file, options);
    const std::regex loop(header + ":[0-9:]+ remark: vectorized loop .*width: 8");
    return std::distance(std::sregex_iterator(said.begin(), said.end(), loop), std::sregex_iterator());
}

} // namespace

TEST_F(CodeGeneration, OfTheEntryPointsInEveryLayout) {
    const std::string text = entry_points({"path", "distribution", "whitted", "raycast"}) +
                             include({"denoise/filter.cl", "integrators/aov.cl", "numerics/device_facts.cl"});
    for (const BvhLayout layout : ALL_LAYOUTS)
        expect_clean_with_and_without_effects(name_of(layout), text,
                                              {fmt::format("-DBVH_LAYOUT={}", int(layout))});
}

TEST_F(CodeGeneration, OfPathReuse) {
    for (const EffectMask effects : {EFFECT_ALL & ~EFFECTS_OF_ONE_PIXEL, EffectMask(EFFECT_MATTE)})
        for (const std::vector<std::string>& guide :
             {std::vector<std::string>{}, {"-DPATH_GUIDE=1", "-DFILM_INT64_ATOMICS=0"}}) {
            std::vector<std::string> defines = {"-DPATH_REUSE=1",
                                                fmt::format("-DCLRT_EFFECTS={:#x}u", effects)};
            defines.insert(defines.end(), guide.begin(), guide.end());
            const std::string what =
                fmt::format("path reuse, effects {:#x}, {}", effects, fmt::join(guide, " "));
            expect_clean(what, entry_points({"path"}), defines);
            defines.push_back("-DFILM_SPLATS=1");
            expect_clean(what + ", splats", entry_points({"path_light"}), defines);
        }
}

TEST_F(CodeGeneration, OfLampsBehindSlabs) {
    for (const EffectMask effects : {EFFECT_ALL, EFFECT_MATTE | EFFECT_REFRACTION | EFFECT_AREA_LIGHT})
        expect_clean(fmt::format("lamps behind slabs, effects {:#x}", effects), entry_points({"path"}),
                     {"-DLAMPS_BEHIND_SLABS=1", fmt::format("-DCLRT_EFFECTS={:#x}u", effects)});
}

TEST_F(CodeGeneration, OfTheRandomNumbersOfAGroupOfPathsIsInVectors) {
    const std::string file = folder.write("kernels.cl", include({"integrators/path.cl"}));
    for (const Target& target : {AVX2, AVX512})
        EXPECT_EQ(loops_in_vectors("numbers.h", file, target), 1) << "for " << target.name;
}

TEST_F(CodeGeneration, OfTheLightSamplesOfAGroupOfPathsIsInVectors) {
    const std::string file = folder.write(
        "kernels.cl",
        vector_builtins() + include({"path/sky.h"}) +
            "kernel void draw(global const uint* texels, global const SkyTile* tiles,\n"
            "                 global const RenderParams* given, global uint* words, global float* pdf_w)\n"
            "{\n"
            "    Scene scene;\n"
            "    scene.sky_texels = texels;\n"
            "    scene.sky_tiles = tiles;\n"
            "    const RenderParams params = *given;\n"
            "    SkyLanes lanes;\n"
            "    for (uint i = 0; i < SAMPLES_AT_ONCE; ++i)\n"
            "        lanes.word[i] = lanes.alias_word[i] = words[i], lanes.v[i] = 0.5f;\n"
            "    sky_draw(&scene, &params, &lanes, SAMPLES_AT_ONCE);\n"
            "    for (uint i = 0; i < SAMPLES_AT_ONCE; ++i)\n"
            "        pdf_w[i] = lanes.pdf_w[i] + lanes.wi_x[i] + lanes.red[i];\n"
            "}\n");
    for (const Target& target : {AVX2, AVX512})
        EXPECT_EQ(loops_in_vectors("sky.h", file, target), 3)
            << "for " << target.name << ": one for each form of a map's texels";
}

TEST_F(CodeGeneration, PrivateMemoryOfAWorkItemIsBounded) {
    // The frames of all functions together, as they lie in memory where registers do not hold them. That of a
    // tree's rays is as large as the depth and the branches that are asked for.
    EffectMask effects =
        EFFECT_ALL & ~EffectMask(EFFECT_INSTANCES | EFFECT_THIN_WALL | EFFECT_NESTED | EFFECT_TEXTURE_FILTER);
    const auto bytes = [&](const std::string& integrator, const std::vector<std::string>& defines) {
        const std::string file = folder.write("kernels.cl", include({"integrators/" + integrator + ".cl"}));
        const std::string code = folder.file("kernels.ptx");
        std::vector<std::string> options = {"-cl-std=CL1.2",
                                            "-O2",
                                            "-S",
                                            "-o",
                                            code,
                                            "-DSAMPLES_AT_ONCE=1",
                                            fmt::format("-DCLRT_EFFECTS={:#x}u", effects)};
        options.insert(options.end(), NVPTX.options.begin(), NVPTX.options.end());
        options.insert(options.end(), defines.begin(), defines.end());
        EXPECT_EQ(clang_complaints(file, options), "") << integrator;
        std::ifstream stream(code);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        const std::regex frame(R"(\.local [^\n]*__local_depot\d+\[(\d+)\])");
        int sum = 0;
        for (std::sregex_iterator i(text.begin(), text.end(), frame), end; i != end; ++i)
            sum += std::stoi((*i)[1]);
        std::cout << integrator << " " << fmt::format("{}", fmt::join(defines, " ")) << ": " << sum
                  << " bytes a work-item\n";
        return sum;
    };
    TransportOptions usual;
    usual.integrator = Integrator::DISTRIBUTION;
    TransportOptions largest = usual;
    largest.max_depth = LARGEST_TREE_DEPTH;
    largest.gloss_rays = LARGEST_BRANCH;
    std::vector<std::string> few, many;
    for (const std::string& define : waiting_defines(usual))
        few.push_back("-D" + define);
    for (const std::string& define : waiting_defines(largest))
        many.push_back("-D" + define);
    const std::string gpu_layout = fmt::format("-DBVH_LAYOUT={}", int(BvhLayout::BVH2));
    std::vector<std::string> few_on_gpu = few;
    few_on_gpu.push_back(gpu_layout);
    const auto paired = [&](int depth) {
        TransportOptions transport;
        transport.integrator = Integrator::BDPT;
        transport.max_depth = depth;
        return bytes("bdpt", {"-DFILM_SPLATS=1", "-D" + vertex_defines(transport).at(0), gpu_layout});
    };
    EXPECT_LT(paired(USUAL_BDPT_DEPTH), 8 << 10);
    EXPECT_LT(paired(LARGEST_DEPTH), 10 << 10);
    EXPECT_LT(bytes("path", {}), 8 << 10);
    EXPECT_LT(bytes("whitted", {}), 12 << 10);
    EXPECT_LT(bytes("distribution", few_on_gpu), 5 << 10);
    EXPECT_LT(bytes("distribution", few), 9 << 10);
    EXPECT_LT(bytes("distribution", many), 24 << 10);
    EXPECT_LT(bytes("mlt", {"-DFILM_SPLATS=1"}), 12 << 10);

    // What waits in an instance's tree lies on what waits in the scene's; and whoever looks through a pane
    // needs its BSDF. Rays and surfaces hold the solids around them.
    effects = EFFECT_ALL;
    EXPECT_LT(bytes("path", {gpu_layout}), 5 << 10);
    EXPECT_LT(bytes("path", {gpu_layout, "-DLAMPS_BEHIND_SLABS=1"}), 6 << 10);
    EXPECT_LT(bytes("path", {}), 12 << 10);
    EXPECT_LT(paired(USUAL_BDPT_DEPTH), 10 << 10);
}

TEST_F(CodeGeneration, OfTheProgramsThatSplat) {
    for (const char* int64 : {"0", "1"})
        for (const std::string integrator : {"raycast", "light", "path_light", "bdpt", "mlt"})
            expect_clean(fmt::format("{} splats, int64 {}", integrator, int64),
                         include({"integrators/" + integrator + ".cl"}),
                         {"-DFILM_SPLATS=1", fmt::format("-DFILM_INT64_ATOMICS={}", int64)});
}

TEST_F(CodeGeneration, OfTheProgramsThatRecord) {
    expect_clean_with_and_without_effects("recording",
                                          entry_points({"path", "distribution", "whitted", "raycast"}),
                                          {"-DCLRT_TRACE=1", "-DSAMPLES_AT_ONCE=1"});
}

TEST_F(CodeGeneration, OfTheKernelsOfClrtBench) {
    expect_clean_with_and_without_effects(
        "clrt-bench", include({"bench/aimed.cl", "bench/make_rays.cl", "bench/trace.cl", "bench/visits.cl"}),
        {"-DCLRT_COUNT_VISITS=1", "-I" CLRT_BENCH_FOLDER "/kernels"});
}

TEST_F(CodeGeneration, OfTheProbesOfTestsAndClrtStability) {
    RayDeviceOptions rays;
    rays.effects = EFFECT_ALL;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        rays.layout = layout;
        expect_clean(fmt::format("rays through {}", name_of(layout)), ray_probe(test_device(), rays));
    }
    expect_clean("rays by Moeller and Trumbore's test",
                 ray_probe(test_device(), ray_options(Build::NAIVE, plain_triangles(test_device()))));
    expect_clean("the tests' lobes", BsdfProbe(test_device()).probe());
    expect_clean("the catalogue's lobes", bsdf_probes(test_device()).probe(Build::SINGLE));
    expect_clean("the catalogue's paths", path_probe(test_device(), Build::SINGLE));
    expect_clean("the catalogue's film", film_bench_probe(test_device(), Build::SINGLE));
}

TEST_F(CodeGeneration, TheCheckSeesVectorsThatCrossBordersAndTheKernelsTurnOffThatWarningAlone) {
    const std::string crossing = "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n"
                                 "kernel void add(global double* x) { vstore8(vload8(0, x) + 1.0, 0, x); }\n";
    const std::string plain = folder.write("plain.cl", crossing);
    EXPECT_NE(complaints(plain, SSE2).find("[-Werror,-Wpsabi]"), std::string::npos);
    EXPECT_NE(complaints(plain, AVX2).find("[-Werror,-Wpsabi]"), std::string::npos);
    EXPECT_EQ(complaints(plain, AVX512), "");

    const std::string device = include({"numerics/device.h"});
    EXPECT_EQ(complaints(folder.write("quiet.cl", device + crossing), SSE2), "");
    const std::string unused = device + crossing + "kernel void idle(void) { int unused; }\n";
    EXPECT_NE(complaints(folder.write("unused.cl", unused), SSE2).find("-Wunused-variable"),
              std::string::npos);
}

} // namespace clrt
