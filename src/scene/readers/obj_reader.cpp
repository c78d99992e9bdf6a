// SPDX-License-Identifier: Apache-2.0
// The OBJ reader: chunks are parsed in parallel, joined in file order, then resolved and triangulated in
// parallel.
#include "scene/readers/obj_reader.h"

#include "scene/readers/obj_faces.h"
#include "scene/readers/obj_notices.h"
#include "scene/readers/text_encoding.h"
#include "scene/text_scanner.h"

namespace clrt {

ObjMesh read_obj(SceneFile file, Progress& progress, size_t chunk_bytes) {
    const std::string& path = file.name;
    ObjMesh mesh;
    ObjPieces pieces;
    {
        const std::string text = as_utf8(std::move(file.bytes));
        mesh.head = text.substr(0, OBJ_HEAD_BYTES);
        progress.update({"load", OBJ_READ});
        pieces = parse_obj_text(path, without_byte_order_mark(text), chunk_bytes, progress);
    }
    join_elements(path, pieces, mesh);
    mesh.material_lines = join_names(pieces, &ObjChunk::materials, &ObjPiece::materials, mesh.material_names);
    join_names(pieces, &ObjChunk::groups, &ObjPiece::objects, mesh.object_names);
    std::vector<std::string> smoothing_names;
    join_names(pieces, &ObjChunk::smoothings, &ObjPiece::smoothings, smoothing_names);
    for (const ObjPiece& piece : pieces)
        for (const ObjName& library : piece.chunk.libraries)
            mesh.libraries.push_back({library.name, piece.first_line + library.line});

    resolve_faces(path, pieces, mesh);
    progress.update({"load", OBJ_RESOLVED});
    place_triangles(path, pieces, mesh);
    triangulate_faces(pieces, smoothing_names, mesh);
    mesh.notices = make_notices(path, pieces);
    progress.update({"load", 1});
    return mesh;
}

} // namespace clrt
