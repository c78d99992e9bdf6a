// SPDX-License-Identifier: Apache-2.0
// options/integrators.h against the kernels, --help, the options and the notation of paths.
#include "options/integrators.h"

#include "app/help_text.h"
#include "app/option_table.h"
#include "device/kernel_source.h"
#include "host/command_line_support.h"
#include "paths/automaton.h"
#include "paths/path_expression.h"

#include <gtest/gtest.h>
#include <set>
#include <utility>

namespace clrt {

namespace {

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// All that is compiled of the integrator.
std::string kernel_text(const IntegratorRow& row) {
    return expand_kernel_source(embedded_kernel_files(), integrator_file(row.value));
}

/// A page without line ends and repeated blanks.
std::string on_one_line(const std::string& page) {
    std::string line;
    for (const char c : page)
        if (c != '\n' && !(c == ' ' && !line.empty() && line.back() == ' '))
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    return line;
}

Automaton automaton_of(const char* expression) {
    const PathAlphabet everything{(1u << LETTER_COUNT) - 1, KINDS_ALL};
    return make_automaton(parse_path_expression(expression), {}, everything);
}

/// Whether every path of `part` is one of `all`.
bool is_part(const char* part, const char* all) {
    const Automaton a = automaton_of(part), b = automaton_of(all);
    std::set<std::pair<int, int>> seen;
    std::vector<std::pair<int, int>> left{{1, 1}};
    while (!left.empty()) {
        const auto [s, t] = left.back();
        left.pop_back();
        if (s == 0 || !seen.insert({s, t}).second)
            continue;
        const AutomatonState &in_part = a.states[size_t(s)], &in_all = b.states[size_t(t)];
        if (in_part.kinds & ~in_all.kinds)
            return false;
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter)
            left.emplace_back(in_part.next[letter], in_all.next[letter]);
    }
    return true;
}

} // namespace

TEST(Integrators, EachHasAKernelFileAndNoneIsForgotten) {
    const KernelFiles& files = embedded_kernel_files();
    std::set<std::string> expected;
    for (const IntegratorRow& row : INTEGRATOR_ROWS) {
        ASSERT_TRUE(files.count(integrator_file(row.value))) << integrator_file(row.value);
        EXPECT_TRUE(holds(files.at(integrator_file(row.value)), integrator_kernel(row.value))) << row.name;
        expected.insert(integrator_file(row.value));
    }
    for (const auto& [file, text] : files)
        if (holds(text, "#define INTEGRATOR_KERNEL")) {
            EXPECT_TRUE(expected.count(file)) << file << " is no row of options/integrators.h";
        }
}

TEST(Integrators, KernelsReadWhatTheirRowTakes) {
    const std::pair<IntegratorOption, const char*> uses[] = {
        {TAKES_ROULETTE_DEPTH, "params->roulette_depth"},
        {TAKES_MIN_CONTRIBUTION, "params->min_contribution"},
        {TAKES_PATHS, "accepted(path)"},
        {TAKES_SHADOW_RAYS, "params->shadow_rays"},
        {TAKES_GLOSS_RAYS, "params->gloss_rays"},
        {TAKES_TRANSLUCENT_RAYS, "params->translucent_rays"},
        {TAKES_GUIDE, "guide_of(scene"}};
    for (const IntegratorRow& row : INTEGRATOR_ROWS)
        for (const auto& [option, use] : uses) {
            // Chains walk the paths of others, whose roulette is off (render/render_params.cpp).
            if (walks_chains(row.value) && option == TAKES_ROULETTE_DEPTH)
                continue;
            EXPECT_EQ(holds(kernel_text(row), use), takes_option(row.value, option))
                << row.name << ": " << use;
        }
}

TEST(Integrators, HelpSaysWhatEachSimulatesAndTakes) {
    const std::string page = on_one_line(help_text(100));
    for (const IntegratorRow& row : INTEGRATOR_ROWS) {
        EXPECT_TRUE(holds(page, std::string(row.name) + " (" + row.help + ")")) << row.name;
        const char* const always = takes_option(row.value, TAKES_MAX_DEPTH) ? " " : " always ";
        const int usual = integrator_row(TransportOptions{}.integrator).depth.usual;
        const bool is_default = row.depth.usual == usual && takes_option(row.value, TAKES_MAX_DEPTH);
        const std::string depth = std::to_string(row.depth.usual);
        EXPECT_TRUE(holds(page, is_default ? "(default " + depth : row.name + (always + depth))) << row.name;
    }
    EXPECT_TRUE(holds(page, "or auto (path, path+light or bdpt, as small pilot"));
    EXPECT_TRUE(holds(page, "(default auto)"));
    EXPECT_TRUE(holds(page, "--roulette-depth N light, path, path+light, bdpt: first segment"));
    EXPECT_TRUE(holds(page, "--min-contribution X whitted, distribution: smallest weight worth a ray"));
    EXPECT_TRUE(holds(page, "--paths EXPR distribution, path: simulate only these paths"));
    EXPECT_TRUE(holds(page, "--shadow-rays N distribution: shadow rays of a surface point"));
}

TEST(Integrators, WhatTheyTakeAreOptions) {
    unsigned all = 0;
    for (const auto& row : NAMES<IntegratorOption>) {
        EXPECT_TRUE(find_option(row.name)) << row.name;
        EXPECT_FALSE(integrators_with(row.value).empty()) << row.name;
        all |= row.value;
    }
    for (const IntegratorRow& row : INTEGRATOR_ROWS)
        EXPECT_EQ(row.takes & ~all, 0u) << row.name;
}

TEST(Integrators, DepthsAreThoseOfTheRow) {
    for (const IntegratorRow& row : INTEGRATOR_ROWS) {
        const auto depth = [&](int asked) {
            return effective_max_depth(
                parse({"-i", row.name, "--max-depth", std::to_string(asked)}).transport);
        };
        EXPECT_EQ(effective_max_depth(parse({"-i", row.name}).transport), row.depth.usual);
        EXPECT_LE(row.depth.usual, row.depth.longest) << row.name;
        const bool takes = takes_option(row.value, TAKES_MAX_DEPTH);
        EXPECT_EQ(depth(1), takes ? 1 : row.depth.usual) << row.name;
        EXPECT_EQ(depth(row.depth.longest), row.depth.longest) << row.name;
        if (!takes || row.depth.longest == LARGEST_DEPTH)
            continue;
        EXPECT_EQ(refusal({"-i", row.name, "--max-depth", std::to_string(row.depth.longest + 1), "s.obj"}),
                  "option --max-depth: expected at most " + std::to_string(row.depth.longest) +
                      " with --integrator " + row.name + ", found " + std::to_string(row.depth.longest + 1));
    }
}

TEST(Integrators, PathsAreToldApartByThoseThatTakeThem) {
    for (const IntegratorRow& row : INTEGRATOR_ROWS)
        for (const auto& [option, value] : {std::pair("--paths", "LDE"), std::pair("--aov", "a=LDE")}) {
            const std::string message = refusal({option, value, "-i", row.name, "-o", "a.exr", "s.obj"});
            const std::string shown = option == std::string("--aov") ? "--aov NAME=EXPR" : option;
            EXPECT_EQ(message,
                      takes_option(row.value, TAKES_PATHS)
                          ? "accepted"
                          : "option " + shown + ": expected --integrator distribution or path, found " +
                                row.name +
                                (row.film == FilmAccess::SPLAT
                                     ? ", whose light paths are not told apart"
                                     : std::string(", which simulates '") + row.paths.all + "' alone"));
            if (row.film == FilmAccess::SPLAT) {
                EXPECT_EQ(refusal({"--adaptive", "-i", row.name, "s.obj"}),
                          std::string("option --adaptive: expected an integrator that gathers, found ") +
                              row.name + ", whose light paths reach all pixels at once");
            }
        }
}

TEST(Integrators, TechniquesFindNothingButWhatIsSimulated) {
    EXPECT_TRUE(is_part("LDE", "LD?E"));
    EXPECT_FALSE(is_part("LD*E", "LD?E"));
    EXPECT_TRUE(is_part("LD?S*E", integrator_row(Integrator::DISTRIBUTION).paths.all)) << "whitted's";
    for (const IntegratorRow& row : INTEGRATOR_ROWS) {
        EXPECT_TRUE(is_part(row.paths.by_rays, row.paths.all)) << row.name;
        EXPECT_TRUE(is_part(row.paths.by_connection, row.paths.all)) << row.name;
    }
}

} // namespace clrt
