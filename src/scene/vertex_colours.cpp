// SPDX-License-Identifier: Apache-2.0
#include "scene/vertex_colours.h"

#include "colour.h"
#include "error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace clrt {

namespace {

constexpr float LARGEST_BYTE = 255;

bool is_given(const glm::vec3& colour) {
    return !std::isnan(colour.x);
}

/// What the numbers of a file have in common.
struct Range {
    float least = 0, largest = 0;
    bool whole = true; ///< no fractions
};

Range range_of(const std::vector<glm::vec3>& colours) {
    Range range;
    for (const glm::vec3& colour : colours)
        for (int c = 0; c < 3 && is_given(colour); ++c) {
            // What is no number counts as infinite.
            const float value = std::isnan(colour[c]) ? INFINITY : colour[c];
            range.least = std::min(range.least, value);
            range.largest = std::max(range.largest, value);
            range.whole &= value == std::floor(value);
        }
    return range;
}

glm::vec3 decoded(const glm::vec3& colour, float unit) {
    if (!is_given(colour))
        return glm::vec3(1);
    glm::vec3 linear;
    for (int c = 0; c < 3; ++c)
        linear[c] = float(srgb_to_linear(std::min(double(colour[c]) / double(unit), 1.0)));
    return linear;
}

} // namespace

void decode_vertex_colours(ObjMesh& mesh, const std::string& obj_path, NoticeList& notices) {
    if (mesh.colours.empty())
        return;
    const SourcePlace place{obj_path, mesh.first_colour_line};
    const Range range = range_of(mesh.colours);
    if (range.least < 0 || range.largest > LARGEST_BYTE) {
        notices.add("numbers behind v x y z that are no colours are ignored: expected r g b from 0 to 1, or "
                    "whole ones to 255",
                    place);
        mesh.colours = {};
        return;
    }
    const bool bytes = range.whole && range.largest > 1;
    notices.add(fmt::format("vertex colours (v x y z r g b{}), sRGB, multiply Kd where there is no map_Kd",
                            bytes ? ", from 0 to 255" : ""),
                place);
    if (!bytes && range.largest > 1)
        notices.add("vertex colours above 1 are clamped", place);
    for (glm::vec3& colour : mesh.colours)
        colour = decoded(colour, bytes ? LARGEST_BYTE : 1);
}

std::vector<bool> coloured_materials(const ObjMesh& mesh) {
    if (mesh.colours.empty())
        return {};
    std::vector<bool> coloured(mesh.material_names.size(), false);
    for (const ObjTriangle& triangle : mesh.triangles)
        if (!coloured[triangle.material])
            coloured[triangle.material] =
                std::any_of(triangle.v, triangle.v + 3, [&](u32 v) { return is_given(mesh.colours[v]); });
    return coloured;
}

MtlMaterial with_vertex_colours(MtlMaterial material, const SourcePlace& first_colour, NoticeList& notices) {
    if (material.map_kd) {
        notices.add("map_Kd is taken, the vertex colours have no effect", material.map_kd->place);
        return material;
    }
    MtlTexture map;
    map.file = "vertex colours";
    map.place = first_colour;
    map.by_vertex = true;
    material.map_kd = map;
    return material;
}

void store_vertex_colours(Scene& scene, const std::string& obj_path) {
    const std::vector<glm::vec3> colours = std::move(scene.vertex_colours);
    scene.vertex_colours = {};
    const auto is_by_vertex = [](const Texture& texture) { return texture.format == TEXEL_VERTEX; };
    if (colours.empty() || std::none_of(scene.textures.begin(), scene.textures.end(), is_by_vertex))
        return;
    const size_t first = scene.texel_words.size(), words = 3 * colours.size();
    if (first + words > NO_INDEX)
        throw SceneError(obj_path, 0,
                         "vertex colours and textures need more than 2^32 words: expected fewer vertices or "
                         "smaller pictures");
    scene.texel_words.resize(first + words);
    std::memcpy(&scene.texel_words[first], colours.data(), words * sizeof(u32));
    for (Texture& texture : scene.textures)
        if (is_by_vertex(texture))
            texture.first_word = u32(first);
}

} // namespace clrt
