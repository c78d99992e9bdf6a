// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_buffers.h"

#include "codecs/mesh_codecs.h"
#include "error.h"
#include "scene/readers/gltf_bytes.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>

namespace clrt {

namespace {

namespace fs = std::filesystem;

/// Of a file beside the glTF file. Buffers of more than 4 GiB cannot be in a GLB, and no exporter writes
/// them.
constexpr size_t MOST_BUFFER_BYTES = size_t(1) << 32;

/// meshoptimizer packs 64 bytes into one at best.
constexpr size_t MOST_PACKED = 64;
/// Below this a view is unpacked whatever its packed size.
constexpr size_t SMALL_UNPACKED = size_t(1) << 16;

constexpr std::string_view DATA_SCHEME = "data:", BASE64_MARK = ";base64,";

/// A scheme of two letters or more, or a drive such as c: on its own.
bool has_scheme(const std::string& name) {
    const size_t colon = name.find(':');
    return colon != name.npos && colon > 0 &&
           std::all_of(name.begin(), name.begin() + std::ptrdiff_t(colon),
                       [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

/// EXT_meshopt_compression or its later name; null where a view is plain.
std::optional<JsonValue> find_packing(const JsonValue& view) {
    const std::optional<JsonValue> extensions = view.find("extensions");
    if (!extensions)
        return std::nullopt;
    const std::optional<JsonValue> khr = extensions->find("KHR_meshopt_compression");
    return khr ? khr : extensions->find("EXT_meshopt_compression");
}

} // namespace

std::string gltf_file_name(const JsonValue& uri) {
    const char* const expected = "a file in the folder of this one";
    std::string name = decode_percent(uri.text());
    std::replace(name.begin(), name.end(), '\\', '/');
    const fs::path path(name);
    const bool climbs =
        std::any_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
    if (name.empty() || name.find('\0') != name.npos || path.is_absolute() || has_scheme(name) || climbs)
        uri.fail(expected);
    return name;
}

bool is_data_uri(const std::string& uri) {
    return uri.compare(0, DATA_SCHEME.size(), DATA_SCHEME) == 0;
}

std::string data_uri_bytes(const JsonValue& uri) {
    const std::string text = uri.text();
    const size_t mark = text.find(BASE64_MARK);
    if (mark == text.npos)
        uri.fail("a data: uri in base64");
    std::optional<std::string> bytes =
        decode_base64(std::string_view(text).substr(mark + BASE64_MARK.size()));
    if (!bytes)
        uri.fail("base64", "other signs, or too few");
    return std::move(*bytes);
}

std::string GltfBuffers::load(const JsonValue& buffer) {
    const JsonValue uri = buffer.at("uri");
    if (is_data_uri(uri.text()))
        return data_uri_bytes(uri);
    const fs::path path = fs::path(file_.name()).parent_path() / gltf_file_name(uri);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (error)
        uri.fail("a file that can be read",
                 fmt::format("{}: {}", clrt::quoted(path.string()), error.message()));
    if (size > MOST_BUFFER_BYTES)
        uri.fail(fmt::format("a file of at most {} bytes", MOST_BUFFER_BYTES), fmt::format("{} bytes", size));
    opened_.push_back({"the buffer", path.string()});
    return read_file(path.string());
}

std::string_view GltfBuffers::buffer(const JsonValue& index) {
    const JsonValue buffer = file_.json().element("buffers", index);
    const size_t number = index.whole(), length = buffer.at("byteLength").whole();
    std::string_view bytes;
    if (number == 0 && !buffer.find("uri") && file_.binary()) {
        bytes = *file_.binary();
    } else {
        const auto known = buffers_.find(number);
        bytes =
            known != buffers_.end() ? known->second : buffers_.emplace(number, load(buffer)).first->second;
    }
    if (bytes.size() < length)
        buffer.at("byteLength").fail(fmt::format("at most the {} bytes that are there", bytes.size()));
    return bytes.substr(0, length);
}

std::string_view GltfBuffers::part(const JsonValue& range) {
    const std::string_view whole = buffer(range.at("buffer"));
    const size_t offset = range.whole("byteOffset", 0), length = range.at("byteLength").whole();
    if (offset > whole.size() || length > whole.size() - offset)
        range.fail(fmt::format("a range within its buffer of {} bytes", whole.size()),
                   fmt::format("{} bytes from byte {}", length, offset));
    return whole.substr(offset, length);
}

GltfView GltfBuffers::unpack(const JsonValue& view, const JsonValue& packing) {
    const MeshoptLayout layout{packing.at("mode").text(), packing.text("filter", "NONE"),
                               packing.at("count").whole(), packing.at("byteStride").whole()};
    const auto known = unpacked_.find(view.path());
    if (known != unpacked_.end())
        return {known->second, layout.stride};
    const std::string_view packed = part(packing);
    const size_t most = std::max(MOST_PACKED * packed.size(), SMALL_UNPACKED);
    if (layout.stride == 0 || layout.count > most / layout.stride)
        packing.fail(fmt::format("at most {} bytes in {} packed ones", most, packed.size()),
                     fmt::format("{} elements of {} bytes", layout.count, layout.stride));
    try {
        const std::string& bytes =
            unpacked_.emplace(view.path(), mesh_codecs().decode_meshopt(packed, layout)).first->second;
        return {bytes, layout.stride};
    } catch (const std::runtime_error& error) {
        packing.fail("bytes packed by meshoptimizer", error.what());
    }
}

GltfView GltfBuffers::view(const JsonValue& index) {
    const JsonValue view = file_.json().element("bufferViews", index);
    if (const std::optional<JsonValue> packing = find_packing(view))
        return unpack(view, *packing);
    return {part(view), view.whole("byteStride", 0)};
}

} // namespace clrt
