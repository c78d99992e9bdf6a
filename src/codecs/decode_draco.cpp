// SPDX-License-Identifier: Apache-2.0
#include "codecs/decode_draco.h"

#include <stdexcept>
#ifdef CLRT_HAS_DRACO
#include <draco/compression/decode.h>
#endif

namespace clrt {

#ifdef CLRT_HAS_DRACO

namespace {

DracoAttribute copy_attribute(const draco::Mesh& mesh, u32 id) {
    const draco::PointAttribute* const from = mesh.GetAttributeByUniqueId(id);
    if (!from)
        throw std::runtime_error("a Draco mesh without the attribute " + std::to_string(id));
    DracoAttribute to;
    to.components = size_t(from->num_components());
    to.values.resize(to.components * mesh.num_points());
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point)
        if (!from->ConvertValue<float>(from->mapped_index(point), from->num_components(),
                                       &to.values[to.components * point.value()]))
            throw std::runtime_error("an attribute of a Draco mesh that is no number");
    return to;
}

} // namespace

DracoMesh decode_draco_mesh(std::string_view bytes, const std::vector<u32>& ids) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        throw std::runtime_error(std::string("a damaged Draco mesh: ") + decoded.status().error_msg());
    const draco::Mesh& mesh = *decoded.value();
    DracoMesh result;
    result.vertices = mesh.num_points();
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh.face(face)) {
            if (corner.value() >= mesh.num_points())
                throw std::runtime_error("a damaged Draco mesh: a corner that is no vertex");
            result.indices.push_back(corner.value());
        }
    for (const u32 id : ids)
        result.attributes.push_back(copy_attribute(mesh, id));
    return result;
}

#else

DracoMesh decode_draco_mesh(std::string_view, const std::vector<u32>&) {
    throw std::runtime_error("a Draco mesh, which this clrt was built without (libdraco-dev)");
}

#endif

} // namespace clrt
