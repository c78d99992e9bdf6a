// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/obj_faces.h"

#include "scene/readers/obj_notices.h"
#include "scene/triangulate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clrt {

namespace {

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
void resolve_face(const ObjMesh& mesh, ObjPiece& piece, const ObjFace& face) {
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

bool has_finite_corners(const ObjMesh& mesh, const ObjChunk& chunk, const ObjFace& face) {
    return std::all_of(chunk.corners.begin() + std::ptrdiff_t(face.first_corner),
                       chunk.corners.begin() + std::ptrdiff_t(face.end_corner), [&](const ObjCorner& corner) {
                           const glm::dvec3& p = mesh.positions[size_t(corner.v)];
                           return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
                       });
}

/// Resolves all faces of a piece; those with a non-finite position lose their corners. Counts the triangles.
void resolve_piece(const ObjMesh& mesh, ObjPiece& piece, bool check_finite) {
    for (ObjFace& face : piece.chunk.faces) {
        resolve_face(mesh, piece, face);
        if (!piece.chunk.error.empty())
            return;
        if (check_finite && !has_finite_corners(mesh, piece.chunk, face)) {
            piece.chunk.tallies[NON_FINITE_FACES].add(face.line);
            face.end_corner = face.first_corner;
        } else
            piece.triangle_count += face.end_corner - face.first_corner - 2;
    }
}

/// The triangle of three corners. Attributes that not all three have are left out.
MeshTriangle make_triangle(const ObjCorner& a, const ObjCorner& b, const ObjCorner& c, u32 material,
                           u32 object) {
    MeshTriangle triangle{{u32(a.v), u32(b.v), u32(c.v)},
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
    explicit RunWalk(const std::vector<ObjNameRun>& runs) : at_(runs.begin()), end_(runs.end()) {}
    /// The name of a face; faces must come in ascending order.
    u32 name_of(size_t face) {
        if (at_ + 1 != end_ && at_[1].first_face <= face)
            ++at_;
        return at_->name;
    }

private:
    std::vector<ObjNameRun>::const_iterator at_, end_;
};

/// Writes a piece's triangles to their place in the mesh; `groups` are the smoothing groups by name's number.
void triangulate_piece(ObjPiece& piece, const std::vector<u32>& groups, ObjMesh& mesh) {
    MeshTriangle* out = mesh.triangles.data() + piece.first_triangle;
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
void note_first_normals(const ObjPieces& pieces, ObjMesh& mesh) {
    for (const ObjPiece& piece : pieces)
        if (piece.normals_line) {
            mesh.first_normals_triangle = piece.normals_triangle;
            mesh.first_normals_line = piece.normals_line;
            return;
        }
}

} // namespace

void resolve_faces(const std::string& path, ObjPieces& pieces, const ObjMesh& mesh) {
    const bool check_finite = std::any_of(pieces.begin(), pieces.end(), [](const ObjPiece& piece) {
        return piece.chunk.has_non_finite_position;
    });
    for_each_piece(pieces, [&](ObjPiece& piece) { resolve_piece(mesh, piece, check_finite); });
    throw_first_error(path, pieces);
}

void place_triangles(const std::string& path, ObjPieces& pieces, ObjMesh& mesh) {
    size_t total = 0;
    for (ObjPiece& piece : pieces) {
        piece.first_triangle = total;
        total += piece.triangle_count;
    }
    mesh.dropped_faces = count_oddities(pieces, FEW_CORNERS) + count_oddities(pieces, NON_FINITE_FACES);
    if (total == 0)
        throw_no_faces(path, pieces, mesh);
    mesh.triangles.resize(total);
}

void triangulate_faces(ObjPieces& pieces, const std::vector<std::string>& smoothing_names, ObjMesh& mesh) {
    const std::vector<u32> groups = smoothing_groups(smoothing_names);
    if (std::any_of(groups.begin(), groups.end(), [](u32 group) { return group != NO_INDEX; }))
        mesh.smoothing.resize(mesh.triangles.size());
    for_each_piece(pieces, [&](ObjPiece& piece) { triangulate_piece(piece, groups, mesh); });
    note_first_normals(pieces, mesh);
}

} // namespace clrt
