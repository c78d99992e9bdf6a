// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_file.h"

#include "error.h"
#include "scene/readers/gltf_bytes.h"
#include "scene/readers/text_encoding.h"
#include "scene/text_scanner.h"

#include <fmt/format.h>

namespace clrt {

namespace {

// A GLB: magic, version, length; then chunks of length, type and bytes.
constexpr std::string_view GLB_MAGIC = "glTF";
constexpr size_t GLB_HEADER = 12, CHUNK_HEADER = 8;
constexpr u32 GLB_VERSION = 2, CHUNK_JSON = 0x4e4f534a, CHUNK_BINARY = 0x004e4942;

/// How much of a text is looked at to know that it may be JSON, in whatever encoding.
constexpr size_t JSON_HEAD_BYTES = 4096;

struct Chunk {
    u32 type;
    std::string_view bytes;
};

/// The chunk at a byte. Throws where the file ends within it.
Chunk chunk_at(std::string_view file, size_t at, const std::string& name) {
    const auto fail = [&](const std::string& expected, size_t found) {
        throw SceneError(name, 0, fmt::format("byte {}: expected {}, found {} bytes", at, expected, found));
    };
    if (file.size() - at < CHUNK_HEADER)
        fail("the head of a chunk of the GLB", file.size() - at);
    const size_t length = little_endian<u32>(file, at), rest = file.size() - at - CHUNK_HEADER;
    if (length > rest)
        fail(fmt::format("a chunk of {} bytes", length), rest);
    return {little_endian<u32>(file, at + 4), file.substr(at + CHUNK_HEADER, length)};
}

void check_version(const JsonDocument& json) {
    const JsonValue asset = json.root().at("asset");
    const std::optional<JsonValue> least = asset.find("minVersion");
    const JsonValue version = least ? *least : asset.at("version");
    if (version.text().substr(0, 2) != "2.")
        version.fail("version 2.x");
}

} // namespace

bool is_gltf(std::string_view bytes) {
    if (bytes.substr(0, GLB_MAGIC.size()) == GLB_MAGIC)
        return true;
    const std::string head = as_utf8(std::string(bytes.substr(0, JSON_HEAD_BYTES)));
    const bool is_object = trim(without_byte_order_mark(head)).substr(0, 1) == "{";
    // Writers that sort the keys put much before it.
    return is_object && (bytes.find("\"asset\"") != bytes.npos || head.find("\"asset\"") != head.npos);
}

GltfFile::GltfFile(SceneFile file) : file_(std::move(file)) {
    if (std::string_view(file_.bytes).substr(0, GLB_MAGIC.size()) == GLB_MAGIC) {
        json_.emplace(split_chunks(), file_.name);
    } else {
        file_.bytes = as_utf8(std::move(file_.bytes));
        json_.emplace(without_byte_order_mark(file_.bytes), file_.name);
    }
    check_version(*json_);
}

std::string_view GltfFile::split_chunks() {
    const std::string_view bytes = file_.bytes;
    if (bytes.size() < GLB_HEADER)
        throw SceneError(
            file_.name, 0,
            fmt::format("expected a GLB header of {} bytes, found {}", GLB_HEADER, bytes.size()));
    const u32 version = little_endian<u32>(bytes, 4);
    if (version != GLB_VERSION)
        throw SceneError(file_.name, 0,
                         fmt::format("byte 4: expected version {} of GLB, found {}", GLB_VERSION, version));
    const size_t length = little_endian<u32>(bytes, 8);
    if (length > bytes.size() || length < GLB_HEADER)
        throw SceneError(
            file_.name, 0,
            fmt::format("byte 8: expected a length up to that of the file, {}, found {}: it is cut "
                        "off, or no GLB",
                        bytes.size(), length));
    const std::string_view whole = bytes.substr(0, length);
    const Chunk json = chunk_at(whole, GLB_HEADER, file_.name);
    if (json.type != CHUNK_JSON)
        throw SceneError(
            file_.name, 0,
            fmt::format("byte {}: expected a chunk of type JSON, found {:#x}", GLB_HEADER, json.type));
    const size_t second = GLB_HEADER + CHUNK_HEADER + json.bytes.size();
    if (second < whole.size()) {
        const Chunk binary = chunk_at(whole, second, file_.name);
        if (binary.type == CHUNK_BINARY) // others are to be ignored
            binary_ = binary.bytes;
    }
    return json.bytes;
}

} // namespace clrt
