// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/text_encoding.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

std::string little(const std::u16string& units) {
    std::string bytes = "\xff\xfe";
    for (const char16_t unit : units)
        bytes += {char(unit & 0xff), char(unit >> 8)};
    return bytes;
}

} // namespace

TEST(TextEncoding, OtherTextIsReturnedAsItIs) {
    for (const std::string& text :
         {std::string(), std::string("v"), std::string("v 1"), std::string("\xef\xbb\xbfv"),
          std::string("\xff"), std::string("v\0", 2), std::string(9, '\0')})
        EXPECT_EQ(as_utf8(text), text);
}

TEST(TextEncoding, EveryLengthOfUtf8IsWritten) {
    const std::string mark = "\xef\xbb\xbf";
    EXPECT_EQ(as_utf8(little(u"a\u00e9\u20ac\U0001f600z")), mark + "a\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80z");
    EXPECT_EQ(as_utf8(little(u"\u007f\u0080\u07ff\u0800\uffff\U00010000\U0010ffff")),
              mark + "\x7f\xc2\x80\xdf\xbf\xe0\xa0\x80\xef\xbf\xbf\xf0\x90\x80\x80\xf4\x8f\xbf\xbf");
    EXPECT_EQ(as_utf8(std::string("\xfe\xff\0v\x20\xac", 6)), mark + "v\xe2\x82\xac");
}

TEST(TextEncoding, HalvesOfPairsAndOfCharactersAreHarmless) {
    const std::string mark = "\xef\xbb\xbf", replaced = "\xef\xbf\xbd";
    EXPECT_EQ(as_utf8(little({0xd800, u'a'})), mark + replaced + "a");
    EXPECT_EQ(as_utf8(little({0xdc00, 0xd800})), mark + replaced + replaced);
    EXPECT_EQ(as_utf8(little(u"ab") + "c"), mark + "ab") << "half a character at the end";
}

} // namespace clrt
