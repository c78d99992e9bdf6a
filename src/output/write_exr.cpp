// SPDX-License-Identifier: Apache-2.0
// OpenEXR with layers and metadata.
#include "float_bits.h"
#include "output/image_stream.h"
#include "output/writers.h"

#include <algorithm>

namespace clrt {

namespace {

/// Rows handed to the encoder at once: four of OpenEXR's ZIP blocks.
constexpr int ROWS_AT_ONCE = 64;

ImageLayout exr_layout(const Picture& picture) {
    ImageLayout layout;
    // The window is the data window, the whole picture the display window.
    layout.width = picture.width;
    layout.height = picture.height;
    layout.x = picture.x0;
    layout.y = picture.y0;
    layout.full_width = picture.full_width;
    layout.full_height = picture.full_height;
    for (const Layer& layer : picture.layers)
        for (const std::string& channel : layer.channel_names)
            layout.channels.push_back({layer.name.empty() ? channel : layer.name + "." + channel,
                                       layer.is_id ? ChannelType::UINT32 : ChannelType::FLOAT});
    layout.attributes = {
        {"compression", "zip"}, {"oiio:ColorSpace", "Linear"}, {"Software", "clrt " CLRT_VERSION}};
    for (const auto& [name, value] : picture.metadata)
        layout.attributes.emplace_back("clrt." + name, value);
    for (const Layer& layer : picture.layers)
        layout.attributes.insert(layout.attributes.end(), layer.attributes.begin(), layer.attributes.end());
    return layout;
}

/// The 32 bits of a value in the file.
std::uint32_t word(float value, bool is_id) {
    if (is_id)
        return value > 0 ? static_cast<std::uint32_t>(value) : 0;
    return float_bits(value);
}

/// Puts the channels of rows [first, first + count) side by side, pixel by pixel.
void gather_rows(const Picture& picture, int first, int count, size_t channels,
                 std::vector<std::uint32_t>& words) {
    const size_t pixels = static_cast<size_t>(count) * static_cast<size_t>(picture.width);
    const size_t first_pixel = static_cast<size_t>(first) * static_cast<size_t>(picture.width);
    words.resize(pixels * channels);
    size_t channel = 0;
    for (const Layer& layer : picture.layers) {
        const size_t width = layer.channel_names.size();
        for (size_t i = 0; i < pixels; ++i)
            for (size_t c = 0; c < width; ++c)
                words[i * channels + channel + c] =
                    word(layer.values[(first_pixel + i) * width + c], layer.is_id);
        channel += width;
    }
}

} // namespace

void write_exr(const Picture& picture, const std::string& path) {
    const ImageLayout layout = exr_layout(picture);
    ImageStream stream(path, layout);
    std::vector<std::uint32_t> words;
    for (int row = 0; row < picture.height; row += ROWS_AT_ONCE) {
        const int count = std::min(ROWS_AT_ONCE, picture.height - row);
        gather_rows(picture, row, count, layout.channels.size(), words);
        stream.write_rows(row, count, words.data());
    }
    stream.finish();
}

} // namespace clrt
