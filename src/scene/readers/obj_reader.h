// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ text -> triangles. Parallel, safe on any bytes, exact in its file:line errors.
#pragma once

#include "console/progress.h"
#include "scene/mesh.h"
#include "scene/readers/scene_file.h"

#include <string>
#include <vector>

namespace clrt {

/// A mtllib statement: the text after the keyword, for the caller to resolve (one name with spaces, or
/// several).
struct ObjLibrary {
    std::string names;
    size_t line = 0;
};

/// The geometry and names of an OBJ file, exactly as written (world units, no fallbacks for materials).
/// `colours` are as written, of each position, NaN for none, until decode_vertex_colours().
struct ObjMesh : Mesh {
    size_t first_colour_line = 0;            ///< of the first position with a colour
    std::vector<std::string> material_names; ///< by first use; "" is "no usemtl"
    std::vector<size_t> material_lines;      ///< line of the first usemtl of each that has faces; 0 for ""
    std::vector<ObjLibrary> libraries;
    std::vector<std::string>
        notices;              ///< "file:line: ..." or "file: ..." one line each, every kind once with a count
    std::string head;         ///< the file's first OBJ_HEAD_BYTES at most: writers name themselves there
    size_t dropped_faces = 0; ///< fewer than three corners, or a non-finite position
};

/// How much text one task reads: enough to hide the cost of a task, little enough for many of them.
constexpr size_t OBJ_CHUNK_BYTES = size_t(1) << 20;

/// How much of a file's text its mesh keeps: comments of writers are shorter.
constexpr size_t OBJ_HEAD_BYTES = 1024;

/// Reads an OBJ. Polygons become triangles (concave ones by ear clipping),
/// negative indices count back, CR, LF and CRLF end lines, a backslash at a line's end continues it, UTF-16
/// is read as UTF-8. Points, lines, curves and unknown statements are counted in a notice. A vn or vt index
/// out of range is dropped with a notice; a position index out of range or 0, a number that is none and a
/// file without a single face throw SceneError (file:line, what was expected, what was found). The result is
/// the same for any number of threads and any `chunk_bytes` (at least 1).
ObjMesh read_obj(SceneFile file, Progress& progress, size_t chunk_bytes = OBJ_CHUNK_BYTES);

} // namespace clrt
