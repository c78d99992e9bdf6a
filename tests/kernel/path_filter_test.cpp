// SPDX-License-Identifier: Apache-2.0
// path/automaton.h and path/filter.h: the tables are read as they were written, and what a filter leaves of a
// BSDF is sampled without bias.
#include "kernels/shared/path_types.h"
#include "kernels/shared/scene_types.h"
#include "paths/path_plan.h"
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "render/scene_buffers.h"
#include "support/test_device.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace clrt;

namespace {

// State 1 leads to 2, 3, 4, 5 by D, G, R, T. Behind D any light ends a path, behind G a point light alone, so
// that no ray is needed; R needs two events more, T is followed by R.
constexpr u32 MATTE_STATE = 2, GLOSSY_STATE = 3, MIRROR_STATE = 4, REFRACTION_STATE = 5;

/// Their words, by number.
std::vector<u32> state_words() {
    return {STATE_DEAD,
            1 | STATE_CONTINUES | STATE_SPLITS,
            MATTE_STATE | KINDS_ALL << STATE_KINDS_SHIFT | STATE_CONTINUES,
            GLOSSY_STATE | KIND_POINT << STATE_KINDS_SHIFT,
            MIRROR_STATE | STATE_CONTINUES | 2u << STATE_DISTANCE_SHIFT,
            REFRACTION_STATE | STATE_CONTINUES | KIND_SKY << STATE_KINDS_SHIFT};
}

PathTables tables() {
    const std::vector<u32> words = state_words();
    PathTables made{std::vector<PathState>(words.size())};
    for (u32& next : made.states[0].next)
        next = words[1];
    for (const u32 letter : {LETTER_MATTE, LETTER_GLOSSY, LETTER_MIRROR, LETTER_REFRACTION})
        made.states[1].next[letter] = words[MATTE_STATE + letter];
    made.states[REFRACTION_STATE].next[LETTER_MIRROR] = words[MIRROR_STATE];
    return made;
}

const char* const TEXT = R"(
RenderParams probe_params(uint max_depth)
{
    RenderParams params;
    params.max_depth = max_depth;
    return params;
}

/* A surface of lobes whose reflectances differ by channel. */
Bsdf probe_bsdf(uint lobes, real eta)
{
    Bsdf bsdf;
    bsdf.frame = frame_make(vector_normalize(vector_make(REAL(0.36), REAL(-0.48), REAL(0.8))));
    bsdf.wo = vector_normalize(vector_make(REAL(0.5), REAL(0.2), REAL(0.7)));
    bsdf.normal_g = bsdf.frame.z;
    bsdf.is_curved = false;
    bsdf.matte = vector_make(REAL(0.5), REAL(0.3), REAL(0.0));
    bsdf.specular = vector_make(REAL(0.2), REAL(0.4), REAL(0.3));
    bsdf.transmission = vector_make(REAL(1.0), REAL(0.9), REAL(0.8));
    bsdf.alpha_x = bsdf.alpha_y = (lobes & LOBE_DIELECTRIC) && eta < REAL(0.0) ? REAL(0.3) : REAL(0.0);
    if (lobes & LOBE_GLOSSY)
        bsdf.alpha_x = bsdf.alpha_y = REAL(0.4);
    bsdf.eta = fabs(eta);
    bsdf.exponent = REAL(0.0);
    bsdf.lobes = lobes;
    bsdf.fresnel = FRESNEL_NONE;
    bsdf.flags = 0u;
    bsdf_energy_set(&bsdf);
    bsdf_choose_lobes(&bsdf);
    return bsdf;
}

constant uint PROBE_STATES[] = {STATE_WORDS};

/* The four states behind a vertex, a byte each for its number. */
AutomatonStep probe_step(uint word)
{
    AutomatonStep step;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        step.next[letter] = PROBE_STATES[(word >> (8u * letter)) & 0xffu];
    return step;
}

/* Where the automaton starts, and the numbers of the states behind `states` (numbers) after a segment. */
CLRT_KERNEL void probe_automaton(SCENE_PARAMS, const u32 count, global const u32* states,
                                 global const u32* letters, global const u32* segments, global u32* start,
                                 global u32* next)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const RenderParams params = probe_params(10u);
    start[i] = automaton_start(&scene);
    next[i] = automaton_next(&scene, &params, PROBE_STATES[states[i]], letters[i], segments[i]);
}
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        ProbeOptions options;
        options.defines = {fmt::format("STATE_WORDS={:#x}u", fmt::join(state_words(), "u,"))};
        KernelProbe made(test_device(), {"path/filter.h"}, options);
        made.add_text(TEXT);
        made.add<u32(u32, u32, float)>(
            "lobes", "Bsdf bsdf = probe_bsdf(b, (real)c); const AutomatonStep step = "
                     "probe_step(a); filter_lobes(&step, &bsdf); out = bsdf.lobes | bsdf.flags;");
        made.add<vec4(u32, u32, float)>(
            "continues", "Bsdf bsdf = probe_bsdf(b, (real)c); const AutomatonStep step = probe_step(a); "
                         "filter_lobes(&step, &bsdf); const bool goes = filter_continues(&step, &bsdf); "
                         "out = (vec4)(goes ? 1.0f : 0.0f, (float)bsdf.choose[LOBE_ROW_MATTE], "
                         "(float)bsdf.choose[LOBE_ROW_GLOSSY], (float)bsdf.choose[LOBE_ROW_MIRROR]);");
        made.add<vec4(u32, vec4, float)>(
            "share",
            "const Bsdf bsdf = probe_bsdf(LOBE_MATTE | LOBE_GLOSSY, REAL(1.5)); const AutomatonStep step = "
            "probe_step(a); real3 share; const bool matte = LETTER_MATTE == filter_choose_letter(&step, "
            "&bsdf, "
            "frame_to_world(&bsdf.frame, vector_from(b)), (real)c, &share); "
            "out = (vec4)(convert_float3(share), matte ? 1.0f : 0.0f);");
        made.add<vec4(vec4)>("parts", "const Bsdf bsdf = probe_bsdf(LOBE_MATTE | LOBE_GLOSSY, REAL(1.5)); "
                                      "const real3 wi = frame_to_world(&bsdf.frame, vector_from(a)); "
                                      "out = (vec4)(convert_float3(filter_part(&bsdf, LETTER_MATTE, wi) / "
                                      "bsdf_eval(&bsdf, wi).value), 0.0f);");
        made.add<vec4(u32, u32, vec4)>(
            "value",
            "Bsdf bsdf = probe_bsdf(LOBE_MATTE | LOBE_GLOSSY, REAL(1.5)); const AutomatonStep step = "
            "probe_step(a); const real3 wi = frame_to_world(&bsdf.frame, vector_from(c)); "
            "const real3 whole = bsdf_eval(&bsdf, wi).value; "
            "out = (vec4)(convert_float3(filter_value(&step, &bsdf, wi, b, whole) / whole), 0.0f);");
        made.add<vec4(u32, float, float)>(
            "glass",
            "Bsdf bsdf = probe_bsdf(LOBE_DIELECTRIC, (real)b); const AutomatonStep step = probe_step(a); "
            "filter_lobes(&step, &bsdf); const BsdfSample s = bsdf_sample(&bsdf, (real)c, "
            "(real2)(REAL(0.3))); "
            "out = (vec4)((float)s.weight.x, (float)s.weight.y, s.is_valid ? 1.0f : 0.0f, "
            "(float)(step.next[filter_letter(&bsdf, &s)] & STATE_NUMBER_MASK));");
        made.add<vec4(float)>("fresnel", "real t; const Bsdf bsdf = probe_bsdf(LOBE_DIELECTRIC, (real)a); "
                                         "out = (vec4)((float)fresnel_dielectric(bsdf.wo.z, (real)a, &t));");
        return made;
    }();
    return instance;
}

u32 step_word(u32 matte, u32 glossy, u32 mirror, u32 refraction) {
    return matte | glossy << 8 | mirror << 16 | refraction << 24;
}

const u32 ALL_LIVE = step_word(MATTE_STATE, GLOSSY_STATE, MIRROR_STATE, REFRACTION_STATE);

/// Where paths start, and the states behind some by number after a letter and at the end of a segment.
struct Walked {
    std::vector<u32> start, next;
};

Walked walk(const std::vector<u32>& states, const std::vector<u32>& letters,
            const std::vector<u32>& segments) {
    Kernel kernel = probe().kernel("probe_automaton");
    bind_scene(upload_scene(test_device(), Scene(), Bvh(), tables()), kernel);
    kernel.set("count", u32(states.size()));
    kernel.set("states", probe().upload(states));
    kernel.set("letters", probe().upload(letters));
    kernel.set("segments", probe().upload(segments));
    const cl::Buffer start = create_buffer(test_device(), "start", states.size() * sizeof(u32));
    const cl::Buffer next = create_buffer(test_device(), "next", states.size() * sizeof(u32));
    kernel.set("start", start);
    kernel.set("next", next);
    probe().launch(kernel, states.size());
    return {probe().read<u32>(start, states.size()), probe().read<u32>(next, states.size())};
}

/// The words of states by number.
std::vector<u32> words_of(const std::vector<u32>& numbers) {
    std::vector<u32> words;
    for (const u32 number : numbers)
        words.push_back(state_words()[number]);
    return words;
}

u32 lobes_left(u32 step, u32 lobes, float eta = 1.5f) {
    return probe().run<u32>("lobes", std::vector<u32>{step}, std::vector<u32>{lobes},
                            std::vector<float>{eta})[0];
}

constexpr u32 NO_REFLECTION = 0x10000, NO_REFRACTION = 0x20000; // BSDF_* of scattering/bsdf_types.h

/// Directions above the surface.
std::vector<vec4> directions() {
    std::vector<vec4> made;
    Random random(5);
    for (int i = 0; i < 64; ++i) {
        const glm::dvec3 d = random.direction();
        made.push_back({float(d.x), float(d.y), float(std::abs(d.z)), 0});
    }
    return made;
}

} // namespace

TEST(PathFilter, TablesAreReadAsTheyWereWritten) {
    const Walked walked = walk({1, 1, 1, 1, MATTE_STATE, REFRACTION_STATE, REFRACTION_STATE},
                               {0, 1, 2, 3, 2, 2, 3}, std::vector<u32>(7, 1));
    EXPECT_EQ(walked.start, words_of(std::vector<u32>(7, 1)));
    EXPECT_EQ(walked.next, words_of({2, 3, 4, 5, 0, 4, 0}));
}

TEST(PathFilter, APathThatIsTooLongToEndInTimeIsDead) {
    // Of 10 segments, state 4 needs two after the next.
    EXPECT_EQ(walk({1, 1, 1, 1}, {2, 2, 0, 0}, {7, 8, 9, 10}).next, words_of({4, 0, 2, 0}));
}

TEST(PathFilter, LobesOfDeadLettersAreTakenAway) {
    const u32 both = LOBE_MATTE | LOBE_GLOSSY, varnished = LOBE_MATTE | LOBE_MIRROR;
    EXPECT_EQ(lobes_left(ALL_LIVE, both), both);
    EXPECT_EQ(lobes_left(step_word(0, 3, 4, 5), both), u32(LOBE_GLOSSY));
    EXPECT_EQ(lobes_left(step_word(2, 0, 4, 5), both), u32(LOBE_MATTE));
    EXPECT_EQ(lobes_left(step_word(0, 0, 4, 5), both), 0u);
    EXPECT_EQ(lobes_left(step_word(2, 3, 0, 5), varnished), u32(LOBE_MATTE));
    EXPECT_EQ(lobes_left(step_word(0, 3, 4, 5), varnished), u32(LOBE_MIRROR));
    // Smooth glass has two letters, frosted glass (here: eta < 0) is glossy.
    EXPECT_EQ(lobes_left(step_word(0, 0, 4, 5), LOBE_DIELECTRIC), u32(LOBE_DIELECTRIC));
    EXPECT_EQ(lobes_left(step_word(0, 0, 0, 5), LOBE_DIELECTRIC), LOBE_DIELECTRIC | NO_REFLECTION);
    EXPECT_EQ(lobes_left(step_word(0, 0, 4, 0), LOBE_DIELECTRIC), LOBE_DIELECTRIC | NO_REFRACTION);
    EXPECT_EQ(lobes_left(step_word(2, 3, 0, 0), LOBE_DIELECTRIC) & LOBE_DIELECTRIC, 0u);
    EXPECT_EQ(lobes_left(step_word(0, 3, 0, 0), LOBE_DIELECTRIC, -1.5f), u32(LOBE_DIELECTRIC));
    EXPECT_EQ(lobes_left(step_word(2, 0, 4, 5), LOBE_DIELECTRIC, -1.5f), 0u);
}

TEST(PathFilter, OnlyLobesWithSomethingBehindThemAreSampled) {
    const auto run = [](u32 step, u32 lobes) {
        const vec4 out = probe().run<vec4>("continues", std::vector<u32>{step}, std::vector<u32>{lobes},
                                           std::vector<float>{1.5f})[0];
        return std::array<float, 3>{out.x, out.y, out.z};
    };
    using Expected = std::array<float, 3>;
    EXPECT_EQ(run(ALL_LIVE, LOBE_MATTE), (Expected{1, 1, 0}));
    EXPECT_EQ(run(ALL_LIVE, LOBE_GLOSSY)[0], 0) << "a point light is not found by rays";
    EXPECT_EQ(run(ALL_LIVE, LOBE_MATTE | LOBE_GLOSSY), (Expected{1, 1, 0}));
    EXPECT_EQ(run(step_word(3, 2, 4, 5), LOBE_MATTE | LOBE_GLOSSY), (Expected{1, 0, 1}));
    EXPECT_EQ(run(step_word(3, 3, 4, 5), LOBE_MATTE | LOBE_GLOSSY)[0], 0);
    EXPECT_EQ(run(step_word(3, 2, 4, 5), LOBE_MATTE | LOBE_MIRROR), (Expected{1, 0, 0}));
    EXPECT_EQ(run(ALL_LIVE, LOBE_DIELECTRIC)[0], 1);
    const Expected mixture = run(step_word(2, 2, 4, 5), LOBE_MATTE | LOBE_GLOSSY);
    EXPECT_EQ(mixture[0], 1);
    EXPECT_GT(mixture[1], 0.1f);
    EXPECT_FLOAT_EQ(mixture[1] + mixture[2], 1);
}

TEST(PathFilter, ChoosingAClassIsUnbiased) {
    // The mean over the choice of each class's share is the share of its lobe, channel by channel.
    constexpr int COUNT = 4096;
    for (const vec4& wi : directions()) {
        std::vector<float> u;
        for (int i = 0; i < COUNT; ++i)
            u.push_back((float(i) + 0.5f) / COUNT);
        const u32 both_go_on = step_word(2, 5, 0, 0);
        const std::vector<vec4> got =
            probe().run<vec4>("share", std::vector<u32>(COUNT, both_go_on), std::vector<vec4>(COUNT, wi), u);
        const vec4 expected = probe().run<vec4>("parts", std::vector<vec4>{wi})[0];
        glm::dvec3 matte(0), glossy(0);
        for (const vec4& share : got)
            (share.w != 0 ? matte : glossy) += glm::dvec3(share.x, share.y, share.z) / double(COUNT);
        EXPECT_NEAR(matte.x, expected.x, 1e-3);
        EXPECT_NEAR(matte.y, expected.y, 1e-3);
        EXPECT_NEAR(matte.z, 0, 1e-3) << "blue is not matte";
        EXPECT_NEAR(glossy.x, 1 - expected.x, 2e-3);
        EXPECT_NEAR(glossy.y, 1 - expected.y, 2e-3);
        EXPECT_NEAR(glossy.z, 1, 2e-3);
    }
}

TEST(PathFilter, AClassWithNothingBehindItIsNotChosen) {
    for (const vec4& wi : directions()) {
        const vec4 expected = probe().run<vec4>("parts", std::vector<vec4>{wi})[0];
        const std::vector<vec4> got =
            probe().run<vec4>("share", std::vector<u32>{ALL_LIVE, step_word(3, 2, 0, 0)},
                              std::vector<vec4>{wi, wi}, std::vector<float>{0.999f, 0.001f});
        EXPECT_EQ(got[0].w, 1);
        EXPECT_NEAR(got[0].x, expected.x, 1e-5);
        EXPECT_EQ(got[1].w, 0);
        EXPECT_NEAR(got[1].y, 1 - expected.y, 1e-5);
    }
}

TEST(PathFilter, LightReachesTheClassesThatAcceptIt) {
    for (const vec4& wi : directions()) {
        const vec4 matte = probe().run<vec4>("parts", std::vector<vec4>{wi})[0];
        const auto value = [&](u32 step, u32 kind) {
            return probe()
                .run<vec4>("value", std::vector<u32>{step}, std::vector<u32>{kind}, std::vector<vec4>{wi})[0]
                .x;
        };
        EXPECT_EQ(value(ALL_LIVE, KIND_POINT), 1) << "both accept it: the value is left alone";
        EXPECT_NEAR(value(ALL_LIVE, KIND_AREA), matte.x, 1e-5);
        EXPECT_NEAR(value(step_word(3, 2, 0, 0), KIND_AREA), 1 - matte.x, 1e-5);
        EXPECT_EQ(value(step_word(3, 3, 0, 0), KIND_AREA), 0);
        EXPECT_EQ(value(step_word(5, 5, 0, 0), KIND_SKY), 1);
    }
}

TEST(PathFilter, TheOnlyWayThroughGlassIsAlwaysTaken) {
    const auto run = [](u32 step, float eta, float u) {
        return probe().run<vec4>("glass", std::vector<u32>{step}, std::vector<float>{eta},
                                 std::vector<float>{u})[0];
    };
    for (const float eta : {1 / 1.5f, 1.2f}) {
        const float f = probe().run<vec4>("fresnel", std::vector<float>{eta})[0].x;
        ASSERT_TRUE(f > 0 && f < 1);
        for (const float u : {0.001f, 0.999f}) {
            const vec4 reflected = run(step_word(0, 0, 4, 0), eta, u),
                       refracted = run(step_word(0, 0, 0, 5), eta, u);
            EXPECT_FLOAT_EQ(reflected.x, 0.2f * f);
            EXPECT_EQ(reflected.w, float(MIRROR_STATE));
            EXPECT_FLOAT_EQ(refracted.x, eta * eta * (1 - f));
            EXPECT_EQ(refracted.w, float(REFRACTION_STATE));
        }
        EXPECT_EQ(run(ALL_LIVE, eta, 0.001f).w, float(MIRROR_STATE));
        EXPECT_FLOAT_EQ(run(ALL_LIVE, eta, 0.001f).x, 0.2f);
        EXPECT_EQ(run(ALL_LIVE, eta, 0.999f).w, float(REFRACTION_STATE));
    }
    // Total reflection: nothing is refracted. Equal indices: nothing is reflected.
    EXPECT_EQ(run(step_word(0, 0, 0, 5), 2.5f, 0.5f).z, 0);
    EXPECT_EQ(run(ALL_LIVE, 2.5f, 0.999f).w, float(MIRROR_STATE));
    EXPECT_EQ(run(ALL_LIVE, 1, 0.001f).w, float(REFRACTION_STATE));
    EXPECT_EQ(run(step_word(0, 0, 4, 0), 1, 0.5f).z, 0);
}
