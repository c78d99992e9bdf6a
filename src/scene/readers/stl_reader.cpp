// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/stl_reader.h"

#include "error.h"
#include "float_bits.h"
#include "scene/readers/stl_text.h"
#include "scene/readers/text_encoding.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace clrt {

namespace {

// A binary file: 80 bytes of anything, the number of triangles, 50 bytes for each (normal, three vertices as
// little-endian floats, two bytes of attributes).
constexpr size_t COUNT_BYTE = 80, HEADER_BYTES = 84, TRIANGLE_BYTES = 50, VERTEX_BYTE = 12,
                 ATTRIBUTE_BYTE = 48;

/// How much of a text is looked at to know it.
constexpr size_t TEXT_HEAD_BYTES = 4096;

/// Between two updates of the progress line.
constexpr size_t TRIANGLES_A_STEP = size_t(1) << 16;

/// More vertices than a mesh has indices for.
constexpr size_t MOST_TRIANGLES = (size_t(NO_INDEX) - 1) / 3;

u32 word_at(std::string_view bytes, size_t at) {
    u32 word = 0;
    for (size_t i = 0; i < 4; ++i)
        word |= u32(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return word;
}

double number_at(std::string_view bytes, size_t at) {
    return double(float_of_bits(word_at(bytes, at)));
}

bool has_size_of_binary(std::string_view bytes) {
    return bytes.size() >= HEADER_BYTES + TRIANGLE_BYTES &&
           bytes.size() == HEADER_BYTES + TRIANGLE_BYTES * size_t(word_at(bytes, COUNT_BYTE));
}

std::string lower_head(std::string_view bytes) {
    std::string head = as_utf8(std::string(bytes.substr(0, TEXT_HEAD_BYTES)));
    std::transform(head.begin(), head.end(), head.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return std::string(trim(without_byte_order_mark(head)));
}

/// Binary files may begin with "solid" as well.
bool is_text(const std::string& head) {
    return head.rfind("solid", 0) == 0 && head.find('\0') == head.npos;
}

/// Throws where the file ends before its last triangle.
size_t count_triangles(std::string_view bytes, const std::string& path) {
    if (bytes.size() < HEADER_BYTES)
        throw SceneError(
            path, 0,
            fmt::format("expected an STL file: a text that begins with solid, or {} bytes before "
                        "the triangles, found {} bytes",
                        HEADER_BYTES, bytes.size()));
    const size_t count = word_at(bytes, COUNT_BYTE), whole = (bytes.size() - HEADER_BYTES) / TRIANGLE_BYTES;
    if (count > whole)
        throw SceneError(path, 0,
                         fmt::format("byte {}: expected {} triangles of {} bytes, as byte {} says, found {} "
                                     "and the end of the file: it is cut off, or no STL file",
                                     HEADER_BYTES, count, TRIANGLE_BYTES, COUNT_BYTE, whole));
    if (count > MOST_TRIANGLES)
        throw SceneError(path, 0,
                         fmt::format("expected at most {} triangles, found {}", MOST_TRIANGLES, count));
    return count;
}

void parse_binary(std::string_view bytes, const std::string& path, const ReadContext& context,
                  StlMesh& mesh) {
    const size_t count = count_triangles(bytes, path), end = HEADER_BYTES + TRIANGLE_BYTES * count;
    mesh.begin_object("");
    std::vector<glm::dvec3> vertices(3);
    size_t attributes = 0;
    for (size_t i = 0; i < count; ++i) {
        const size_t first = HEADER_BYTES + TRIANGLE_BYTES * i;
        for (size_t n = 0; n < 9; ++n)
            vertices[n / 3][int(n % 3)] = number_at(bytes, first + VERTEX_BYTE + 4 * n);
        mesh.add_facet(vertices, {path, 0});
        attributes += bytes[first + ATTRIBUTE_BYTE] || bytes[first + ATTRIBUTE_BYTE + 1];
        if (i % TRIANGLES_A_STEP == 0)
            context.progress.update({"load", double(i) / double(count)});
    }
    if (attributes)
        context.notices.add(
            fmt::format("attributes of {} triangles (colours, in some programs) are ignored", attributes),
            {path, 0});
    if (bytes.size() > end)
        context.notices.add(
            fmt::format("{} bytes behind the triangles, from byte {}, are ignored", bytes.size() - end, end),
            {path, 0});
}

} // namespace

bool is_stl(std::string_view bytes) {
    if (has_size_of_binary(bytes))
        return true;
    const std::string head = lower_head(bytes);
    return is_text(head) && head.find("facet") != head.npos;
}

SceneDescription read_stl_scene(SceneFile file, const ReadContext& context) {
    StlMesh mesh(context.notices);
    if (!has_size_of_binary(file.bytes) && is_text(lower_head(file.bytes))) {
        const std::string text = as_utf8(std::move(file.bytes));
        parse_stl_text(without_byte_order_mark(text), file.name, mesh);
    } else {
        parse_binary(file.bytes, file.name, context, mesh);
    }
    SceneDescription scene;
    scene.dropped_faces = mesh.dropped();
    scene.mesh = mesh.take();
    if (scene.mesh.triangles.empty())
        throw SceneError(file.name, 0,
                         fmt::format("the file has no triangles to render; facets that are left out: {}",
                                     scene.dropped_faces));
    scene.materials.resize(1);
    scene.materials[0].place = {file.name, 0};
    scene.z_up_reason = "it is an STL file, whose up is z by custom";
    context.progress.update({"load", 1});
    return scene;
}

} // namespace clrt
