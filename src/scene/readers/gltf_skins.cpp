// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_skins.h"

#include "scene/readers/gltf_accessors.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <map>

namespace clrt {

namespace {

glm::dmat4 matrix_of(const GltfNumbers& numbers, size_t i) {
    glm::dmat4 result;
    for (size_t component = 0; component < 16; ++component)
        result[int(component / 4)][int(component % 4)] = numbers.at(i, component);
    return result;
}

/// From the mesh's frame, where it was bound, to the world, a matrix a joint.
std::vector<glm::dmat4> joint_matrices(const JsonValue& skin, const std::vector<GltfNode>& nodes,
                                       GltfBuffers& buffers) {
    const std::vector<JsonValue> joints = skin.at("joints").elements();
    GltfNumbers bound;
    if (const std::optional<JsonValue> index = skin.find("inverseBindMatrices")) {
        bound = read_gltf_numbers(buffers, *index, GltfElement::MAT4);
        if (bound.count() < joints.size())
            index->fail(fmt::format("at least {} matrices, one a joint", joints.size()),
                        fmt::format("{}", bound.count()));
    }
    std::map<size_t, glm::dmat4> worlds;
    for (const GltfNode& node : nodes)
        worlds.emplace(node.number, node.world);
    std::vector<glm::dmat4> matrices;
    for (const JsonValue& joint : joints) {
        const auto world = worlds.find(joint.whole());
        if (world == worlds.end())
            joint.fail("a node of the scene that is shown");
        matrices.push_back(bound.count() ? world->second * matrix_of(bound, matrices.size()) : world->second);
    }
    return matrices;
}

/// The mean transform of a vertex. Weights are of any sum; where they are all 0 the first joint has all.
glm::dmat4 blend(const GltfInfluence* influences, size_t count, const std::vector<glm::dmat4>& joints) {
    glm::dmat4 mean(0);
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        if (influences[i].weight == 0)
            continue;
        mean += double(influences[i].weight) * joints[influences[i].joint];
        sum += influences[i].weight;
    }
    return sum > 0 ? mean / sum : joints[influences[0].joint];
}

void move_vertex(const glm::dmat4& transform, size_t vertex, GltfPrimitive& primitive) {
    glm::vec3& p = primitive.positions[vertex];
    p = glm::vec3(transform * glm::dvec4(glm::dvec3(p), 1));
    if (primitive.normals.empty())
        return;
    const glm::dvec3 turned = normal_transform(transform) * glm::dvec3(primitive.normals[vertex]);
    const double length = glm::length(turned);
    if (length > 0)
        primitive.normals[vertex] = glm::vec3(turned / length);
}

void check_joints(const GltfPrimitive& primitive, size_t joints, const JsonValue& skin) {
    for (const GltfInfluence& influence : primitive.influences)
        if (influence.joint >= joints)
            skin.at("joints").fail(fmt::format("joint {}, which a vertex follows", influence.joint),
                                   fmt::format("{} joints", joints));
}

} // namespace

std::vector<GltfPrimitive> bend_by_skin(const std::vector<GltfPrimitive>& primitives, const GltfNode& node,
                                        const std::vector<GltfNode>& nodes, GltfBuffers& buffers,
                                        NoticeList& notices) {
    const JsonValue skin = buffers.file().json().element("skins", node.json.at("skin"));
    const std::vector<glm::dmat4> joints = joint_matrices(skin, nodes, buffers);
    std::vector<GltfPrimitive> bent = primitives;
    for (GltfPrimitive& primitive : bent) {
        check_joints(primitive, joints.size(), skin);
        const size_t vertices = primitive.positions.size(),
                     each = vertices ? primitive.influences.size() / vertices : 0;
        if (each == 0)
            notices.add("a mesh without joints under a skin stays where its node is", node.json.place());
        std::vector<bool> mirrored(vertices);
        for (size_t i = 0; i < vertices; ++i) {
            const glm::dmat4 transform =
                each ? blend(&primitive.influences[i * each], each, joints) : node.world;
            move_vertex(transform, i, primitive);
            mirrored[i] = is_mirrored(transform);
        }
        for (size_t i = 0; i < primitive.corners.size(); i += 3)
            if (mirrored[primitive.corners[i]])
                std::swap(primitive.corners[i + 1], primitive.corners[i + 2]);
        primitive.influences = {};
        primitive.targets = {};
    }
    return bent;
}

} // namespace clrt
