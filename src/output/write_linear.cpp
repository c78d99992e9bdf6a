// SPDX-License-Identifier: Apache-2.0
// Linear pictures without layers.
#include "output/flat_pixels.h"
#include "output/image_stream.h"
#include "output/standard_streams.h"
#include "output/writers.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// Radiance HDR stores powers of two up to 2^127.
constexpr float LARGEST_HDR = 1e38f;

float storable_in_hdr(float x) {
    return x > 0 ? std::fmin(x, LARGEST_HDR) : 0;
}

} // namespace

void write_linear(const Picture& picture, const std::string& path) {
    FlatPixels pixels(picture, path);
    ImageLayout layout = pixels.layout(ChannelType::FLOAT);
    layout.attributes.emplace_back("oiio:ColorSpace", "Linear");
    ImageStream stream(path, layout);
    const bool is_hdr = output_format(path) == "hdr";
    for (int y = 0; y < picture.height; ++y) {
        std::vector<float> row = pixels.row(y);
        if (is_hdr)
            std::transform(row.begin(), row.end(), row.begin(), storable_in_hdr);
        stream.write_rows(y, 1, row.data());
    }
    stream.finish();
}

void write_pfm(const Picture& picture, const std::string& path) {
    // "PF" is RGB; the sign of the scale tells the byte order, negative for little-endian. Rows go from the
    // bottom up.
    const std::string header = "PF\n" + std::to_string(picture.width) + " " + std::to_string(picture.height) +
                               "\n" + (__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "-1.0\n" : "1.0\n");
    const std::unique_ptr<OutputFile> file = open_output(path);
    file->write_at(header.data(), header.size(), 0);
    const size_t row_length = 3 * static_cast<size_t>(picture.width), row_bytes = row_length * sizeof(float);
    auto position = static_cast<std::int64_t>(header.size());
    for (int y = picture.height - 1; y >= 0; --y, position += static_cast<std::int64_t>(row_bytes))
        file->write_at(picture.layers[0].values.data() + static_cast<size_t>(y) * row_length, row_bytes,
                       position);
    file->commit();
}

} // namespace clrt
