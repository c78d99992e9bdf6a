// SPDX-License-Identifier: Apache-2.0
// Files of other formats are named, and no OBJ is taken for one.
#include "scene/readers/foreign_format.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

using namespace std::string_view_literals;

/// The format's name, without the advice.
std::string name_of(std::string_view bytes) {
    const std::string text = foreign_format(bytes);
    return text.substr(0, text.find(':'));
}

} // namespace

TEST(ForeignFormat, FormatsAreKnownByTheirFirstBytes) {
    EXPECT_EQ(name_of("{}"), "a JSON file");
    EXPECT_EQ(name_of("Kaydara FBX Binary  \0"sv), "an FBX file");
    EXPECT_EQ(name_of("; FBX 7.3.0 project file\n"), "an FBX file");
    EXPECT_EQ(name_of("BLENDER-v300"), "a Blender file");
    EXPECT_EQ(name_of("<?xml version=\"1.0\"?>\n<COLLADA>"), "a COLLADA file (DAE)");
    EXPECT_EQ(name_of("<scene version=\"3.0.0\">"), "an XML file");
    EXPECT_EQ(name_of("#usda 1.0\n"), "a USD file");
    EXPECT_EQ(name_of("OFF\n8 6 12\n"), "an OFF file");
    EXPECT_EQ(name_of("MM\x10\0\0\0"sv), "a 3DS file");
    EXPECT_EQ(name_of("newmtl red\nKd 1 0 0\n"), "a material library (MTL)");
    EXPECT_EQ(name_of("# Blender 5.0.1 MTL File: 'a.blend'\n\nnewmtl red\n"), "a material library (MTL)");
    EXPECT_EQ(name_of("PK\3\4"), "a ZIP archive");
    EXPECT_EQ(name_of("\x89PNG\r\n"), "a PNG picture");
    EXPECT_EQ(name_of("version https://git-lfs.github.com/spec/v1\n"), "a pointer of Git LFS");
    EXPECT_EQ(name_of("\xff\xfev\0 \0"sv), "") << "UTF-16 text may be an OBJ";
}

TEST(ForeignFormat, WhatAnObjMayBeginWithIsLeftAlone) {
    for (const char* text :
         {"", "#", "# Blender 5.0.1\nmtllib a.mtl\no a\n", "v 0 0 0\n", "mtllib a.mtl\n", "o solid\n",
          "solid\nv 0 0 0\n", "g facet\nsolid\n", "offset\n", "playdough\n", "p 1\n", "MM\n"})
        EXPECT_EQ(foreign_format(text), "") << text;
}

} // namespace clrt
