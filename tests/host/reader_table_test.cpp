// SPDX-License-Identifier: Apache-2.0
// Which reader takes a file, and what the OBJ's gives.
#include "scene/readers/reader_table.h"

#include "error.h"
#include "scene/readers/obj_scene.h"
#include "scene_support.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

const char* const TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A scene's description and what was noted on the way; pictures cannot be read.
struct Described {
    NoticeList notices;
    SceneDescription scene;

    explicit Described(const SceneFile& file) {
        Progress silent(Toggle::OFF, true);
        const PictureFacts none{[](const TextureUse&, TextureRole) { return false; },
                                [](const TextureUse&) { return false; }};
        scene = find_reader(file).read(file, {silent, notices, none, MtlReading::AUTO});
    }
};

std::string name_of_reader(const SceneFile& file) {
    return find_reader(file).name;
}

std::string error_of(const SceneFile& file) {
    try {
        find_reader(file);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(ReaderTable, WhatHasNoMarkIsAnObj) {
    for (const char* text : {"", "v 0 0 0\n", "# text\n"})
        EXPECT_EQ(name_of_reader({"stdin", text}), "a Wavefront OBJ") << text;
}

TEST(ReaderTable, BytesSayMoreThanTheExtension) {
    const std::string stl = "solid a\nfacet normal 0 0 1\n";
    for (const char* name : {"a.obj", "a.stl", "stdin"})
        EXPECT_EQ(name_of_reader({name, stl}), "an STL file") << name;
    EXPECT_EQ(name_of_reader({"a.STL", "v 0 0 0\n"}), "an STL file") << "where they say nothing";
    for (const char* name : {"a.obj", "a.glb", "stdin"}) {
        EXPECT_EQ(name_of_reader({name, std::string("glTF\2\0\0\0", 8)}), "a glTF file") << name;
        EXPECT_EQ(name_of_reader({name, "\xef\xbb\xbf {\"asset\": {\"version\": \"2.0\"}}"}), "a glTF file")
            << name;
    }
    EXPECT_EQ(reader_names(), "a Wavefront OBJ, an STL file, a PLY file or a glTF file");
}

TEST(ReaderTable, OtherFormatsAreNamed) {
    EXPECT_EQ(error_of({"scene.obj", "BLENDER-v300"})
                  .find("scene.obj: expected " + reader_names() + ", found a Blender file: export it as"),
              0u);
}

TEST(ReaderTable, RowsAreNamesWithAnArticleAndExtensionsInLowerCase) {
    for (const SceneReader& reader : scene_readers()) {
        const std::string name = reader.name, extension = reader.extension;
        EXPECT_TRUE(name.rfind("a ", 0) == 0 || name.rfind("an ", 0) == 0) << name;
        EXPECT_EQ(extension.at(0), '.');
        EXPECT_EQ(extension.find_first_not_of(".abcdefghijklmnopqrstuvwxyz0123456789"), std::string::npos);
        EXPECT_NE(reader_names().find(name), std::string::npos);
    }
}

TEST(ObjScene, WritersWhoseUpIsZAreKnown) {
    const auto reason = [](const std::string& head) {
        return Described({"a.obj", head + TRIANGLE}).scene.z_up_reason;
    };
    EXPECT_EQ(reason("# Created by FreeCAD <https://www.freecad.org>\n"), "it is by FreeCAD, whose up is z");
    EXPECT_EQ(reason("# OpenSCAD obj exporter\n"), "it is by OpenSCAD, whose up is z");
    EXPECT_EQ(reason("# Blender v2.79 (sub 0) OBJ File\n"), "");
}

TEST(ObjScene, MaterialsAreThoseOfFacesInTheOrderOfTheirUse) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl unused\nnewmtl glass\nillum 7\nmap_Ns n.png\nd 0\n");
    const Described described({folder.path("a.obj"), std::string("mtllib a.mtl\n") + TRIANGLE +
                                                         "usemtl glass\nf 1 2 3\nusemtl none\nf 1 2 3\n"});
    const std::vector<MaterialDescription>& materials = described.scene.materials;
    ASSERT_EQ(materials.size(), 3u);
    EXPECT_EQ(materials[0].rule, "no material: matte Kd 0.8");
    EXPECT_EQ(materials[0].base.value, glm::dvec3(0.8));
    EXPECT_EQ(materials[1].name, "glass");
    EXPECT_EQ(materials[1].reflection, Reflection::DIELECTRIC);
    EXPECT_EQ(materials[1].place.line, 2u);
    EXPECT_EQ(materials[2].place.line, 8u);
    EXPECT_EQ(described.scene.mesh.triangles[2].material, 2u);
    ASSERT_EQ(described.scene.files.size(), 1u);
    EXPECT_EQ(described.scene.files[0].path, folder.path("a.mtl"));
    EXPECT_EQ(count_notices(described.notices, "usemtl 'none': no library defines it"), 1);
    EXPECT_EQ(count_notices(described.notices, "d is 0"), 1) << "coverage outlives another surface";
    EXPECT_EQ(count_notices(described.notices, "map_Ns"), 0);
    ASSERT_EQ(materials[1].surface_remarks.size(), 1u);
    EXPECT_EQ(materials[1].surface_remarks[0].text, "map_Ns has no effect here and is ignored");
}

} // namespace clrt
