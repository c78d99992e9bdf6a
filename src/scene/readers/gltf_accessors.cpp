// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_accessors.h"

#include "scene/readers/gltf_bytes.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Of an accessor that no bytes stand behind: it is zero but where it is sparse.
constexpr size_t MOST_UNSTORED = size_t(1) << 24;

/// One component type: its number in the standard, and how it is read.
struct ComponentRow {
    size_t type, size;
    double normaliser; ///< 1 in a normalised accessor; 0: cannot be normalised
    bool is_index;
    double (*read)(std::string_view bytes, size_t at);
};

template <typename T>
double read_component(std::string_view bytes, size_t at) {
    return double(little_endian<T>(bytes, at));
}

constexpr ComponentRow COMPONENTS[] = {
    {5120, 1, 127, false, read_component<std::int8_t>},
    {5121, 1, 255, true, read_component<std::uint8_t>},
    {5122, 2, 32767, false, read_component<std::int16_t>},
    {5123, 2, 65535, true, read_component<std::uint16_t>},
    {5125, 4, 0, true, read_component<std::uint32_t>},
    {5126, 4, 0, false, read_component<float>},
};

struct ElementRow {
    const char* name;
    size_t components;
};
constexpr ElementRow ELEMENTS[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                   {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};

const ComponentRow& component_row(const JsonValue& type) {
    const size_t number = type.whole();
    for (const ComponentRow& row : COMPONENTS)
        if (row.type == number)
            return row;
    type.fail("a component type (5120 to 5123, 5125, 5126)");
}

size_t component_count(const JsonValue& type, GltfElement wanted) {
    const char* const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "VEC3", "MAT4"};
    const std::string name = type.text();
    const bool fits = name == names[int(wanted)] || (wanted == GltfElement::COLOUR && name == "VEC4");
    for (const ElementRow& row : ELEMENTS)
        if (fits && name == row.name)
            return row.components;
    type.fail(wanted == GltfElement::COLOUR ? "VEC3 or VEC4" : names[int(wanted)]);
}

/// Elements in bytes, all of them within.
struct Elements {
    std::string_view bytes;
    size_t offset = 0, stride = 0;
    const ComponentRow* component = nullptr;
};

/// Elements of a view. `owner` is what is at fault where they do not fit.
Elements elements_in(const GltfView& view, const JsonValue& owner, const ComponentRow& component, size_t size,
                     size_t count) {
    const size_t offset = owner.whole("byteOffset", 0), stride = view.stride ? view.stride : size;
    const size_t length = view.bytes.size();
    const bool has_room =
        offset <= length && size <= length - offset && (count - 1) <= (length - offset - size) / stride;
    if (count > 0 && !has_room)
        owner.fail(
            fmt::format("elements within the {} bytes of its view", length),
            fmt::format("{} elements of {} bytes, {} apart, from byte {}", count, size, stride, offset));
    return {view.bytes, offset, stride, &component};
}

/// An accessor, its JSON understood.
class Accessor {
public:
    Accessor(GltfBuffers& buffers, const JsonValue& index, GltfElement element)
        : buffers_(buffers), json_(buffers.file().json().element("accessors", index)),
          component_(component_row(json_.at("componentType"))),
          components_(component_count(json_.at("type"), element)), count_(json_.at("count").whole()),
          is_normalised_(json_.boolean("normalized", false)) {
        if (is_normalised_ && component_.normaliser == 0)
            json_.at("normalized").fail("integers of 1 or 2 bytes to normalise");
    }

    size_t components() const { return components_; }
    const JsonValue& json() const { return json_; }
    const ComponentRow& component() const { return component_; }

    template <typename T>
    std::vector<T> read() {
        std::vector<T> values = read_stored<T>();
        if (const std::optional<JsonValue> sparse = json_.find("sparse"))
            replace(*sparse, values);
        return values;
    }

private:
    size_t element_size() const { return component_.size * components_; }

    template <typename T>
    T value(const Elements& from, size_t element, size_t c) const {
        const double value =
            from.component->read(from.bytes, from.offset + element * from.stride + c * component_.size);
        return T(is_normalised_ ? std::max(value / component_.normaliser, -1.0) : value);
    }

    template <typename T>
    std::vector<T> read_stored() {
        const std::optional<JsonValue> view = json_.find("bufferView");
        if (!view) {
            if (count_ > MOST_UNSTORED)
                json_.at("count").fail(
                    fmt::format("at most {} elements without a bufferView", MOST_UNSTORED));
            return std::vector<T>(count_ * components_);
        }
        const Elements from = elements_in(buffers_.view(*view), json_, component_, element_size(), count_);
        std::vector<T> values(count_ * components_);
        for (size_t i = 0; i < count_; ++i)
            for (size_t c = 0; c < components_; ++c)
                values[components_ * i + c] = value<T>(from, i, c);
        return values;
    }

    template <typename T>
    void replace(const JsonValue& sparse, std::vector<T>& values) {
        const size_t count = sparse.at("count").whole();
        if (count > count_)
            sparse.at("count").fail(fmt::format("at most the {} elements of the accessor", count_));
        const JsonValue indices = sparse.at("indices"), replacements = sparse.at("values");
        const ComponentRow& index = component_row(indices.at("componentType"));
        if (!index.is_index)
            indices.at("componentType").fail("an unsigned type");
        const Elements places =
            elements_in(buffers_.view(indices.at("bufferView")), indices, index, index.size, count);
        const Elements from = elements_in(buffers_.view(replacements.at("bufferView")), replacements,
                                          component_, element_size(), count);
        for (size_t i = 0; i < count; ++i) {
            const size_t place = size_t(index.read(places.bytes, places.offset + i * places.stride));
            if (place >= count_)
                indices.fail(fmt::format("indices below {}", count_), fmt::format("{}", place));
            for (size_t c = 0; c < components_; ++c)
                values[components_ * place + c] = value<T>(from, i, c);
        }
    }

    GltfBuffers& buffers_;
    JsonValue json_;
    const ComponentRow& component_;
    size_t components_, count_;
    bool is_normalised_;
};

} // namespace

GltfNumbers read_gltf_numbers(GltfBuffers& buffers, const JsonValue& index, GltfElement element) {
    Accessor accessor(buffers, index, element);
    return {accessor.components(), accessor.read<float>()};
}

std::vector<u32> read_gltf_indices(GltfBuffers& buffers, const JsonValue& index) {
    Accessor accessor(buffers, index, GltfElement::SCALAR);
    if (!accessor.component().is_index)
        accessor.json().at("componentType").fail("an unsigned type, for indices");
    if (accessor.json().boolean("normalized", false))
        accessor.json().at("normalized").fail("whole numbers, for indices");
    return accessor.read<u32>();
}

size_t gltf_count(const GltfFile& file, const JsonValue& index) {
    return file.json().element("accessors", index).at("count").whole();
}

} // namespace clrt
