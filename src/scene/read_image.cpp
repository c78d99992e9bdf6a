// SPDX-License-Identifier: Apache-2.0
#include "scene/read_image.h"

#include "error.h"
#include "scene/colour.h"

#include <algorithm>
#include <array>
#include <OpenImageIO/imageio.h>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// A texture is addressed by 32-bit words; a larger picture is refused before its memory is asked for.
constexpr std::uint64_t MOST_PIXELS = std::uint64_t(1) << 32;

/// Where r, g, b, a come from among the file's channels; -1: alpha is 1.
std::array<int, 4> channel_sources(const OIIO::ImageSpec& spec) {
    if (spec.nchannels >= 4)
        return {0, 1, 2, spec.alpha_channel >= 0 ? spec.alpha_channel : 3};
    if (spec.nchannels == 3)
        return {0, 1, 2, -1};
    return {0, 0, 0, spec.nchannels == 2 ? 1 : -1};
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

template <typename T>
std::vector<T> read_values(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                           const std::string& path) {
    std::vector<T> values(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
    if (!input.read_image(0, 0, 0, spec.nchannels, type, values.data()))
        throw SceneError(path, 0, "the picture cannot be read: " + input.geterror());
    return values;
}

void check_size(const OIIO::ImageSpec& spec, const std::string& path) {
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
        throw SceneError(path, 0, "the picture has no pixels");
    if (std::uint64_t(spec.width) * std::uint64_t(spec.height) * std::uint64_t(spec.nchannels) >= MOST_PIXELS)
        throw SceneError(path, 0,
                         "the picture is too large: " + std::to_string(spec.width) + "x" +
                             std::to_string(spec.height) + " pixels, expected fewer than 2^32 values");
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

Image read_image(const std::string& path, ImageEncoding encoding) {
    // Without this OpenImageIO multiplies the colours of PNG and others by alpha.
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(path, &config);
    if (!input)
        throw SceneError(path, 0, "the picture cannot be opened: " + OIIO::geterror());
    const OIIO::ImageSpec spec = input->spec();
    check_size(spec, path);

    Image image;
    image.width = spec.width;
    image.height = spec.height;
    image.has_alpha = spec.alpha_channel >= 0 || spec.nchannels == 2 || spec.nchannels == 4;
    image.is_grey = spec.nchannels <= 2;
    const std::array<int, 4> source = channel_sources(spec);
    const size_t channels = size_t(spec.nchannels);
    if (spec.format == OIIO::TypeDesc::UINT8) {
        const auto values = read_values<std::uint8_t>(*input, spec, OIIO::TypeDesc::UINT8, path);
        image.bytes = expand<std::uint8_t>(values, channels, source, 255);
    } else {
        const auto values = read_values<float>(*input, spec, OIIO::TypeDesc::FLOAT, path);
        const bool decode = encoding == ImageEncoding::COLOUR && !spec.format.is_floating_point();
        image.floats = to_linear(expand<float>(values, channels, source, 1.f), decode);
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
