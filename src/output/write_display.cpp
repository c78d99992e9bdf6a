// SPDX-License-Identifier: Apache-2.0
// 8-bit sRGB pictures but for PNG.
#include "output/display_rows.h"
#include "output/image_stream.h"
#include "output/writers.h"

namespace clrt {

void write_display(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap) {
    DisplayRows rows(picture, path, exposure_ev, tonemap);
    ImageLayout layout = rows.layout();
    if (const std::string format = output_format(path); format == "jpg" || format == "jpeg") {
        layout.attributes.emplace_back("Compression", "jpeg:98");    // quality, of 100
        layout.attributes.emplace_back("jpeg:subsampling", "4:4:4"); // full resolution of colours
    }
    ImageStream stream(path, layout);
    std::vector<std::uint8_t> bytes;
    for (int y = 0; y < picture.height; ++y) {
        bytes.clear();
        rows.append(y, bytes);
        stream.write_rows(y, 1, bytes.data());
    }
    stream.finish();
}

} // namespace clrt
