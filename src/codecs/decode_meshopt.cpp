// SPDX-License-Identifier: Apache-2.0
#include "codecs/decode_meshopt.h"

#include <stdexcept>
#ifdef CLRT_HAS_MESHOPT
#include <meshoptimizer.h>
#endif

namespace clrt {

#ifdef CLRT_HAS_MESHOPT

namespace {

/// The strides that the decoders of meshoptimizer take without asserting; those of the extension are the
/// same.
bool has_valid_stride(const MeshoptLayout& layout) {
    if (layout.mode == "ATTRIBUTES")
        return layout.stride > 0 && layout.stride <= 256 && layout.stride % 4 == 0;
    const bool is_index = layout.stride == 2 || layout.stride == 4;
    return is_index && (layout.mode != "TRIANGLES" || layout.count % 3 == 0);
}

/// 0: decoded.
int unpack(std::string& to, std::string_view bytes, const MeshoptLayout& layout) {
    const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data());
    if (layout.mode == "ATTRIBUTES")
        return meshopt_decodeVertexBuffer(to.data(), layout.count, layout.stride, from, bytes.size());
    if (layout.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(to.data(), layout.count, layout.stride, from, bytes.size());
    return meshopt_decodeIndexSequence(to.data(), layout.count, layout.stride, from, bytes.size());
}

/// False for a filter that does not go with the layout.
bool apply_filter(std::string& values, const MeshoptLayout& layout) {
    const size_t stride = layout.stride;
    if (layout.filter == "NONE")
        return true;
    if (layout.mode != "ATTRIBUTES")
        return false;
    if (layout.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(values.data(), layout.count, stride);
    else if (layout.filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(values.data(), layout.count, stride);
    else if (layout.filter == "EXPONENTIAL" && stride % 4 == 0)
        meshopt_decodeFilterExp(values.data(), layout.count, stride);
    else
        return false;
    return true;
}

} // namespace

std::string decode_meshopt_view(std::string_view bytes, const MeshoptLayout& layout) {
    const bool is_known =
        layout.mode == "ATTRIBUTES" || layout.mode == "TRIANGLES" || layout.mode == "INDICES";
    if (!is_known || !has_valid_stride(layout))
        throw std::runtime_error("mode " + layout.mode + " with a stride of " +
                                 std::to_string(layout.stride));
    std::string values(layout.count * layout.stride, '\0');
    if (unpack(values, bytes, layout) != 0)
        throw std::runtime_error("damaged bytes");
    if (!apply_filter(values, layout))
        throw std::runtime_error("filter " + layout.filter + " with a stride of " +
                                 std::to_string(layout.stride));
    return values;
}

#else

std::string decode_meshopt_view(std::string_view, const MeshoptLayout&) {
    throw std::runtime_error("packed bytes, which this clrt was built without (libmeshoptimizer-dev)");
}

#endif

} // namespace clrt
