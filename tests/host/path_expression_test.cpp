// SPDX-License-Identifier: Apache-2.0
// Path notation: what is read, and where the caret stands when it is not.
#include "paths/path_expression.h"

#include "error.h"

#include <gtest/gtest.h>
#include <random>

namespace clrt {

namespace {

/// The message of the error that reading ends with.
std::string refusal(const std::string& text) {
    try {
        parse_path_expression(text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

struct Wrong {
    const char* text;
    int column;          ///< of the caret, from 0
    const char* expects; ///< a part of what the message expects
    const char* finds;
};

} // namespace

TEST(PathExpression, TheCaretStandsUnderTheOffendingCharacter) {
    const Wrong cases[] = {
        {"", 0, "a letter", "its end"},
        {"LDX", 2, "a letter", "'X'"},
        {"LDe", 2, "a letter", "'e'"},
        {"LzDE", 1, "a (area), p (point), d (sun) or e", "'z'"},
        {"L(D|S*E", 7, "a ')' for the '(' in column 2", "its end"},
        {"L((D|S)*E", 9, "a ')' for the '(' in column 2", "its end"},
        {"LDE)", 3, "a ')' that nothing opens", "')'"},
        {"L()E", 2, "a letter", "')'"},
        {"L(|D)E", 2, "a letter", "'|'"},
        {"LDE|", 4, "a letter", "its end"},
        {"L*DE", 0, "a light only once", "'L'"},
        {"*LDE", 0, "a letter", "'*'"},
        {"L{2}E", 1, "a letter", "'{'"},
        {"L D \tE", 4, "a letter", "the byte 0x09"},
        {"L\xc3\xa4"
         "E",
         1, "a letter", "the byte 0xc3"},
        {"DE", 0, "start with a light", "starts with 'D'"},
        {"L?DE", 2, "start with a light", "starts with 'D'"},
        {"L(D|S)*", 4, "end with the eye", "ends with 'S'"},
        {"(LD|LDE)", 2, "end with the eye", "ends with 'D'"},
        {"L", 0, "end with the eye", "ends with 'L'"},
        {"LDLE", 2, "a light only once", "'L'"},
        {"LDEE", 2, "the eye only once", "'E'"},
        {"LEDE", 1, "the eye only once", "'E'"},
        {"LDE*", 2, "the eye only once", "'E'"},
        {"(LDE)*", 0, "paths from a light to the eye", "also matches nothing"},
        {"ED", 1, "end with a light", "ends with 'D'"},
        {"E(D|L)", 2, "end with a light", "ends with 'D'"},
        {"E?DL", 2, "start with the eye", "starts with 'D'"},
    };
    for (const Wrong& wrong : cases) {
        const std::string message = refusal(wrong.text);
        SCOPED_TRACE(message);
        EXPECT_NE(message.find(std::string("expected ")), std::string::npos);
        EXPECT_NE(message.find(wrong.expects), std::string::npos);
        EXPECT_NE(message.find(wrong.finds), std::string::npos);
        const size_t line = message.rfind('\n');
        ASSERT_NE(line, std::string::npos);
        EXPECT_EQ(message.substr(line), "\n  " + std::string(size_t(wrong.column), ' ') + "^");
    }
}

TEST(PathExpression, TheWholeExpressionIsShownAboveTheCaret) {
    EXPECT_NE(refusal("L(D|X)*E").find("\n  L(D|X)*E\n      ^"), std::string::npos) << refusal("L(D|X)*E");
    EXPECT_NE(refusal("L\x01\x80").find("\n  L??\n   ^"), std::string::npos) << refusal("L\x01\x80");
}

TEST(PathExpression, BothSpellingsAndBlanksAreRead) {
    for (const char* text : {"LE", "L(D|S)*E", "E(D|S)*L", "C(D|S)*L", " L ( D | S ) * E ", "LaR+T*.E",
                             "L(D|(S|G))?E", "LpDE|LdDE", "(La|Le)D**E", "LD+?*E"})
        EXPECT_EQ(refusal(text), "accepted") << text;
}

TEST(PathExpression, LengthAndNestingAreBounded) {
    const std::string deep = "L" + std::string(100, '(') + "D" + std::string(100, ')') + "E";
    EXPECT_EQ(refusal(deep), "accepted");
    EXPECT_NE(refusal("L" + std::string(101, '(') + "D").find("at most 100 parentheses"), std::string::npos);
    EXPECT_EQ(refusal("L" + std::string(LONGEST_PATH_EXPRESSION - 2, 'D') + "E"), "accepted");
    EXPECT_NE(
        refusal("L" + std::string(LONGEST_PATH_EXPRESSION - 1, 'D') + "E").find("at most 500 characters"),
        std::string::npos);
}

TEST(PathExpression, NoTextCrashesTheReader) {
    // Any bytes, and strings of symbols, which come further.
    std::mt19937 random(7);
    const std::string symbols = "LLEEDGSRT.|*+?()(()) apdeC";
    size_t read = 0;
    for (int i = 0; i < 50000; ++i) {
        std::string text(random() % 24, ' ');
        for (char& c : text)
            c = i % 4 == 0 ? char(random()) : symbols[random() % symbols.size()];
        const std::string message = refusal(text);
        read += message == "accepted";
        ASSERT_TRUE(message == "accepted" || message.rfind("expected ", 0) == 0) << text << message;
    }
    EXPECT_GT(read, 20u) << "too few of them are expressions";
}

} // namespace clrt
