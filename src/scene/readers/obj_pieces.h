// SPDX-License-Identifier: Apache-2.0
// OBJ text -> pieces that were parsed in parallel, and what joins them in file order.
#pragma once

#include "console/progress.h"
#include "scene/readers/obj_chunk.h"
#include "scene/readers/obj_reader.h"

#include <string>
#include <string_view>
#include <tbb/parallel_for.h>
#include <vector>

namespace clrt {

// Shares of the whole work, for the progress line.
constexpr double OBJ_READ = 0.1, OBJ_PARSED = 0.8, OBJ_RESOLVED = 0.9;

/// From here on all faces of a chunk have this name, until the next run.
struct ObjNameRun {
    size_t first_face;
    u32 name;
};

/// A chunk, and where it stands in the file.
struct ObjPiece {
    ObjChunk chunk;
    size_t first_line = 0;     ///< from 1
    ObjCounts before;          ///< elements in the chunks before it
    size_t first_triangle = 0; ///< into ObjMesh::triangles
    size_t triangle_count = 0;
    size_t normals_triangle =
        0;                   ///< into ObjMesh::triangles: the first with corner normals or a smoothing group,
    size_t normals_line = 0; ///< and its face's line in the file; 0: none
    std::vector<ObjNameRun> materials, objects, smoothings;
};

using ObjPieces = std::vector<ObjPiece>;

/// Calls work(piece) for all pieces in parallel.
template <typename Work>
void for_each_piece(ObjPieces& pieces, const Work& work) {
    tbb::parallel_for(size_t(0), pieces.size(), [&](size_t i) { work(pieces[i]); });
}

/// Throws the first error in file order, if there is one.
void throw_first_error(const std::string& path, const ObjPieces& pieces);

/// Cuts the text between statements about chunk_bytes apart and parses all pieces. Throws SceneError for what
/// is wrong in a statement.
ObjPieces parse_obj_text(const std::string& path, std::string_view text, size_t chunk_bytes,
                         Progress& progress);

/// Sets ObjCounts of each piece and moves all elements into the mesh. Throws SceneError for more of them than
/// indices reach.
void join_elements(const std::string& path, ObjPieces& pieces, ObjMesh& mesh);

/// Gives each face the name of the last statement before it. Fills `runs` of each piece; names are numbered
/// by first use. Returns the lines of their statements, 0 for no name.
std::vector<size_t> join_names(ObjPieces& pieces, std::vector<ObjName> ObjChunk::*statements,
                               std::vector<ObjNameRun> ObjPiece::*runs, std::vector<std::string>& names);

} // namespace clrt
