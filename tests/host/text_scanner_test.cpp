// SPDX-License-Identifier: Apache-2.0
// Lines, words and numbers are read alike on every kind of text.
#include "scene/text_scanner.h"

#include "error.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <unistd.h>
#include <vector>

namespace clrt {
namespace {

using namespace std::string_view_literals;

/// The lines of a text as "number:text".
std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    LineReader reader(text);
    while (reader.next())
        lines.push_back(std::to_string(reader.number()) + ":" + std::string(reader.text()));
    return lines;
}

using Lines = std::vector<std::string>;

TEST(TextScanner, LinesEndInLfCrLfOrCr) {
    EXPECT_EQ(lines_of("a\nb\r\nc\rd"), (Lines{"1:a", "2:b", "3:c", "4:d"}));
    EXPECT_EQ(lines_of("a\r\rb\n\nc\r\n\r\nd\r"), (Lines{"1:a", "3:b", "5:c", "7:d"}));
    EXPECT_EQ(lines_of(""), Lines{});
}

TEST(TextScanner, LineEndsAreCounted) {
    LineReader reader("a\r\nb\rc\n\n# d", 5);
    while (reader.next())
        continue;
    EXPECT_EQ(reader.line_ends(), 4u);
    EXPECT_EQ(reader.text(), "");
}

TEST(TextScanner, BlankAndCommentLinesAreSkipped) {
    EXPECT_EQ(lines_of("# a\n \t \n  b \t\n\t# c\nd # e"), (Lines{"3:b", "5:d # e"}));
}

TEST(TextScanner, BackslashAtLineEndContinuesTheLine) {
    EXPECT_EQ(lines_of("a\\\nb\nc\\\r\nd\\\re\nf"), (Lines{"1:a b", "3:c d e", "6:f"}));
    EXPECT_EQ(lines_of("a\\"), Lines{"1:a"});
    EXPECT_EQ(lines_of("a\\b\n\\\nc"), (Lines{"1:a\\b", "2:c"}));
    EXPECT_EQ(lines_of("# a\\\nb"), Lines{"2:b"});
}

TEST(TextScanner, NextLineStartNeverSplitsStatements) {
    const std::string_view text = "ab\r\nc\\\nd\\\r\ne\rf\n";
    const size_t expected[] = {4, 4, 4, 4, 13, 13, 13, 13, 13, 13, 13, 13, 13, 15, 15, 15};
    for (size_t from = 0; from < text.size() && from < std::size(expected); ++from)
        EXPECT_EQ(next_line_start(text, from), expected[from]) << from;
    EXPECT_EQ(next_line_start("abc", 1), 3u);
}

TEST(TextScanner, WordsAreSplitAtBlanks) {
    std::string_view rest = "  ab\tc  d#e ";
    EXPECT_EQ(next_word(rest), "ab");
    EXPECT_EQ(next_word(rest), "c");
    EXPECT_EQ(next_word(rest), "d#e");
    EXPECT_EQ(next_word(rest), "");
    EXPECT_EQ(trim(" \t a b\t"), "a b");
    EXPECT_EQ(without_comment("1 2#3 #4 # 5"), "1 2#3 ");
    EXPECT_EQ(without_comment("# 5"), "");
}

TEST(TextScanner, NumbersFillTheirWord) {
    const std::pair<std::string_view, float> numbers[] = {{"1", 1},        {"+.5", 0.5f},    {"-2.", -2},
                                                          {"1.5e3", 1500}, {"1E-05", 1e-5f}, {"007", 7},
                                                          {"-0", 0},       {"1e-42", 1e-42f}};
    for (const auto& [word, expected] : numbers) {
        float value = 99;
        EXPECT_TRUE(parse_number(word, value)) << word;
        EXPECT_EQ(value, expected) << word;
    }
    const std::string_view wrong[] = {"",     "+",   "-",   ".",   "e5", "1,5",  "1.5f",
                                      "0x10", "+-1", "++1", "--1", "1 ", "1\0"sv};
    for (const std::string_view word : wrong) {
        float value = 99;
        EXPECT_FALSE(parse_number(word, value)) << word;
        EXPECT_EQ(value, 99) << word;
    }
}

TEST(TextScanner, NumbersBeyondTheRangeAreInfiniteOrZero) {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::string zeros(500, '0');
    const std::pair<std::string, float> numbers[] = {{"1e39", infinity},
                                                     {"-1e39", -infinity},
                                                     {"1e-60", 0},
                                                     {"1e99999999999999999999", infinity},
                                                     {"1e-99999999999999999999", 0},
                                                     {"1" + zeros, infinity},
                                                     {"0." + zeros + "1", 0},
                                                     {"inf", infinity},
                                                     {"-1.#INF00", -infinity}};
    for (const auto& [word, expected] : numbers) {
        float value = 99;
        EXPECT_TRUE(parse_number(word, value)) << word;
        EXPECT_EQ(value, expected) << word;
    }
    for (const char* word : {"nan", "-nan", "NaN", "1.#IND", "-1.#QNAN"}) {
        double value = 99;
        EXPECT_TRUE(parse_number(word, value)) << word;
        EXPECT_TRUE(std::isnan(value)) << word;
    }
}

TEST(TextScanner, QuotedTextIsShortAndPrintable) {
    EXPECT_EQ(quoted("a b"), "'a b'");
    EXPECT_EQ(quoted("\x01\n\x7f\0"sv), "'\\x01\\x0a\\x7f\\x00'");
    EXPECT_EQ(quoted("K\xc3\xbc \xe2\x82\xac \xf0\x9f\x98\x80"), "'K\xc3\xbc \xe2\x82\xac \xf0\x9f\x98\x80'");
    EXPECT_EQ(quoted("\xff\xc3(\xe2\x82"), "'\\xff\\xc3(\\xe2\\x82'");
    // Overlong forms, a surrogate and what lies beyond Unicode are no characters.
    EXPECT_EQ(quoted("\xc0\xaf\xe0\x80"), "'\\xc0\\xaf\\xe0\\x80'");
    EXPECT_EQ(quoted("\xe0\x80\x80"), "'\\xe0\\x80\\x80'");
    EXPECT_EQ(quoted("\xed\xa0\x80"), "'\\xed\\xa0\\x80'");
    EXPECT_EQ(quoted("\xf4\x90\x80\x80"), "'\\xf4\\x90\\x80\\x80'");
    EXPECT_LT(clrt::quoted(std::string(100000, 'x')).size(), 100u);
}

TEST(TextScanner, ByteOrderMarkIsSkipped) {
    EXPECT_EQ(without_byte_order_mark("\xef\xbb\xbfv"), "v");
    EXPECT_EQ(without_byte_order_mark("\xef\xbb"), "\xef\xbb");
}

TEST(TextScanner, FilesAreReadWhole) {
    const std::string path = testing::TempDir() + "text_scanner_test_" + std::to_string(getpid());
    for (const size_t size : {0, 1, 100, 3000000}) {
        std::ofstream(path, std::ios::binary) << std::string(size, '\0');
        EXPECT_EQ(read_file(path), std::string(size, '\0'));
    }
    std::filesystem::remove(path);
}

TEST(TextScanner, PipesAreReadWhole) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    ASSERT_EQ(write(ends[1], "v 1 2 3", 7), 7);
    close(ends[1]);
    EXPECT_EQ(read_file("/proc/self/fd/" + std::to_string(ends[0])), "v 1 2 3");
    close(ends[0]);
}

TEST(TextScanner, WhatIsNoReadableFileIsRefused) {
    const std::string folder = testing::TempDir();
    const std::pair<std::string, std::string> cases[] = {
        {folder + "missing.obj", "cannot be opened: No such file or directory"},
        {folder, "expected a file, found a folder"},
        {"/dev/zero", "expected a file, found a device or a socket"}};
    for (const auto& [path, message] : cases) {
        try {
            read_file(path);
            ADD_FAILURE() << path;
        } catch (const SceneError& error) {
            EXPECT_EQ(error.what(), path + ": " + message);
        }
    }
}

} // namespace
} // namespace clrt
