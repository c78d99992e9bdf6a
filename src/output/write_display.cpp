// SPDX-License-Identifier: Apache-2.0
// 8-bit sRGB pictures.
#include "output/image_stream.h"
#include "output/tonemap.h"
#include "output/writers.h"

#include <cmath>

namespace clrt {

void write_display(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap) {
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (const std::string format = output_format(path); format == "jpg" || format == "jpeg") {
        spec.attribute("Compression", "jpeg:98");    // quality, of 100
        spec.attribute("jpeg:subsampling", "4:4:4"); // full resolution of colours
    }
    ImageStream stream(path, spec);

    const double factor = std::exp2(exposure_ev);
    const float* radiance = picture.layers[0].values.data();
    std::vector<std::uint8_t> row;
    for (int y = 0; y < picture.height; ++y) {
        row.clear();
        for (int x = 0; x < picture.width; ++x, radiance += 3)
            for (const std::uint8_t byte :
                 display_colour({radiance[0], radiance[1], radiance[2]}, factor, tonemap))
                row.push_back(byte);
        stream.write_rows(y, 1, OIIO::TypeUInt8, row.data());
    }
    stream.finish();
}

} // namespace clrt
