// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/obj_notices.h"

#include "error.h"
#include "scene/text_scanner.h"

#include <algorithm>

namespace clrt {

namespace {

std::string describe(ObjOddity kind, const ObjChunk& first) {
    switch (kind) {
    case POINTS:
        return "a point statement (p) is ignored";
    case LINES:
        return "a line statement (l) is ignored";
    case CURVES:
        return "a curve or surface statement is ignored";
    case UNKNOWN_STATEMENTS:
        return "the unknown statement " + first.unknown_keyword + " is ignored";
    case FEW_CORNERS:
        return "a face with fewer than three corners is left out";
    case NON_FINITE_FACES:
        return "a face with a vertex that is not finite is left out";
    case UV_OUT_OF_RANGE:
        return "a texture coordinate (vt) whose index is out of range is left out";
    case NORMAL_OUT_OF_RANGE:
        return "a normal (vn) whose index is out of range is left out";
    default:
        return "a face that folds or crosses itself, has no area or too many corners is cut into triangles "
               "that "
               "may overlap";
    }
}

} // namespace

size_t count_oddities(const ObjPieces& pieces, ObjOddity kind) {
    size_t count = 0;
    for (const ObjPiece& piece : pieces)
        count += piece.chunk.tallies[kind].count;
    return count;
}

void throw_no_faces(const std::string& path, const ObjPieces& pieces, const ObjMesh& mesh) {
    if (mesh.dropped_faces > 0)
        throw SceneError(path, 0,
                         "the file has no faces that can be rendered: all " +
                             std::to_string(mesh.dropped_faces) +
                             " have fewer than three corners or a vertex that is not finite");
    const auto count = [&](ObjOddity kind) { return std::to_string(count_oddities(pieces, kind)); };
    const bool is_mtl = std::any_of(pieces.begin(), pieces.end(), [](const ObjPiece& piece) {
        return piece.chunk.unknown_keyword == quoted("newmtl");
    });
    throw SceneError(
        path, 0,
        "the file has no faces (f) to render, only " + std::to_string(mesh.positions.size()) +
            " vertices (v), " + count(LINES) + " lines (l), " + count(POINTS) + " points (p), " +
            count(CURVES) + " curve and surface statements and " + count(UNKNOWN_STATEMENTS) +
            " unknown ones" +
            (is_mtl ? ": it looks like a material library (MTL), give the OBJ that names it" : ""));
}

std::vector<std::string> make_notices(const std::string& path, const ObjPieces& pieces) {
    std::vector<std::string> notices;
    for (int k = 0; k < ODDITY_KINDS; ++k) {
        const auto kind = ObjOddity(k);
        const auto first = std::find_if(pieces.begin(), pieces.end(), [kind](const ObjPiece& piece) {
            return piece.chunk.tallies[kind].count > 0;
        });
        if (first == pieces.end())
            continue;
        const size_t line = first->first_line + first->chunk.tallies[kind].first_line;
        const size_t more = count_oddities(pieces, kind) - 1;
        notices.push_back(path + ":" + std::to_string(line) + ": " + describe(kind, first->chunk) +
                          (more > 0 ? " (and " + std::to_string(more) + " more)" : ""));
    }
    return notices;
}

} // namespace clrt
