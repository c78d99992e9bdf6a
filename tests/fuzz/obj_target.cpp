// SPDX-License-Identifier: Apache-2.0
// The OBJ reader: any bytes give a sound mesh or a SceneError, the same for every way of cutting the text
// into chunks.
#include "error.h"
#include "fuzz_target.h"
#include "scene/readers/obj_reader.h"

#include <cstring>

namespace clrt {

namespace {

/// What the reader makes of a file.
struct Outcome {
    ObjMesh mesh;
    std::string error;
};

Outcome read(std::string_view text, size_t chunk_bytes) {
    Progress silent(Toggle::OFF, true);
    Outcome outcome;
    try {
        outcome.mesh = read_obj({"a.obj", std::string(text)}, silent, chunk_bytes);
    } catch (const SceneError& error) {
        outcome.error = error.what();
    }
    return outcome;
}

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void check_same(const Outcome& a, const Outcome& b) {
    promise(a.error == b.error, "the error does not depend on chunks");
    if (!a.error.empty())
        return;
    promise(same_bytes(a.mesh.positions, b.mesh.positions) && same_bytes(a.mesh.normals, b.mesh.normals) &&
                same_bytes(a.mesh.uvs, b.mesh.uvs) && same_bytes(a.mesh.triangles, b.mesh.triangles) &&
                same_bytes(a.mesh.colours, b.mesh.colours) && same_bytes(a.mesh.smoothing, b.mesh.smoothing),
            "the mesh does not depend on chunks");
    promise(a.mesh.notices == b.mesh.notices && a.mesh.material_names == b.mesh.material_names &&
                a.mesh.material_lines == b.mesh.material_lines && a.mesh.object_names == b.mesh.object_names,
            "names and notices do not depend on chunks");
}

void check_sound(const ObjMesh& mesh) {
    promise(!mesh.triangles.empty(), "a mesh has triangles");
    promise(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size(),
            "each position has a colour");
    promise(mesh.smoothing.empty() || mesh.smoothing.size() == mesh.triangles.size(),
            "each triangle has a group");
    for (const MeshTriangle& triangle : mesh.triangles) {
        for (int c = 0; c < 3; ++c) {
            promise(triangle.v[c] < mesh.positions.size(), "corners are in range");
            promise(triangle.n[c] == NO_INDEX || triangle.n[c] < mesh.normals.size(), "normals are in range");
            promise(triangle.t[c] == NO_INDEX || triangle.t[c] < mesh.uvs.size(), "uvs are in range");
        }
        promise(triangle.material < mesh.material_names.size(), "materials are in range");
        promise(triangle.object < mesh.object_names.size(), "objects are in range");
    }
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    const std::string_view text = as_text(data, size);
    const Outcome whole = read(text, OBJ_CHUNK_BYTES);
    constexpr size_t ODD_CHUNK_BYTES = 7;
    check_same(whole, read(text, ODD_CHUNK_BYTES));
    if (whole.error.empty())
        check_sound(whole.mesh);
    return 0;
}
