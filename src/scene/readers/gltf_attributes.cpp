// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_attributes.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace clrt {

GltfAttributes::GltfAttributes(GltfBuffers& buffers, const JsonValue& primitive)
    : buffers_(buffers), json_(primitive), attributes_(primitive.at("attributes")) {
    const std::optional<JsonValue> extensions = primitive.find("extensions");
    if (const auto packing = extensions ? extensions->find("KHR_draco_mesh_compression") : std::nullopt)
        unpack(*packing);
}

void GltfAttributes::unpack(const JsonValue& packing) {
    std::vector<u32> ids;
    for (const auto& [name, id] : packing.at("attributes").members()) {
        if (id.whole() >= NO_INDEX)
            id.fail("the id of an attribute");
        ids.push_back(u32(id.whole()));
        draco_names_.push_back(name);
    }
    const std::string_view bytes = buffers_.view(packing.at("bufferView")).bytes;
    try {
        draco_ = mesh_codecs().decode_draco(bytes, ids);
    } catch (const std::runtime_error& error) {
        packing.fail("a mesh packed by Draco", error.what());
    }
}

bool GltfAttributes::has(const char* name) const {
    return attributes_.find(name).has_value();
}

GltfNumbers GltfAttributes::unpacked(const JsonValue& attribute, size_t place, GltfElement element) const {
    const DracoAttribute& from = draco_->attributes[place];
    const size_t wanted = element == GltfElement::VEC2 ? 2 : element == GltfElement::VEC4 ? 4 : 3;
    const bool fits = from.components == wanted || (element == GltfElement::COLOUR && from.components == 4);
    if (!fits)
        attribute.fail(fmt::format("{} components", wanted), fmt::format("{}, by Draco", from.components));
    return {from.components, from.values};
}

std::optional<GltfNumbers> GltfAttributes::find(const char* name, GltfElement element) {
    const std::optional<JsonValue> index = attributes_.find(name);
    if (!index)
        return std::nullopt;
    const auto packed = std::find(draco_names_.begin(), draco_names_.end(), name);
    if (packed != draco_names_.end())
        return unpacked(*index, size_t(packed - draco_names_.begin()), element);
    return read_gltf_numbers(buffers_, *index, element);
}

std::vector<u32> GltfAttributes::order(size_t vertices) {
    const auto is_beyond = [&](u32 i) { return i >= vertices; };
    if (draco_) {
        if (std::any_of(draco_->indices.begin(), draco_->indices.end(), is_beyond))
            json_.fail(fmt::format("indices, packed by Draco, below {}, the number of vertices", vertices),
                       "others");
        return draco_->indices;
    }
    const std::optional<JsonValue> indices = json_.find("indices");
    if (!indices) {
        std::vector<u32> all(vertices);
        std::iota(all.begin(), all.end(), 0u);
        return all;
    }
    std::vector<u32> order = read_gltf_indices(buffers_, *indices);
    const auto beyond = std::find_if(order.begin(), order.end(), is_beyond);
    if (beyond != order.end())
        indices->fail(fmt::format("indices below {}, the number of vertices", vertices),
                      fmt::format("{} as number {}", *beyond, beyond - order.begin()));
    return order;
}

} // namespace clrt
