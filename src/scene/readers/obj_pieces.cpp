// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/obj_pieces.h"

#include "error.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace clrt {

namespace {

constexpr size_t BATCH_CHUNKS = 64; ///< chunks between two updates of the progress line

/// Where to cut the text: offsets between statements about chunk_bytes apart, 0 and the size included.
std::vector<size_t> cut_text(std::string_view text, size_t chunk_bytes) {
    std::vector<size_t> cuts{0};
    while (cuts.back() < text.size()) {
        const size_t rest = text.size() - cuts.back();
        cuts.push_back(rest <= chunk_bytes ? text.size()
                                           : next_line_start(text, cuts.back() + chunk_bytes - 1));
    }
    return cuts;
}

/// Moves the colours into the mesh, where there are any. Wants ObjPiece::before.
void join_colours(ObjPieces& pieces, ObjMesh& mesh) {
    const auto has_colours = [](const ObjPiece& piece) { return !piece.chunk.colours.empty(); };
    const auto first = std::find_if(pieces.begin(), pieces.end(), has_colours);
    if (first == pieces.end())
        return;
    mesh.first_colour_line = first->first_line + first->chunk.first_colour_line;
    mesh.colours.assign(mesh.positions.size(), NO_COLOUR);
    for (ObjPiece& piece : pieces) {
        std::copy(piece.chunk.colours.begin(), piece.chunk.colours.end(),
                  mesh.colours.begin() + std::ptrdiff_t(piece.before.positions));
        piece.chunk.colours = {};
    }
}

} // namespace

void throw_first_error(const std::string& path, const ObjPieces& pieces) {
    for (const ObjPiece& piece : pieces)
        if (!piece.chunk.error.empty())
            throw SceneError(path, piece.first_line + piece.chunk.error_line, piece.chunk.error);
}

ObjPieces parse_obj_text(const std::string& path, std::string_view text, size_t chunk_bytes,
                         Progress& progress) {
    const std::vector<size_t> cuts = cut_text(text, chunk_bytes);
    ObjPieces pieces(cuts.size() - 1);
    size_t line = 1;
    for (size_t begin = 0; begin < pieces.size(); begin += BATCH_CHUNKS) {
        const size_t end = std::min(pieces.size(), begin + BATCH_CHUNKS);
        tbb::parallel_for(begin, end, [&](size_t i) {
            pieces[i].chunk = parse_obj_chunk(text.substr(cuts[i], cuts[i + 1] - cuts[i]));
        });
        for (size_t i = begin; i < end; ++i) {
            pieces[i].first_line = line;
            line += pieces[i].chunk.line_ends;
        }
        throw_first_error(path, pieces);
        const double share = double(cuts[end]) / double(text.size());
        progress.update({"load", OBJ_READ + (OBJ_PARSED - OBJ_READ) * share});
    }
    return pieces;
}

void join_elements(const std::string& path, ObjPieces& pieces, ObjMesh& mesh) {
    ObjCounts total;
    for (ObjPiece& piece : pieces) {
        piece.before = total;
        total.positions += piece.chunk.positions.size();
        total.uvs += piece.chunk.uvs.size();
        total.normals += piece.chunk.normals.size();
    }
    const size_t most = std::max({total.positions, total.uvs, total.normals});
    if (most > size_t(std::numeric_limits<i32>::max()))
        throw SceneError(path, 0, "expected at most 2147483647 vertices, found " + std::to_string(most));
    mesh.positions.resize(total.positions);
    join_colours(pieces, mesh);
    mesh.uvs.resize(total.uvs);
    mesh.normals.resize(total.normals);
    const auto move = [](auto& from, auto& to, size_t offset) {
        std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(offset));
        from = {};
    };
    for_each_piece(pieces, [&](ObjPiece& piece) {
        move(piece.chunk.positions, mesh.positions, piece.before.positions);
        move(piece.chunk.uvs, mesh.uvs, piece.before.uvs);
        move(piece.chunk.normals, mesh.normals, piece.before.normals);
    });
}

std::vector<size_t> join_names(ObjPieces& pieces, std::vector<ObjName> ObjChunk::*statements,
                               std::vector<ObjNameRun> ObjPiece::*runs, std::vector<std::string>& names) {
    std::unordered_map<std::string, u32> numbers;
    std::vector<size_t> lines;
    std::string current;
    size_t current_line = 0;
    const auto close_run = [&](ObjPiece& piece, size_t first_face, size_t end_face) {
        if (first_face == end_face)
            return;
        const auto [entry, is_new] = numbers.emplace(current, u32(names.size()));
        if (is_new) {
            names.push_back(current);
            lines.push_back(current.empty() ? 0 : current_line);
        }
        (piece.*runs).push_back({first_face, entry->second});
    };
    for (ObjPiece& piece : pieces) {
        size_t first_face = 0;
        for (const ObjName& statement : piece.chunk.*statements) {
            close_run(piece, first_face, statement.face);
            first_face = statement.face;
            current = statement.name;
            current_line = piece.first_line + statement.line;
        }
        close_run(piece, first_face, piece.chunk.faces.size());
    }
    return lines;
}

} // namespace clrt
