// SPDX-License-Identifier: Apache-2.0
#include "scene/read_image.h"

#include "colour.h"
#include "images/image_library.h"

#include <algorithm>
#include <array>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// Where r, g, b, a come from among the file's channels; -1: alpha is 1.
std::array<int, 4> channel_sources(const StoredImage& stored) {
    if (stored.channels >= 4)
        return {0, 1, 2, stored.alpha_channel >= 0 ? stored.alpha_channel : 3};
    if (stored.channels == 3)
        return {0, 1, 2, -1};
    return {0, 0, 0, stored.channels == 2 ? 1 : -1};
}

/// Expands pixels of `channels` values to RGBA.
template <typename T>
std::vector<T> expand(const std::vector<T>& file, size_t channels, const std::array<int, 4>& source,
                      T opaque) {
    std::vector<T> rgba(file.size() / channels * 4);
    for (size_t i = 0; i < rgba.size(); ++i) {
        const int from = source[i % 4];
        rgba[i] = from < 0 ? opaque : file[i / 4 * channels + size_t(from)];
    }
    return rgba;
}

std::vector<vec4> to_linear(const std::vector<float>& rgba, bool decode) {
    std::vector<vec4> linear(rgba.size() / 4);
    tbb::parallel_for(size_t(0), linear.size(), [&](size_t i) {
        const auto value = [&](size_t c) {
            return decode ? float(srgb_to_linear(double(rgba[4 * i + c]))) : rgba[4 * i + c];
        };
        linear[i] = {value(0), value(1), value(2), rgba[4 * i + 3]};
    });
    return linear;
}

} // namespace

Image read_image(const std::string& path, ImageEncoding encoding, const std::string* bytes) {
    const StoredImage stored = image_library().read(path, bytes);
    Image image;
    image.width = stored.width;
    image.height = stored.height;
    image.has_alpha = stored.alpha_channel >= 0 || stored.channels == 2 || stored.channels == 4;
    image.is_grey = stored.channels <= 2;
    const std::array<int, 4> source = channel_sources(stored);
    const size_t channels = size_t(stored.channels);
    if (!stored.bytes.empty()) {
        image.bytes = expand<std::uint8_t>(stored.bytes, channels, source, 255);
    } else {
        const bool decode = encoding == ImageEncoding::COLOUR && !stored.is_floating_point;
        image.floats = to_linear(expand<float>(stored.floats, channels, source, 1.f), decode);
    }
    return image;
}

FloatImage read_float_image(const std::string& path, ImageEncoding encoding) {
    Image image = read_image(path, encoding);
    if (image.floats.empty()) {
        std::vector<float> values(image.bytes.size());
        std::transform(image.bytes.begin(), image.bytes.end(), values.begin(),
                       [](std::uint8_t byte) { return float(byte) / 255.f; });
        image.floats = to_linear(values, encoding == ImageEncoding::COLOUR);
    }
    return {image.width, image.height, std::move(image.floats)};
}

} // namespace clrt
