// SPDX-License-Identifier: Apache-2.0
// A scene rendered by a program that has just the effects it calls for has the bits of the full program's
// picture: for every effect alone and for a covering array of their combinations, of which a share is drawn.
// With the variable CLRT_TEST_LONG set, for all of these, for all effects but one, and by every integrator.
#include "app/command_line.h"
#include "console/progress.h"
#include "effects/effects.h"
#include "effects/take_out.h"
#include "probes/effect_masks.h"
#include "render/kernels.h"
#include "scene/load_scene.h"
#include "support/drawn.h"
#include "support/render_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

namespace fs = std::filesystem;

namespace clrt {

namespace {

std::vector<Integrator> integrators() {
    return tests_are_long() ? std::vector{Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED,
                                          Integrator::RAYCAST}
                            : std::vector{Integrator::PATH};
}

/// How many sums differ, so that a failure prints a number and no film.
size_t count_differences(const Film& a, const Film& b) {
    EXPECT_EQ(a.sums.size(), b.sums.size());
    size_t count = 0;
    for (size_t i = 0; i < std::min(a.sums.size(), b.sums.size()); ++i)
        count += a.sums[i] != b.sums[i];
    return count;
}

/// Renders a loaded scene by a program with its own effects and by the full one, and expects one film.
void expect_same_bits(const Scene& scene, Options options, const std::string& what) {
    options.effects.all = false;
    const Render needed = render_loaded(scene, options);
    options.effects.all = true;
    const Render all = render_loaded(scene, options);
    EXPECT_EQ(count_differences(needed.film, all.film), 0u) << what;
    EXPECT_EQ(needed.counts.rays(), all.counts.rays()) << what;
    EXPECT_EQ(needed.counts.bad() + all.counts.bad(), 0u) << what;
}

void expect_same_bits(EffectMask effects) {
    for (const Integrator integrator : integrators()) {
        SceneOfEffects small(effects);
        small.options.transport.integrator = integrator;
        if (!takes_option(integrator, TAKES_PATHS))
            small.options.transport.paths.clear();
        const Scene scene = small.load();
        const EffectMask needed = find_effects(scene, small.options).needed;
        const bool has_tree = light_tree_kinds(integrator) &
                              ((effects & EFFECT_AREA_LIGHT) ? KINDS_ALL : KINDS_ALL & ~KIND_AREA);
        const EffectMask expected = effects &
                                    ~(integrator == Integrator::RAYCAST ? EFFECT_INTERREFLECTION : 0u) &
                                    ~(takes_option(integrator, TAKES_PATHS) ? 0u : EFFECT_PATH_FILTER) &
                                    ~(has_tree ? 0u : EFFECT_LIGHT_TREE);
        EXPECT_EQ(needed, expected) << describe_effects(needed) << "\ninstead of "
                                    << describe_effects(expected);
        expect_same_bits(scene, small.options,
                         std::string(name_of(integrator)) + ", " + describe_effects(effects));
    }
}

/// A shipped scene at 16 x 16 pixels with the options beside it.
Options shipped_options(const fs::path& obj) {
    const std::string path = obj.string();
    const char* const command[] = {"clrt", path.c_str()};
    Options options = parse_command_line(2, command).options;
    options.film.size = {16, 16};
    options.sampling.spp = 16;
    options.output.files.clear();
    return options;
}

std::vector<fs::path> shipped_scenes() {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(CLRT_SCENES_FOLDER))
        for (const auto& file : fs::directory_iterator(entry.path()))
            if (file.path().extension() == ".obj")
                paths.push_back(file.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

} // namespace

TEST(EffectMasks, EveryEffectAloneHasTheBitsOfTheFullProgram) {
    for (const EffectMask effects : drawn(single_effects(), 4))
        expect_same_bits(effects);
}

TEST(EffectMasks, EveryPairOfEffectsHasTheBitsOfTheFullProgram) {
    for (const EffectMask effects : drawn(pairwise_effects(), 4))
        expect_same_bits(effects);
}

TEST(EffectMasks, AllEffectsButOneHaveTheBitsOfTheFullProgram) {
    const std::vector<EffectMask> sets = all_but_one_effect();
    for (size_t i = 0; i < (tests_are_long() ? sets.size() : 1); ++i)
        expect_same_bits(sets[i]);
}

TEST(EffectMasks, EveryShippedSceneHasTheBitsOfTheFullProgram) {
    ASSERT_GE(shipped_scenes().size(), 8u);
    for (const fs::path& path : drawn(shipped_scenes(), 4))
        for (const Integrator integrator : integrators()) {
            Options options = shipped_options(path);
            options.transport.integrator = integrator;
            const PathDepths& depth = integrator_row(integrator).depth;
            if (depth.usual < USUAL_PATH_DEPTH) // trees double with every segment
                options.transport.max_depth =
                    std::min(options.transport.max_depth.value_or(depth.usual), depth.usual);
            Progress progress(Toggle::OFF, true);
            expect_same_bits(load_scene(options, progress), options,
                             path.string() + ", " + name_of(integrator));
        }
}

TEST(EffectMasks, ShippedScenesNameTheirEffects) {
    for (const fs::path& path : shipped_scenes()) {
        const Options options = shipped_options(path);
        Progress progress(Toggle::OFF, true);
        std::string names;
        for (const Effect& effect : find_effects(load_scene(options, progress), options).list)
            if (effect.present)
                names += (names.empty() ? "" : ", ") + effect.name;
        std::ifstream file(path.parent_path() / "README.md");
        std::string text{std::istreambuf_iterator<char>(file), {}};
        std::replace(text.begin(), text.end(), '\n', ' ');
        EXPECT_NE(text.find("Effects: " + names), std::string::npos) << path << ": Effects: " << names;
    }
}

TEST(EffectMasks, ALeftOutEffectIsASceneWithoutIt) {
    // Whatever is left out, the program without its code and the full program render the same scene.
    const Scene scene = SceneOfEffects(EVERY_EFFECT).load();
    for (const EffectSpec& effect : drawn(effect_table(), 8)) {
        Options options = SceneOfEffects(EVERY_EFFECT).options;
        options.effects.off = effect.bit;
        const Effects effects = find_effects(scene, options);
        EXPECT_EQ(effects.left_out, EVERY_EFFECT & ~without_effects(EVERY_EFFECT, effect.bit));
        const Render without = render_loaded(scene, options);
        Scene reduced = scene;
        take_out_effects(effects.left_out, reduced, options);
        options.effects.off = 0;
        options.effects.all = true;
        EXPECT_EQ(count_differences(without.film, render_loaded(reduced, options).film), 0u) << effect.name;
        EXPECT_EQ(without.counts.bad(), 0u) << effect.name;
    }
}

TEST(EffectMasks, ProgramsFromTheCacheRenderTheSameBits) {
    const ScratchFolder cache;
    const EffectMask sets[] = {
        with_implied(EFFECT_MATTE | EFFECT_AREA_LIGHT),
        with_implied(EFFECT_MATTE | EFFECT_AREA_LIGHT | EFFECT_REFRACTION | EFFECT_DELTA_LIGHT)};
    for (int round = 0; round < 2; ++round)
        for (const EffectMask effects : sets) {
            SceneOfEffects small(effects);
            const Film plain = small.render(test_device()).film;
            small.options.device.cache = Toggle::ON;
            small.options.device.cache_folder = fs::path(cache.file("any")).parent_path().string();
            bool from_cache = false;
            const Film cached = render_afresh(test_device(), small.load(), small.options, &from_cache).film;
            EXPECT_EQ(from_cache, round == 1) << describe_effects(effects);
            EXPECT_EQ(count_differences(plain, cached), 0u) << describe_effects(effects);
        }
}

} // namespace clrt
