// SPDX-License-Identifier: Apache-2.0
// All kernels compile without a warning for every set of effects under test as OpenCL C 1.2, for a drawn
// share of the sets as 3.0 and as programs that splat; no device is needed.
#include "clang_complaints.h"
#include "probes/effect_masks.h"
#include "probes/scratch_folder.h"
#include "support/drawn.h"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

std::string all_entry_points() {
    return entry_points({"path", "distribution", "whitted", "raycast"}) + "#include \"integrators/aov.cl\"\n";
}

/// What clang says about the kernels built with a mask; empty if nothing.
std::string complaints(const std::string& file, const std::string& standard, EffectMask mask) {
    return clang_complaints(file, {"-cl-std=" + standard, "--target=spir64-unknown-unknown", "-fsyntax-only",
                                   fmt::format("-DCLRT_EFFECTS={:#x}u", mask)});
}

/// The sets of compiled effects, each once.
std::vector<EffectMask> masks() {
    std::vector<EffectMask> result;
    for (const EffectMask effects : all_effect_sets())
        result.push_back(effects & EFFECT_ALL);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

} // namespace

TEST(EffectSyntax, EverySetOfEffectsCompilesInOpenCl12And30) {
    const ScratchFolder folder;
    const std::string file = folder.write("all.cl", all_entry_points());
    const std::vector<EffectMask> all = masks();
    ASSERT_GT(all.size(), 30u);
    for (const EffectMask mask : all)
        EXPECT_EQ(complaints(file, "CL1.2", mask), "") << describe_effects(mask);
    for (const EffectMask mask : drawn(all, 4))
        EXPECT_EQ(complaints(file, "CL3.0", mask), "") << describe_effects(mask);
}

TEST(EffectSyntax, SplattingProgramsCompileTooByEitherAtomic) {
    const ScratchFolder folder;
    for (const char* int64 : {"0", "1"}) {
        const std::string defines =
            fmt::format("#define FILM_SPLATS 1\n#define FILM_INT64_ATOMICS {}\n", int64);
        const std::string drawing = folder.write("all.cl", defines + entry_points({"path", "raycast"}));
        EXPECT_EQ(complaints(drawing, "CL1.2", EFFECT_ALL), "") << int64;
        for (const char* name : {"light", "path_light", "bdpt", "mlt"}) {
            const std::string own = folder.write("own.cl", defines + entry_points({name}));
            const std::string traced =
                folder.write("traced.cl", "#define CLRT_TRACE 1\n#define SAMPLES_AT_ONCE 1\n" + defines +
                                              entry_points({name}));
            for (const EffectMask mask :
                 int64 == std::string("1") ? drawn(masks(), 4) : std::vector<EffectMask>{EFFECT_ALL})
                EXPECT_EQ(complaints(own, "CL1.2", mask), "") << name << ", " << describe_effects(mask);
            EXPECT_EQ(complaints(traced, "CL1.2", EFFECT_ALL), "") << name;
        }
        for (const char* const name : {"path_light", "bdpt"})
            for (const char* const kind : {"FILM_MOMENTS", "PATH_GUIDE"}) {
                const std::string text = fmt::format("#define {} 1\n", kind) + defines + entry_points({name});
                const std::string none = folder.write("none.cl", text);
                EXPECT_EQ(complaints(none, "CL1.2", 0), "") << kind;
                const std::string all =
                    folder.write("all.cl", fmt::format("#define LAMPS_BEHIND_SLABS {}\n", int64) + text);
                EXPECT_EQ(complaints(all, "CL1.2", EFFECT_ALL), "") << kind;
            }
        const std::string recording = folder.write("replay.cl", "#define CLRT_TRACE 1\n" + defines +
                                                                    "#include \"integrators/path.cl\"\n");
        EXPECT_EQ(complaints(recording, "CL1.2", EFFECT_ALL), "") << int64;
    }
}

TEST(EffectSyntax, PathReuseCompilesInEverySetOfEffects) {
    const ScratchFolder folder;
    const std::string file = folder.write("reuse.cl", "#define PATH_REUSE 1\n" + entry_points({"path"}));
    const std::string splats = folder.write("splats.cl", "#define PATH_REUSE 1\n#define FILM_SPLATS 1\n" +
                                                             entry_points({"path_light"}));
    for (const EffectMask mask : masks())
        if ((mask & EFFECTS_OF_ONE_PIXEL) == 0) {
            EXPECT_EQ(complaints(file, "CL1.2", mask), "") << describe_effects(mask);
            EXPECT_EQ(complaints(splats, "CL1.2", mask), "") << describe_effects(mask);
        }
}

TEST(EffectSyntax, TheDenoisingFilterCompilesToo) {
    const ScratchFolder folder;
    for (const char* precision : {"", "#define REAL_IS_DOUBLE\n"}) {
        const std::string file =
            folder.write("filter.cl", precision + std::string("#include \"denoise/filter.cl\"\n"));
        for (const char* standard : {"CL1.2", "CL3.0"})
            EXPECT_EQ(complaints(file, standard, EFFECT_ALL), "") << standard << precision;
    }
}

TEST(EffectSyntax, RecordingProgramsCompileToo) {
    const ScratchFolder folder;
    for (const char* precision : {"", "#define REAL_IS_DOUBLE\n"}) {
        const std::string file = folder.write(
            "replay.cl", std::string("#define CLRT_TRACE 1\n#define SAMPLES_AT_ONCE 1\n") + precision +
                             entry_points({"path", "distribution", "whitted", "raycast"}));
        for (const EffectMask mask : {EFFECT_ALL, EFFECT_MATTE, EffectMask(EFFECT_MATTE | EFFECT_AREA_LIGHT)})
            EXPECT_EQ(complaints(file, "CL1.2", mask), "") << precision << describe_effects(mask);
    }
}

TEST(EffectSyntax, TheCheckSeesAnError) {
    const ScratchFolder folder;
    const std::string file =
        folder.write("all.cl", all_entry_points() + "int broken(void) { return HAS(EFFECT_NONE); }\n");
    EXPECT_NE(complaints(file, "CL1.2", EFFECT_ALL).find("EFFECT_NONE"), std::string::npos);
}

} // namespace clrt
