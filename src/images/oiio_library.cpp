// SPDX-License-Identifier: Apache-2.0
// What is loaded: the function that image_library() looks up.
#include "images/oiio_decoder.h"
#include "images/oiio_encoder.h"

namespace clrt {

namespace {

class OiioLibrary final : public ImageLibrary {
public:
    std::unique_ptr<ImageEncoder> encode(const std::string& path, const std::string& format,
                                         const ImageLayout& layout, OutputFile& file) const override {
        return std::make_unique<OiioEncoder>(path, format, layout, file);
    }
    StoredImage read(const std::string& path, const std::string* bytes) const override {
        return read_by_oiio(path, bytes);
    }
};

} // namespace

} // namespace clrt

/// Named by IMAGE_LIBRARY_ENTRY.
extern "C" __attribute__((visibility("default"))) const clrt::ImageLibrary* clrt_image_library_2() {
    static const clrt::OiioLibrary library;
    return &library;
}
