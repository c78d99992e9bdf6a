// SPDX-License-Identifier: Apache-2.0
#include "output/file_name.h"

#include "error.h"

#include <gtest/gtest.h>

using namespace clrt;

TEST(FileName, PlaceholdersBecomeNumbers) {
    const NameValues values{7, 64, 3};
    EXPECT_EQ(expand_file_name("plain.png", values), "plain.png");
    EXPECT_EQ(expand_file_name("a-{seed}-{spp}-{frame}.png", values), "a-7-64-3.png");
    EXPECT_EQ(expand_file_name("{frame:4}/{spp:1}{spp:3}.exr", values), "0003/64064.exr");
    EXPECT_EQ(expand_file_name("{frame:04}.png", values), "0003.png") << "as in other programs";
}

TEST(FileName, DoubledBracesAreBraces) {
    EXPECT_EQ(expand_file_name("{{seed}}.png", {7, 0, 0}), "{seed}.png");
    EXPECT_EQ(expand_file_name("{{{seed}}}.png", {7, 0, 0}), "{7}.png");
    for (const char* name : {"plain", "{seed}", "}{", "a{{b}}"})
        EXPECT_EQ(expand_file_name(literal_file_name(name), {7, 0, 0}), name);
}

TEST(FileName, UnknownWordsAndSingleBracesAreUsageErrors) {
    for (const char* name : {"{name}", "{}", "{seed", "seed}", "{frame:}", "{frame:x}", "{frame:0}",
                             "{frame:99}", "{Seed}", "{frame:-1}", "{"}) {
        try {
            expand_file_name(name, {});
            ADD_FAILURE() << name;
        } catch (const UsageError& error) {
            EXPECT_NE(std::string(error.what()).find("{seed}, {spp} or {frame}"), std::string::npos)
                << error.what();
        }
    }
}

TEST(FileName, FramesAreNumberedBeforeTheExtension) {
    EXPECT_EQ(with_frame_number("turn.png"), "turn-{frame:4}.png");
    EXPECT_EQ(with_frame_number("a.b/turn"), "a.b/turn-{frame:4}");
    EXPECT_EQ(with_frame_number("turn{frame}.png"), "turn{frame}.png");
    EXPECT_EQ(with_frame_number("{{frame}}.png"), "{{frame}}-{frame:4}.png");
}
