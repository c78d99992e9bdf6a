// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_primitives.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

/// More sets of four joints a vertex are not read.
constexpr size_t MOST_JOINT_SETS = 4;

enum PrimitiveMode : size_t { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6, MODE_COUNT = 7 };

/// Corners of the triangles of a list, a strip or a fan; those that join the parts of a strip are no
/// triangles.
std::vector<u32> triangle_corners(const std::vector<u32>& order, size_t mode) {
    std::vector<u32> corners;
    const size_t triangles =
        mode == MODE_TRIANGLES ? order.size() / 3 : std::max<size_t>(order.size(), 2) - 2;
    corners.reserve(3 * triangles);
    for (size_t i = 0; i < triangles; ++i) {
        size_t a = 3 * i, b = a + 1, c = a + 2;
        if (mode == MODE_STRIP)
            a = i, b = i + 1 + i % 2, c = i + 2 - i % 2;
        else if (mode == MODE_FAN)
            a = i + 1, b = i + 2, c = 0;
        const u32 triangle[] = {order[a], order[b], order[c]};
        const bool joins =
            triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
        if (mode == MODE_TRIANGLES || !joins)
            corners.insert(corners.end(), triangle, triangle + 3);
    }
    return corners;
}

std::vector<glm::vec3> vectors_of(const std::optional<GltfNumbers>& numbers) {
    std::vector<glm::vec3> vectors;
    for (size_t i = 0; numbers && i < numbers->count(); ++i)
        vectors.push_back(numbers->vec3(i));
    return vectors;
}

/// v grows from the upper left in the file.
std::vector<glm::vec2> coordinates_of(const std::optional<GltfNumbers>& numbers) {
    std::vector<glm::vec2> coordinates;
    for (size_t i = 0; numbers && i < numbers->count(); ++i)
        coordinates.emplace_back(numbers->at(i, 0), 1 - numbers->at(i, 1));
    return coordinates;
}

void check_count(const JsonValue& primitive, const char* name, size_t count, size_t vertices) {
    if (count != vertices)
        primitive.at("attributes")
            .at(name)
            .fail(fmt::format("{} elements as in POSITION", vertices), fmt::format("{}", count));
}

template <typename T>
void check_length(const JsonValue& primitive, const char* name, const std::vector<T>& values,
                  size_t vertices) {
    if (!values.empty())
        check_count(primitive, name, values.size(), vertices);
}

std::vector<GltfMorphTarget> targets_of(GltfBuffers& buffers, const JsonValue& primitive, size_t vertices) {
    std::vector<GltfMorphTarget> targets;
    const std::optional<JsonValue> given = primitive.find("targets");
    for (const JsonValue& target : given ? given->elements() : std::vector<JsonValue>()) {
        const auto read = [&](const char* name) {
            const std::optional<JsonValue> index = target.find(name);
            std::vector<glm::vec3> moves;
            if (index)
                moves = vectors_of(read_gltf_numbers(buffers, *index, GltfElement::VEC3));
            if (index && moves.size() != vertices)
                index->fail(fmt::format("{} elements as in POSITION", vertices),
                            fmt::format("{}", moves.size()));
            return moves;
        };
        targets.push_back({read("POSITION"), read("NORMAL")});
    }
    return targets;
}

/// The joints of all vertices, by every set of JOINTS_n and WEIGHTS_n.
std::vector<GltfInfluence> influences_of(GltfAttributes& attributes, const JsonValue& primitive,
                                         size_t vertices) {
    std::vector<GltfNumbers> joints, weights;
    for (size_t set = 0; set < MOST_JOINT_SETS; ++set) {
        const std::string joint_name = fmt::format("JOINTS_{}", set),
                          weight_name = fmt::format("WEIGHTS_{}", set);
        if (!attributes.has(joint_name.c_str()) || !attributes.has(weight_name.c_str()))
            break;
        joints.push_back(*attributes.find(joint_name.c_str(), GltfElement::VEC4));
        weights.push_back(*attributes.find(weight_name.c_str(), GltfElement::VEC4));
        check_count(primitive, joint_name.c_str(), joints.back().count(), vertices);
        check_count(primitive, weight_name.c_str(), weights.back().count(), vertices);
    }
    std::vector<GltfInfluence> influences;
    influences.reserve(joints.size() * 4 * vertices);
    for (size_t i = 0; i < vertices; ++i)
        for (size_t set = 0; set < joints.size(); ++set)
            for (size_t c = 0; c < 4; ++c) {
                const float joint = joints[set].at(i, c), weight = weights[set].at(i, c);
                const bool is_index = joint >= 0 && joint < float(1 << 16);
                if (weight > 0)
                    influences.push_back({is_index ? u32(joint) : NO_INDEX, weight});
                else // whatever joint is named
                    influences.push_back({0, 0});
            }
    return influences;
}

void clamp_colours(std::vector<glm::vec3>& colours) {
    for (glm::vec3& colour : colours)
        for (int c = 0; c < 3; ++c)
            colour[c] = colour[c] > 0 ? std::min(colour[c], 1.f) : 0.f;
}

} // namespace

void add_coordinates(const GltfPrimitive& primitive, Mesh& mesh) {
    if (!primitive.second_uvs.empty())
        mesh.second_uvs.resize(mesh.uvs.size(), glm::vec2(0));
    mesh.uvs.insert(mesh.uvs.end(), primitive.uvs.begin(), primitive.uvs.end());
    mesh.second_uvs.insert(mesh.second_uvs.end(), primitive.second_uvs.begin(), primitive.second_uvs.end());
    if (!mesh.second_uvs.empty())
        mesh.second_uvs.resize(mesh.uvs.size(), glm::vec2(0));
}

void GltfMeshes::notice(const std::string& text, const JsonValue& json) {
    notices_.add(text, json.place());
}

const std::vector<GltfPrimitive>& GltfMeshes::find(const JsonValue& index) {
    const JsonValue mesh = buffers_.file().json().element("meshes", index);
    const auto [known, is_new] = meshes_.try_emplace(mesh.path());
    if (is_new)
        known->second = read_mesh(mesh);
    return known->second;
}

const std::vector<GltfPrimitive>& GltfMeshes::keep(std::vector<GltfPrimitive> primitives) {
    return made_.emplace_back(std::move(primitives));
}

std::vector<GltfPrimitive> GltfMeshes::read_mesh(const JsonValue& mesh) {
    std::vector<GltfPrimitive> primitives;
    for (const JsonValue& json : mesh.at("primitives").elements())
        if (std::optional<GltfPrimitive> primitive = read_primitive(json))
            primitives.push_back(std::move(*primitive));
    return primitives;
}

/// One attribute of coordinates for each set; where only the second is there, the first are zero.
void GltfMeshes::read_coordinates(const JsonValue& json, GltfAttributes& attributes,
                                  const std::vector<size_t>& sets, GltfPrimitive& primitive) {
    const size_t vertices = primitive.positions.size();
    const auto read = [&](size_t set) {
        const std::string name = fmt::format("TEXCOORD_{}", set);
        std::vector<glm::vec2> uvs = coordinates_of(attributes.find(name.c_str(), GltfElement::VEC2));
        check_length(json, name.c_str(), uvs, vertices);
        if (!sets.empty() && uvs.empty())
            notice(fmt::format("textures without {} read the corner of their picture", name), json);
        return uvs;
    };
    primitive.uvs = read(sets.empty() ? 0 : sets[0]);
    if (sets.size() < 2)
        return;
    primitive.second_uvs = read(sets[1]);
    if (primitive.uvs.empty() && !primitive.second_uvs.empty())
        primitive.uvs.assign(vertices, glm::vec2(0));
}

std::optional<GltfPrimitive> GltfMeshes::read_primitive(const JsonValue& json) {
    const size_t mode = json.whole("mode", MODE_TRIANGLES);
    if (mode >= MODE_COUNT)
        json.at("mode").fail("a mode from 0 to 6");
    if (mode < MODE_TRIANGLES) {
        notice("points and lines are ignored", json);
        return std::nullopt;
    }
    GltfAttributes attributes(buffers_, json);
    if (!attributes.has("POSITION")) {
        notice("primitives without POSITION are ignored", json);
        return std::nullopt;
    }
    GltfPrimitive primitive;
    const GltfSurface surface = materials_.find(json, attributes.has("COLOR_0"));
    primitive.material = surface.material;
    primitive.positions = vectors_of(attributes.find("POSITION", GltfElement::VEC3));
    const size_t vertices = primitive.positions.size();
    primitive.normals = vectors_of(attributes.find("NORMAL", GltfElement::VEC3));
    check_length(json, "NORMAL", primitive.normals, vertices);
    read_coordinates(json, attributes, surface.uv_sets, primitive);
    primitive.colours = vectors_of(attributes.find("COLOR_0", GltfElement::COLOUR));
    check_length(json, "COLOR_0", primitive.colours, vertices);
    clamp_colours(primitive.colours);
    primitive.targets = targets_of(buffers_, json, vertices);
    primitive.influences = influences_of(attributes, json, vertices);
    primitive.corners =
        triangle_corners(attributes.order(vertices), attributes.is_draco() ? MODE_TRIANGLES : mode);
    return primitive;
}

} // namespace clrt
