// SPDX-License-Identifier: Apache-2.0
// glTF files that a test puts together.
#pragma once

#include "error.h"
#include "scene/readers/gltf_reader.h"

#include <cstring>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace clrt {

using Json = nlohmann::json;

/// The component types of the standard.
template <typename T>
constexpr int COMPONENT_TYPE = 0;
template <>
inline constexpr int COMPONENT_TYPE<std::int8_t> = 5120;
template <>
inline constexpr int COMPONENT_TYPE<std::uint8_t> = 5121;
template <>
inline constexpr int COMPONENT_TYPE<std::int16_t> = 5122;
template <>
inline constexpr int COMPONENT_TYPE<std::uint16_t> = 5123;
template <>
inline constexpr int COMPONENT_TYPE<std::uint32_t> = 5125;
template <>
inline constexpr int COMPONENT_TYPE<float> = 5126;

/// A GLB: JSON that a test changes as it likes, and a buffer of bytes.
struct GltfBuilder {
    Json json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                                "nodes": [{"mesh": 0}]})");
    std::string bytes;

    /// A buffer view of values, 4-byte aligned. Returns its index.
    template <typename T>
    size_t add_view(const std::vector<T>& values) {
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        const size_t offset = bytes.size(), length = values.size() * sizeof(T);
        bytes.append(reinterpret_cast<const char*>(values.data()), length);
        Json view = Json::object();
        view["buffer"] = 0;
        view["byteOffset"] = offset;
        view["byteLength"] = length;
        json["bufferViews"].push_back(view);
        return json["bufferViews"].size() - 1;
    }

    /// An accessor of its own view. Returns its index.
    template <typename T>
    size_t add(const std::vector<T>& values, const char* type, size_t components, bool normalised = false) {
        Json accessor = Json::object();
        accessor["bufferView"] = add_view(values);
        accessor["componentType"] = COMPONENT_TYPE<T>;
        accessor["type"] = type;
        accessor["count"] = values.size() / components;
        if (normalised)
            accessor["normalized"] = true;
        json["accessors"].push_back(accessor);
        return json["accessors"].size() - 1;
    }

    /// A mesh with one primitive of these positions. Returns the primitive.
    Json& add_mesh(const std::vector<float>& positions) {
        const size_t accessor = add(positions, "VEC3", 3);
        Json primitive = Json::object();
        primitive["attributes"]["POSITION"] = accessor;
        Json mesh = Json::object();
        mesh["primitives"] = Json::array();
        mesh["primitives"].push_back(primitive);
        json["meshes"].push_back(mesh);
        return json["meshes"].back()["primitives"][0];
    }

    std::string glb() {
        json["buffers"] = Json::array();
        Json buffer = Json::object();
        buffer["byteLength"] = bytes.size();
        json["buffers"].push_back(buffer);
        return wrap(json.dump(), bytes);
    }

    static std::string wrap(std::string text, std::string binary) {
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        std::string file = "glTF";
        append(file, 2);
        append(file, std::uint32_t(12 + 8 + text.size() + 8 + binary.size()));
        append(file, std::uint32_t(text.size()));
        file += "JSON" + text;
        append(file, std::uint32_t(binary.size()));
        return file + std::string("BIN\0", 4) + binary;
    }

private:
    static void append(std::string& to, std::uint32_t word) {
        to.append(reinterpret_cast<const char*>(&word), sizeof word);
    }
};

/// One triangle in the plane z = 0.
inline const std::vector<float> TRIANGLE_POSITIONS = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// A scene as read, and what was noted on the way.
struct ReadGltf {
    NoticeList notices;
    SceneDescription scene;

    explicit ReadGltf(const std::string& bytes, GltfReading reading = {}, const std::string& name = "a.glb",
                      Toggle instances = Toggle::AUTO) {
        Progress silent(Toggle::OFF, true);
        PictureFacts facts;
        facts.has_alpha = [](const TextureUse& use) {
            return !use.bytes;
        }; // pictures within the file have none
        scene =
            read_gltf_scene({name, bytes}, {silent, notices, facts, MtlReading::AUTO, reading, instances});
    }
    const Mesh& mesh() const { return scene.mesh; }
    glm::dvec3 corner(size_t triangle, int c) const {
        return mesh().positions.at(mesh().triangles.at(triangle).v[c]);
    }
    bool notes(const std::string& text) const {
        for (const std::string& line : notices.lines())
            if (line.find(text) != line.npos)
                return true;
        return false;
    }
};

/// The error that a file is; empty: none.
inline std::string gltf_error(const std::string& bytes, const std::string& name = "a.glb") {
    try {
        const ReadGltf read(bytes, {}, name);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

} // namespace clrt
