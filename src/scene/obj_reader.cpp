// SPDX-License-Identifier: Apache-2.0
// The OBJ reader: chunks are parsed in parallel, joined in file order, then resolved and triangulated in
// parallel.
#include "scene/obj_reader.h"

#include "error.h"
#include "output/standard_streams.h"
#include "scene/foreign_format.h"
#include "scene/obj_chunk.h"
#include "scene/text_encoding.h"
#include "scene/text_scanner.h"
#include "scene/triangulate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tbb/parallel_for.h>
#include <unordered_map>

namespace clrt {

namespace {

constexpr size_t BATCH_CHUNKS = 64; ///< chunks between two updates of the progress line

// Shares of the whole work, for the progress line.
constexpr double PROGRESS_READ = 0.1, PROGRESS_PARSED = 0.8, PROGRESS_RESOLVED = 0.9;

/// From here on all faces of a chunk have this name, until the next run.
struct NameRun {
    size_t first_face;
    u32 name;
};

/// A chunk, and where it stands in the file.
struct Piece {
    ObjChunk chunk;
    size_t first_line = 0;     ///< from 1
    ObjCounts before;          ///< elements in the chunks before it
    size_t first_triangle = 0; ///< into ObjMesh::triangles
    size_t triangle_count = 0;
    size_t normals_triangle =
        0;                   ///< into ObjMesh::triangles: the first with corner normals or a smoothing group,
    size_t normals_line = 0; ///< and its face's line in the file; 0: none
    std::vector<NameRun> materials, objects, smoothings;
};

using Pieces = std::vector<Piece>;

/// Calls work(piece) for all pieces in parallel.
template <typename Work>
void for_each_piece(Pieces& pieces, const Work& work) {
    tbb::parallel_for(size_t(0), pieces.size(), [&](size_t i) { work(pieces[i]); });
}

/// Throws the first error in file order, if there is one.
void throw_first_error(const std::string& path, const Pieces& pieces) {
    for (const Piece& piece : pieces)
        if (!piece.chunk.error.empty())
            throw SceneError(path, piece.first_line + piece.chunk.error_line, piece.chunk.error);
}

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

Pieces parse_text(const std::string& path, std::string_view text, size_t chunk_bytes, Progress& progress) {
    const std::vector<size_t> cuts = cut_text(text, chunk_bytes);
    Pieces pieces(cuts.size() - 1);
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
        progress.update({"load", PROGRESS_READ + (PROGRESS_PARSED - PROGRESS_READ) * share});
    }
    return pieces;
}

/// Moves the colours into the mesh, where there are any. Wants Piece::before.
void join_colours(Pieces& pieces, ObjMesh& mesh) {
    const auto has_colours = [](const Piece& piece) { return !piece.chunk.colours.empty(); };
    const auto first = std::find_if(pieces.begin(), pieces.end(), has_colours);
    if (first == pieces.end())
        return;
    mesh.first_colour_line = first->first_line + first->chunk.first_colour_line;
    mesh.colours.assign(mesh.positions.size(), NO_COLOUR);
    for (Piece& piece : pieces) {
        std::copy(piece.chunk.colours.begin(), piece.chunk.colours.end(),
                  mesh.colours.begin() + std::ptrdiff_t(piece.before.positions));
        piece.chunk.colours = {};
    }
}

/// Sets ObjCounts of each piece and moves all elements into the mesh.
void join_elements(const std::string& path, Pieces& pieces, ObjMesh& mesh) {
    ObjCounts total;
    for (Piece& piece : pieces) {
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
    for_each_piece(pieces, [&](Piece& piece) {
        move(piece.chunk.positions, mesh.positions, piece.before.positions);
        move(piece.chunk.uvs, mesh.uvs, piece.before.uvs);
        move(piece.chunk.normals, mesh.normals, piece.before.normals);
    });
}

/// Gives each face the name of the last statement before it. Fills `runs` of each piece; names are numbered
/// by first use. Returns the lines of their statements, 0 for no name.
std::vector<size_t> join_names(Pieces& pieces, std::vector<ObjName> ObjChunk::*statements,
                               std::vector<NameRun> Piece::*runs, std::vector<std::string>& names) {
    std::unordered_map<std::string, u32> numbers;
    std::vector<size_t> lines;
    std::string current;
    size_t current_line = 0;
    const auto close_run = [&](Piece& piece, size_t first_face, size_t end_face) {
        if (first_face == end_face)
            return;
        const auto [entry, is_new] = numbers.emplace(current, u32(names.size()));
        if (is_new) {
            names.push_back(current);
            lines.push_back(current.empty() ? 0 : current_line);
        }
        (piece.*runs).push_back({first_face, entry->second});
    };
    for (Piece& piece : pieces) {
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

/// From the index as written to one from 0; -1 if it is absent or out of range. `before`: elements before the
/// face.
i32 resolved(i32 written, size_t before, size_t total) {
    const long long index = written < 0 ? static_cast<long long>(before) + written : written - 1LL;
    return written != ABSENT_INDEX && index >= 0 && index < static_cast<long long>(total) ? i32(index) : -1;
}

std::string position_range_error(const ObjChunk& chunk, i32 found, size_t before, size_t total) {
    const bool saturated = found == std::numeric_limits<i32>::max() || found == ABSENT_INDEX + 1;
    const std::string text = saturated ? chunk.oversized_index : std::to_string(found);
    if (total == 0)
        return "expected vertices (v) to make faces of, found none in the file but vertex index " + text;
    std::string range = "from 1 to " + std::to_string(total);
    if (before > 0)
        range += " or from -" + std::to_string(before) + " to -1";
    return "expected a vertex index " + range + ", found " + text;
}

/// Turns a face's indices as written into indices of the mesh. Sets the chunk's error for a bad position
/// index.
void resolve_face(const ObjMesh& mesh, Piece& piece, const ObjFace& face) {
    ObjChunk& chunk = piece.chunk;
    for (size_t c = face.first_corner; c < face.end_corner; ++c) {
        ObjCorner& corner = chunk.corners[c];
        const ObjCorner written = corner;
        const size_t positions_before = piece.before.positions + face.positions;
        corner.v = resolved(written.v, positions_before, mesh.positions.size());
        corner.t = resolved(written.t, piece.before.uvs + face.uvs, mesh.uvs.size());
        corner.n = resolved(written.n, piece.before.normals + face.normals, mesh.normals.size());
        if (corner.v < 0) {
            chunk.error_line = face.line;
            chunk.error = position_range_error(chunk, written.v, positions_before, mesh.positions.size());
            return;
        }
        if (corner.t < 0 && written.t != ABSENT_INDEX)
            chunk.tallies[UV_OUT_OF_RANGE].add(face.line);
        if (corner.n < 0 && written.n != ABSENT_INDEX)
            chunk.tallies[NORMAL_OUT_OF_RANGE].add(face.line);
    }
}

bool is_finite(const ObjMesh& mesh, const ObjChunk& chunk, const ObjFace& face) {
    return std::all_of(chunk.corners.begin() + std::ptrdiff_t(face.first_corner),
                       chunk.corners.begin() + std::ptrdiff_t(face.end_corner), [&](const ObjCorner& corner) {
                           const glm::dvec3& p = mesh.positions[size_t(corner.v)];
                           return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
                       });
}

/// Resolves all faces of a piece; those with a non-finite position lose their corners. Counts the triangles.
void resolve_piece(const ObjMesh& mesh, Piece& piece, bool check_finite) {
    for (ObjFace& face : piece.chunk.faces) {
        resolve_face(mesh, piece, face);
        if (!piece.chunk.error.empty())
            return;
        if (check_finite && !is_finite(mesh, piece.chunk, face)) {
            piece.chunk.tallies[NON_FINITE_FACES].add(face.line);
            face.end_corner = face.first_corner;
        } else
            piece.triangle_count += face.end_corner - face.first_corner - 2;
    }
}

/// The triangle of three corners. Attributes that not all three have are left out.
ObjTriangle make_triangle(const ObjCorner& a, const ObjCorner& b, const ObjCorner& c, u32 material,
                          u32 object) {
    ObjTriangle triangle{{u32(a.v), u32(b.v), u32(c.v)},
                         {NO_INDEX, NO_INDEX, NO_INDEX},
                         {NO_INDEX, NO_INDEX, NO_INDEX},
                         material,
                         object};
    const auto set = [](u32(&to)[3], i32 i, i32 j, i32 k) {
        if (i >= 0 && j >= 0 && k >= 0)
            to[0] = u32(i), to[1] = u32(j), to[2] = u32(k);
    };
    set(triangle.n, a.n, b.n, c.n);
    set(triangle.t, a.t, b.t, c.t);
    return triangle;
}

/// The names that hold for the faces of a piece, one after the other.
class RunWalk {
public:
    explicit RunWalk(const std::vector<NameRun>& runs) : at_(runs.begin()), end_(runs.end()) {}
    /// The name of a face; faces must come in ascending order.
    u32 name_of(size_t face) {
        if (at_ + 1 != end_ && at_[1].first_face <= face)
            ++at_;
        return at_->name;
    }

private:
    std::vector<NameRun>::const_iterator at_, end_;
};

/// Writes a piece's triangles to their place in the mesh; `groups` are the smoothing groups by name's number.
void triangulate_piece(Piece& piece, const std::vector<u32>& groups, ObjMesh& mesh) {
    ObjTriangle* out = mesh.triangles.data() + piece.first_triangle;
    std::vector<glm::dvec3> polygon;
    std::vector<u32> cut;
    RunWalk materials(piece.materials), objects(piece.objects), smoothings(piece.smoothings);
    for (size_t f = 0; f < piece.chunk.faces.size(); ++f) {
        const ObjFace& face = piece.chunk.faces[f];
        const ObjCorner* const corners = piece.chunk.corners.data() + face.first_corner;
        const u32 material = materials.name_of(f), object = objects.name_of(f),
                  group = groups[smoothings.name_of(f)];
        polygon.clear();
        for (size_t c = 0; c < face.end_corner - face.first_corner; ++c)
            polygon.push_back(mesh.positions[size_t(corners[c].v)]);
        if (polygon.empty())
            continue;
        if (!triangulate(polygon, cut))
            piece.chunk.tallies[CRUDE_CUTS].add(face.line);
        for (size_t i = 0; i < cut.size(); i += 3, ++out) {
            *out = make_triangle(corners[cut[i]], corners[cut[i + 1]], corners[cut[i + 2]], material, object);
            if (!mesh.smoothing.empty())
                mesh.smoothing[size_t(out - mesh.triangles.data())] = group;
            if (piece.normals_line || (out->n[0] == NO_INDEX && group == NO_INDEX))
                continue;
            piece.normals_line = piece.first_line + face.line;
            piece.normals_triangle = size_t(out - mesh.triangles.data());
        }
    }
}

/// The smoothing group of each name of an s statement: NO_INDEX for "off", "0" and none.
std::vector<u32> smoothing_groups(const std::vector<std::string>& names) {
    std::vector<u32> groups;
    for (const std::string& name : names)
        groups.push_back(name.empty() || name == "off" || name == "0" ? NO_INDEX : u32(groups.size()));
    return groups;
}

/// Remembers the first triangle with corner normals or a smoothing group.
void note_first_normals(const Pieces& pieces, ObjMesh& mesh) {
    for (const Piece& piece : pieces)
        if (piece.normals_line) {
            mesh.first_normals_triangle = piece.normals_triangle;
            mesh.first_normals_line = piece.normals_line;
            return;
        }
}

size_t count_oddities(const Pieces& pieces, ObjOddity kind) {
    size_t count = 0;
    for (const Piece& piece : pieces)
        count += piece.chunk.tallies[kind].count;
    return count;
}

[[noreturn]] void throw_no_faces(const std::string& path, const Pieces& pieces, const ObjMesh& mesh) {
    if (mesh.dropped_faces > 0)
        throw SceneError(path, 0,
                         "the file has no faces that can be rendered: all " +
                             std::to_string(mesh.dropped_faces) +
                             " have fewer than three corners or a vertex that is not finite");
    const auto count = [&](ObjOddity kind) { return std::to_string(count_oddities(pieces, kind)); };
    const bool is_mtl = std::any_of(pieces.begin(), pieces.end(), [](const Piece& piece) {
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

/// Gives each piece its place in the mesh's triangles. Throws where there are none.
void place_triangles(const std::string& path, Pieces& pieces, ObjMesh& mesh) {
    size_t total = 0;
    for (Piece& piece : pieces) {
        piece.first_triangle = total;
        total += piece.triangle_count;
    }
    mesh.dropped_faces = count_oddities(pieces, FEW_CORNERS) + count_oddities(pieces, NON_FINITE_FACES);
    if (total == 0)
        throw_no_faces(path, pieces, mesh);
    mesh.triangles.resize(total);
}

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

/// One line for each kind of oddity that occurred: the place of the first, and how many more there are.
std::vector<std::string> make_notices(const std::string& path, const Pieces& pieces) {
    std::vector<std::string> notices;
    for (int k = 0; k < ODDITY_KINDS; ++k) {
        const auto kind = ObjOddity(k);
        const auto first = std::find_if(pieces.begin(), pieces.end(), [kind](const Piece& piece) {
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

} // namespace

ObjMesh read_obj(const std::string& file, Progress& progress, size_t chunk_bytes) {
    const std::string path = input_name(file);
    ObjMesh mesh;
    progress.update({"load", 0});
    Pieces pieces;
    {
        std::string bytes = read_file(file);
        mesh.bytes = bytes.size();
        if (const std::string other = foreign_format(bytes); !other.empty())
            throw SceneError(path, 0, "expected a Wavefront OBJ, found " + other);
        const std::string text = as_utf8(std::move(bytes));
        mesh.head = text.substr(0, OBJ_HEAD_BYTES);
        progress.update({"load", PROGRESS_READ});
        pieces = parse_text(path, without_byte_order_mark(text), chunk_bytes, progress);
    }
    join_elements(path, pieces, mesh);
    mesh.material_lines = join_names(pieces, &ObjChunk::materials, &Piece::materials, mesh.material_names);
    join_names(pieces, &ObjChunk::groups, &Piece::objects, mesh.object_names);
    std::vector<std::string> smoothing_names;
    join_names(pieces, &ObjChunk::smoothings, &Piece::smoothings, smoothing_names);
    const std::vector<u32> groups = smoothing_groups(smoothing_names);
    for (const Piece& piece : pieces)
        for (const ObjName& library : piece.chunk.libraries)
            mesh.libraries.push_back({library.name, piece.first_line + library.line});

    const bool check_finite = std::any_of(
        pieces.begin(), pieces.end(), [](const Piece& piece) { return piece.chunk.has_non_finite_position; });
    for_each_piece(pieces, [&](Piece& piece) { resolve_piece(mesh, piece, check_finite); });
    throw_first_error(path, pieces);
    progress.update({"load", PROGRESS_RESOLVED});
    place_triangles(path, pieces, mesh);
    if (std::any_of(groups.begin(), groups.end(), [](u32 group) { return group != NO_INDEX; }))
        mesh.smoothing.resize(mesh.triangles.size());
    for_each_piece(pieces, [&](Piece& piece) { triangulate_piece(piece, groups, mesh); });
    note_first_normals(pieces, mesh);
    mesh.notices = make_notices(path, pieces);
    progress.update({"load", 1});
    return mesh;
}

} // namespace clrt
