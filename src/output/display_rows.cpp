// SPDX-License-Identifier: Apache-2.0
#include "output/display_rows.h"

#include "output/tonemap.h"

#include <cmath>

namespace clrt {

DisplayRows::DisplayRows(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap)
    : pixels_(picture, path, picture.displayed), factor_(std::exp2(exposure_ev)), tonemap_(tonemap) {}

ImageLayout DisplayRows::layout() const {
    ImageLayout layout = pixels_.layout(ChannelType::UINT8);
    layout.attributes.emplace_back("oiio:ColorSpace", "sRGB");
    return layout;
}

void DisplayRows::append(int y, std::vector<std::uint8_t>& bytes) {
    const std::vector<float>& row = pixels_.row(y);
    const size_t width = size_t(channels());
    for (size_t i = 0; i < row.size(); i += width) {
        for (const std::uint8_t byte : display_colour({row[i], row[i + 1], row[i + 2]}, factor_, tonemap_))
            bytes.push_back(byte);
        if (width == 4)
            bytes.push_back(std::uint8_t(std::lround(255 * row[i + 3])));
    }
}

} // namespace clrt
