// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/foreign_format.h"

#include "scene/readers/text_encoding.h"
#include "scene/text_scanner.h"

namespace clrt {

namespace {

using namespace std::string_view_literals;

/// How much of a file is looked at for words that tell texts apart.
constexpr size_t HEAD_BYTES = 4096;

constexpr const char* EXPORT = "export it as glTF or OBJ from the program it comes from, or convert it "
                               "(`assimp export FILE scene.glb`, from Debian's assimp-utils)";
constexpr const char* UNPACK = "unpack it and give the OBJ inside";
constexpr const char* PICTURE =
    "give the OBJ or glTF; an MTL names pictures (map_Kd), --env takes one for the sky";

struct Format {
    std::string_view start; ///< the file's first bytes
    std::string_view word;  ///< and what must stand in its head; empty: anything
    const char* name;
    const char* advice;
};

/// Signatures as the formats' specifications give them; the first that fits counts.
constexpr Format FORMATS[] = {
    {"{"sv, ""sv, "a JSON file", EXPORT},
    {"Kaydara FBX Binary"sv, ""sv, "an FBX file", EXPORT},
    {"; FBX"sv, ""sv, "an FBX file", EXPORT},
    {"BLENDER"sv, ""sv, "a Blender file", EXPORT},
    {"<!DOCTYPE html"sv, ""sv, "a web page", "download the file that it shows"},
    {"version https://git-lfs"sv, ""sv, "a pointer of Git LFS", "fetch the file itself: `git lfs pull`"},
    {"<"sv, "<COLLADA"sv, "a COLLADA file (DAE)", EXPORT},
    {"<"sv, "<X3D"sv, "an X3D file", EXPORT},
    {"<"sv, ""sv, "an XML file", EXPORT},
    {"#usda"sv, ""sv, "a USD file", EXPORT},
    {"PXR-USDC"sv, ""sv, "a USD file", EXPORT},
    {"#VRML"sv, ""sv, "a VRML file", EXPORT},
    {"OFF\n"sv, ""sv, "an OFF file", EXPORT},
    {"OFF\r"sv, ""sv, "an OFF file", EXPORT},
    {"Ogawa"sv, ""sv, "an Alembic file", EXPORT},
    {"MM"sv, "\0"sv, "a 3DS file", EXPORT},
    {"# Blender"sv, "\nnewmtl "sv, "a material library (MTL)", "give the OBJ that names it (mtllib)"},
    {"newmtl "sv, ""sv, "a material library (MTL)", "give the OBJ that names it (mtllib)"},
    {"PK\x03\x04"sv, ""sv, "a ZIP archive", UNPACK},
    {"\x1f\x8b"sv, ""sv, "a gzip archive", UNPACK},
    {"\x28\xb5\x2f\xfd"sv, ""sv, "a zstd archive", UNPACK},
    {"\xfd\x37zXZ"sv, ""sv, "an xz archive", UNPACK},
    {"\x89PNG"sv, ""sv, "a PNG picture", PICTURE},
    {"\xff\xd8\xff"sv, ""sv, "a JPEG picture", PICTURE},
    {"\x76\x2f\x31\x01"sv, ""sv, "an OpenEXR picture", PICTURE},
    {"#?RADIANCE"sv, ""sv, "a Radiance picture", PICTURE},
    {"\xff\xfe\0\0"sv, ""sv, "UTF-32 text", "save it as UTF-8"},
    {"\0\0\xfe\xff"sv, ""sv, "UTF-32 text", "save it as UTF-8"},
};

std::string describe(const char* name, const char* advice) {
    return std::string(name) + ": " + advice;
}

} // namespace

std::string foreign_format(std::string_view bytes) {
    const std::string_view head = bytes.substr(0, HEAD_BYTES);
    const std::string decoded = as_utf8(std::string(head));
    const std::string_view text = trim(without_byte_order_mark(decoded));
    for (const Format& format : FORMATS)
        for (const std::string_view start : {head, text})
            if (start.substr(0, format.start.size()) == format.start && start.find(format.word) != start.npos)
                return describe(format.name, format.advice);
    return {};
}

} // namespace clrt
