// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file: what its elements are made of (Turk 1994, "The PLY Polygon File Format").
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace clrt {

enum class PlyType { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64 };

/// Bytes of a value in binary files.
size_t ply_size(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type;
    bool is_list = false;
    PlyType count_type = PlyType::UINT8; ///< of a list
};

struct PlyElement {
    std::string name;
    size_t count;
    std::vector<PlyProperty> properties;
};

enum class PlyFormat { ASCII, LITTLE, BIG };

struct PlyHeader {
    PlyFormat format = PlyFormat::ASCII;
    std::vector<PlyElement> elements; ///< in the order in which they come
    size_t bytes = 0, lines = 0;      ///< of the header itself
};

/// Whether bytes begin as a PLY file does.
bool is_ply(std::string_view bytes);

/// Throws SceneError (file:line): expected, found.
PlyHeader read_ply_header(std::string_view bytes, const std::string& path);

} // namespace clrt
