// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_nodes.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

glm::dmat4 matrix_of(const JsonValue& matrix) {
    const std::array<double, 16> m = matrix.numbers<16>();
    glm::dmat4 result;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            result[column][row] = m[size_t(4 * column + row)];
    return result;
}

glm::dvec3 vector_of(const JsonValue& node, const char* key, double otherwise) {
    const std::optional<JsonValue> value = node.find(key);
    if (!value)
        return glm::dvec3(otherwise);
    const std::array<double, 3> v = value->numbers<3>();
    return {v[0], v[1], v[2]};
}

glm::dvec4 rotation_of(const JsonValue& node) {
    const std::optional<JsonValue> value = node.find("rotation");
    if (!value)
        return {0, 0, 0, 1};
    const std::array<double, 4> q = value->numbers<4>();
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
        value->fail("a quaternion other than 0", "0,0,0,0");
    return {q[0], q[1], q[2], q[3]};
}

glm::dmat4 local_transform(const JsonValue& node, const GltfPose& pose) {
    if (const std::optional<JsonValue> matrix = node.find("matrix"))
        return matrix_of(*matrix);
    return gltf_transform(pose.translation ? *pose.translation : vector_of(node, "translation", 0),
                          pose.rotation ? *pose.rotation : rotation_of(node),
                          pose.scale ? *pose.scale : vector_of(node, "scale", 1));
}

std::vector<double> weights_of(const JsonValue& node, const GltfPose& pose) {
    const std::optional<JsonValue> own = node.find("weights");
    return !pose.weights.empty() || !own ? pose.weights : own->all_numbers();
}

std::vector<JsonValue> children_of(const JsonValue& node) {
    const std::optional<JsonValue> children = node.find("children");
    return children ? children->elements() : std::vector<JsonValue>();
}

/// A node that is to be visited.
struct Visit {
    JsonValue node;
    size_t number;
    JsonValue reference; ///< what leads to it
    glm::dmat4 parent;   ///< transform of what it hangs on
};

/// Walks down from roots, depth first.
class NodeWalk {
public:
    NodeWalk(const JsonDocument& json, const GltfPoses& poses)
        : json_(json), poses_(poses), reached_(json.elements("nodes").size()) {}

    void add(const JsonValue& root, size_t number, const JsonValue& reference) {
        std::vector<Visit> open = {{root, number, reference, glm::dmat4(1)}};
        while (!open.empty()) {
            const Visit visit = open.back();
            open.pop_back();
            const glm::dmat4 world = enter(visit);
            const std::vector<JsonValue> children = children_of(visit.node);
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                open.push_back({json_.element("nodes", *child), child->whole(), *child, world});
        }
    }

    std::vector<GltfNode> take() { return std::move(nodes_); }

private:
    glm::dmat4 enter(const Visit& visit) {
        if (reached_[visit.number])
            visit.reference.fail("a node that nothing else leads to: the nodes are a forest",
                                 fmt::format("node {}, reached before", visit.number));
        reached_[visit.number] = true;
        const auto posed = poses_.find(visit.number);
        const GltfPose pose = posed == poses_.end() ? GltfPose{} : posed->second;
        const glm::dmat4 world = visit.parent * local_transform(visit.node, pose);
        nodes_.push_back(
            {visit.node, world, visit.node.text("name"), visit.number, weights_of(visit.node, pose)});
        return world;
    }

    const JsonDocument& json_;
    const GltfPoses& poses_;
    std::vector<bool> reached_;
    std::vector<GltfNode> nodes_;
};

/// The roots of the scene that is shown; none where the file has no scene.
std::optional<std::vector<JsonValue>> scene_roots(const JsonDocument& json) {
    const std::vector<JsonValue> scenes = json.elements("scenes");
    const std::optional<JsonValue> chosen = json.root().find("scene");
    if (!chosen && scenes.empty())
        return std::nullopt;
    const JsonValue scene = chosen ? json.element("scenes", *chosen) : scenes.front();
    const std::optional<JsonValue> nodes = scene.find("nodes");
    return nodes ? nodes->elements() : std::vector<JsonValue>();
}

/// Which nodes are some other's children.
std::vector<bool> find_children(const JsonDocument& json, const std::vector<JsonValue>& nodes) {
    std::vector<bool> is_child(nodes.size());
    for (const JsonValue& node : nodes)
        for (const JsonValue& child : children_of(node)) {
            json.element("nodes", child);
            is_child[child.whole()] = true;
        }
    return is_child;
}

} // namespace

std::vector<GltfNode> read_gltf_nodes(const JsonDocument& json, const GltfPoses& poses) {
    NodeWalk walk(json, poses);
    if (const std::optional<std::vector<JsonValue>> roots = scene_roots(json)) {
        for (const JsonValue& root : *roots)
            walk.add(json.element("nodes", root), root.whole(), root);
        return walk.take();
    }
    const std::vector<JsonValue> nodes = json.elements("nodes");
    const std::vector<bool> is_child = find_children(json, nodes);
    for (size_t i = 0; i < nodes.size(); ++i)
        if (!is_child[i])
            walk.add(nodes[i], i, nodes[i]);
    return walk.take();
}

glm::dmat4 gltf_transform(const glm::dvec3& translation, const glm::dvec4& rotation,
                          const glm::dvec3& scale) {
    const double length = glm::length(rotation);
    const glm::dvec4 q = length > 0 ? rotation / length : glm::dvec4(0, 0, 0, 1);
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const glm::dvec3 right(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        up(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        back(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y));
    return {glm::dvec4(right * scale.x, 0), glm::dvec4(up * scale.y, 0), glm::dvec4(back * scale.z, 0),
            glm::dvec4(translation, 1)};
}

glm::dmat3 normal_transform(const glm::dmat4& transform) {
    const glm::dvec3 x(transform[0]), y(transform[1]), z(transform[2]);
    const glm::dmat3 cofactors(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
    return is_mirrored(transform) ? -1.0 * cofactors : cofactors;
}

bool is_mirrored(const glm::dmat4& transform) {
    return glm::dot(glm::dvec3(transform[0]),
                    glm::cross(glm::dvec3(transform[1]), glm::dvec3(transform[2]))) < 0;
}

} // namespace clrt
