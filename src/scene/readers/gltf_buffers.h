// SPDX-License-Identifier: Apache-2.0
// The bytes that a glTF file refers to: its buffers, views of them, and the files of pictures.
#pragma once

#include "output/named_file.h"
#include "scene/readers/gltf_file.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace clrt {

/// A part of a buffer, unpacked; valid as long as the GltfBuffers.
struct GltfView {
    std::string_view bytes;
    size_t stride = 0; ///< between elements; 0: they follow one another
};

/// Loads buffers as they are asked for. Everything throws SceneError: JSON path, expected, found.
class GltfBuffers {
public:
    /// `opened` gets the files beside the glTF file; all outlive this.
    GltfBuffers(const GltfFile& file, std::vector<NamedFile>& opened) : file_(file), opened_(opened) {}

    const GltfFile& file() const { return file_; }

    /// The buffer view of an index; where EXT_meshopt_compression packs it, unpacked.
    GltfView view(const JsonValue& index);

private:
    std::string_view buffer(const JsonValue& index);
    std::string load(const JsonValue& buffer);
    std::string_view part(const JsonValue& range);
    GltfView unpack(const JsonValue& view, const JsonValue& packing);

    const GltfFile& file_;
    std::vector<NamedFile>& opened_;
    std::map<size_t, std::string> buffers_;       // by index; the GLB's own is not among them
    std::map<std::string, std::string> unpacked_; // by the view's path
};

/// The path of a file that a uri names, relative to the glTF file's folder. Throws for absolute paths, other
/// schemes and paths that lead out of the folder.
std::string gltf_file_name(const JsonValue& uri);

/// Whether a uri holds its bytes itself.
bool is_data_uri(const std::string& uri);

/// The bytes of a data: uri in base64.
std::string data_uri_bytes(const JsonValue& uri);

} // namespace clrt
