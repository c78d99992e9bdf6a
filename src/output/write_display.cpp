// SPDX-License-Identifier: Apache-2.0
// 8-bit sRGB pictures.
#include "output/flat_pixels.h"
#include "output/image_stream.h"
#include "output/tonemap.h"
#include "output/writers.h"

#include <cmath>

namespace clrt {

void write_display(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap) {
    FlatPixels pixels(picture, path);
    OIIO::ImageSpec spec = pixels.spec(OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (const std::string format = output_format(path); format == "jpg" || format == "jpeg") {
        spec.attribute("Compression", "jpeg:98");    // quality, of 100
        spec.attribute("jpeg:subsampling", "4:4:4"); // full resolution of colours
    }
    ImageStream stream(path, spec);

    const double factor = std::exp2(exposure_ev);
    const size_t channels = size_t(pixels.channels());
    std::vector<std::uint8_t> bytes;
    for (int y = 0; y < picture.height; ++y) {
        const std::vector<float>& row = pixels.row(y);
        bytes.clear();
        for (size_t i = 0; i < row.size(); i += channels) {
            for (const std::uint8_t byte : display_colour({row[i], row[i + 1], row[i + 2]}, factor, tonemap))
                bytes.push_back(byte);
            if (channels == 4)
                bytes.push_back(std::uint8_t(std::lround(255 * row[i + 3])));
        }
        stream.write_rows(y, 1, OIIO::TypeUInt8, bytes.data());
    }
    stream.finish();
}

} // namespace clrt
