// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_morph.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

void add(const std::vector<glm::vec3>& moves, double weight, std::vector<glm::vec3>& to) {
    for (size_t i = 0; i < std::min(moves.size(), to.size()); ++i)
        to[i] += float(weight) * moves[i];
}

} // namespace

std::vector<double> morph_weights(const std::vector<GltfPrimitive>& primitives, const GltfNode& node,
                                  const JsonValue& mesh) {
    size_t targets = 0;
    for (const GltfPrimitive& primitive : primitives)
        targets = std::max(targets, primitive.targets.size());
    std::vector<double> weights = node.weights;
    if (const std::optional<JsonValue> own = mesh.find("weights"); own && weights.empty())
        weights = own->all_numbers();
    if (!weights.empty() && targets > 0 && weights.size() != targets)
        node.json.fail(fmt::format("as many weights as the mesh has morph targets, {}", targets),
                       fmt::format("{}", weights.size()));
    return weights;
}

std::vector<GltfPrimitive> morph(const std::vector<GltfPrimitive>& primitives,
                                 const std::vector<double>& weights) {
    std::vector<GltfPrimitive> result = primitives;
    for (GltfPrimitive& primitive : result) {
        for (size_t i = 0; i < std::min(weights.size(), primitive.targets.size()); ++i) {
            add(primitive.targets[i].positions, weights[i], primitive.positions);
            add(primitive.targets[i].normals, weights[i], primitive.normals);
        }
        primitive.targets = {};
    }
    return result;
}

} // namespace clrt
