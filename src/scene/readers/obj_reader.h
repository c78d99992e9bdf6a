// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ text -> triangles. Parallel, safe on any bytes, exact in its file:line errors.
#pragma once

#include "console/progress.h"
#include "kernels/shared/types.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace clrt {

/// A triangle of the OBJ: indices from 0 into ObjMesh's arrays; NO_INDEX where a face gives none.
struct ObjTriangle {
    u32 v[3], n[3], t[3];
    u32 material; ///< into ObjMesh::material_names
    u32 object;   ///< into ObjMesh::object_names
};

/// A mtllib statement: the text after the keyword, for the caller to resolve (one name with spaces, or
/// several).
struct ObjLibrary {
    std::string names;
    size_t line = 0;
};

/// The geometry and names of an OBJ file, exactly as written (world units, no fallbacks for materials).
struct ObjMesh {
    std::vector<glm::dvec3> positions; ///< in double: map coordinates leave floats no digits for the scene
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec3> colours;     ///< of each position, as written, NaN for none; empty if none has any
    size_t first_colour_line = 0;       ///< of the first position with a colour
    std::vector<ObjTriangle> triangles; ///< in file order
    std::vector<u32> smoothing; ///< each triangle's smoothing group, NO_INDEX for none; empty if none has any
    std::vector<std::string> material_names; ///< by first use; "" is "no usemtl"
    std::vector<size_t> material_lines;      ///< line of the first usemtl of each that has faces; 0 for ""
    std::vector<std::string>
        object_names;                  ///< of `o` and `g` statements that have faces; "" is the unnamed first
    size_t first_normals_triangle = 0; ///< the first triangle with corner normals or a smoothing group,
    size_t first_normals_line = 0;     ///< and the line of its face; 0 where no triangle has any
    std::vector<ObjLibrary> libraries;
    std::vector<std::string>
        notices;      ///< "file:line: ..." or "file: ..." one line each, every kind once with a count
    std::string head; ///< the file's first OBJ_HEAD_BYTES at most: writers name themselves there
    size_t bytes = 0;
    size_t dropped_faces = 0; ///< fewer than three corners, or a non-finite position
};

/// How much text one task reads: enough to hide the cost of a task, little enough for many of them.
constexpr size_t OBJ_CHUNK_BYTES = size_t(1) << 20;

/// How much of a file's text its mesh keeps: comments of writers are shorter.
constexpr size_t OBJ_HEAD_BYTES = 1024;

/// Reads an OBJ file, or the standard input ("-"). Polygons become triangles (concave ones by ear clipping),
/// negative indices count back, CR, LF and CRLF end lines, a backslash at a line's end continues it, UTF-16
/// is read as UTF-8. Points, lines, curves and unknown statements are counted in a notice. A vn or vt index
/// out of range is dropped with a notice; a position index out of range or 0, a number that is none, a file
/// of another format and one without a single face throw SceneError (file:line, what was expected, what was
/// found). The result is the same for any number of threads and any `chunk_bytes` (at least 1).
ObjMesh read_obj(const std::string& file, Progress& progress, size_t chunk_bytes = OBJ_CHUNK_BYTES);

} // namespace clrt
