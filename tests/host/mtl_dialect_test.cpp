// SPDX-License-Identifier: Apache-2.0
// Who wrote a material library, by its header.
#include "scene/readers/mtl_dialect.h"

#include "scene/readers/mtl_reader.h"
#include "support/blender_mtl.h"

#include <gtest/gtest.h>

using namespace clrt;

TEST(MtlDialect, HeadersNameTheirWriters) {
    const struct {
        const char* text;
        MtlDialect dialect;
        const char* name;
    } headers[] = {
        {"# Blender 5.0.1 MTL File: 'None'\n# www.blender.org\n", MtlDialect::BLENDER, "Blender 5.0.1"},
        {"\xef\xbb\xbf\r\n  #Blender 3.4.1 MTL File: 'a b.blend'\r\n", MtlDialect::BLENDER, "Blender 3.4.1"},
        {"# Blender MTL File: 'x.blend'\n# Material Count: 3\n", MtlDialect::BLENDER_PYTHON,
         "Blender before 3.1"},
        {"# Blender3D MTL File: x.blend\n", MtlDialect::BLENDER_PYTHON, "Blender before 3.1"},
        {"# 3ds Max Wavefront OBJ Exporter v0.97b - (c)2007 guruware\n# File Created: 01.01.2012\n",
         MtlDialect::PLAIN, "3ds Max"},
        {"#\n# Wavefront material file\n# Converted by Meshlab Group\n#\n", MtlDialect::PLAIN, "MeshLab"},
        {"# File produced by Open Asset Import Library (http://www.assimp.sf.net)\n", MtlDialect::PLAIN,
         "assimp"},
        {"## Alias OBJ Material File\n# Exported from SketchUp, (c) 2000-2012 Trimble\n", MtlDialect::PLAIN,
         "SketchUp"},
        {"# Alias Maya\n", MtlDialect::PLAIN, "Maya"},
        {"# my own materials\n", MtlDialect::PLAIN, ""},
        {"# made with Blender, MTL File\n", MtlDialect::PLAIN, ""},
        {"# Blender MTL\n", MtlDialect::PLAIN, ""},
        {"# temple of the Mayas\n", MtlDialect::PLAIN, ""},
        {"newmtl a\n# Blender 5.0.1 MTL File: 'None'\n", MtlDialect::PLAIN, ""},
        {"", MtlDialect::PLAIN, ""},
        {"#", MtlDialect::PLAIN, ""},
        {"Blender 5.0.1 MTL File:", MtlDialect::PLAIN, ""},
    };
    for (const auto& header : headers) {
        const MtlWriter writer = find_mtl_writer(header.text);
        EXPECT_EQ(writer.dialect, header.dialect) << header.text;
        EXPECT_EQ(writer.name, header.name) << header.text;
    }
}

TEST(MtlDialect, EveryMaterialKnowsTheWriterOfItsLibrary) {
    NoticeList notices;
    for (const MtlMaterial& material : parse_mtl(BLENDER_PBR_MTL, "a.mtl", notices))
        EXPECT_EQ(material.writer.name, "Blender 5.0.1");
    EXPECT_EQ(parse_mtl("newmtl a\n", "a.mtl", notices).at(0).writer.name, "");
    EXPECT_TRUE(notices.lines().empty());
}
