// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/obj_colours.h"

#include "colour.h"

#include <algorithm>
#include <cmath>
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

std::vector<Remark> decode_vertex_colours(ObjMesh& mesh, const std::string& path) {
    if (mesh.colours.empty())
        return {};
    const SourcePlace place{path, mesh.first_colour_line};
    const Range range = range_of(mesh.colours);
    if (range.least < 0 || range.largest > LARGEST_BYTE) {
        mesh.colours = {};
        return {
            {"numbers behind v x y z that are no colours are ignored: expected r g b from 0 to 1, or whole "
             "ones to 255",
             place}};
    }
    const bool bytes = range.whole && range.largest > 1;
    for (glm::vec3& colour : mesh.colours)
        colour = decoded(colour, bytes ? LARGEST_BYTE : 1);
    std::vector<Remark> remarks;
    remarks.push_back(
        {fmt::format("vertex colours (v x y z r g b{}), sRGB, multiply Kd where there is no map_Kd",
                     bytes ? ", from 0 to 255" : ""),
         place});
    if (!bytes && range.largest > 1)
        remarks.push_back({"vertex colours above 1 are clamped", place});
    return remarks;
}

std::vector<bool> coloured_materials(const ObjMesh& mesh) {
    if (mesh.colours.empty())
        return {};
    std::vector<bool> coloured(mesh.material_names.size(), false);
    for (const MeshTriangle& triangle : mesh.triangles)
        if (!coloured[triangle.material])
            coloured[triangle.material] =
                std::any_of(triangle.v, triangle.v + 3, [&](u32 v) { return is_given(mesh.colours[v]); });
    return coloured;
}

MtlMaterial with_vertex_colours(MtlMaterial material, const SourcePlace& first_colour) {
    MtlTexture map;
    map.file = "vertex colours";
    map.place = first_colour;
    map.by_vertex = true;
    material.map_kd = map;
    return material;
}

} // namespace clrt
