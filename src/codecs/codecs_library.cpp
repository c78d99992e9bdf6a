// SPDX-License-Identifier: Apache-2.0
// What is loaded: the function that mesh_codecs() looks up.
#include "codecs/decode_draco.h"
#include "codecs/decode_meshopt.h"

namespace clrt {

namespace {

class LinkedCodecs final : public MeshCodecs {
public:
    DracoMesh decode_draco(std::string_view bytes, const std::vector<u32>& ids) const override {
        return decode_draco_mesh(bytes, ids);
    }
    std::string decode_meshopt(std::string_view bytes, const MeshoptLayout& layout) const override {
        return decode_meshopt_view(bytes, layout);
    }
};

} // namespace

} // namespace clrt

/// Named by MESH_CODECS_ENTRY.
extern "C" __attribute__((visibility("default"))) const clrt::MeshCodecs* clrt_mesh_codecs_1() {
    static const clrt::LinkedCodecs codecs;
    return &codecs;
}
