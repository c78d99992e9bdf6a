// SPDX-License-Identifier: Apache-2.0
#include "view/page_picture.h"

#include "output/tonemap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>

namespace clrt {

namespace {

using Colour = std::array<std::uint8_t, 3>;

/// From dark blue over red to pale yellow, each lighter than the one before.
constexpr Colour ERROR_COLOURS[] = {{10, 12, 30},  {38, 24, 92},   {92, 28, 120},  {150, 42, 112},
                                    {206, 70, 84}, {240, 122, 60}, {250, 184, 82}, {252, 246, 190}};
constexpr size_t ERROR_COLOUR_COUNT = sizeof ERROR_COLOURS / sizeof ERROR_COLOURS[0];
/// The picture's error times and over this are the ends of the scale.
constexpr double ERROR_SPAN = 10;

void append_whole(std::string& bytes, std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i)
        bytes += char(value >> (8 * i) & 0xff);
}

/// Every so many pixels and rows of a picture are shown.
size_t page_step(const Snapshot& snapshot, size_t most_pixels) {
    size_t step = 1;
    const auto across = [&](int side) { return (size_t(side) + step - 1) / step; };
    while (across(snapshot.width) * across(snapshot.height) > most_pixels)
        ++step;
    return step;
}

/// A BMP of 24 bits a pixel: BITMAPFILEHEADER, BITMAPINFOHEADER, rows from the top (negative height) in steps
/// of four bytes, blue first.
std::string encode_bmp(const Snapshot& snapshot, size_t step,
                       const std::function<Colour(size_t pixel)>& colour_of) {
    constexpr std::uint32_t HEADERS = 54, INFO_HEADER = 40, BITS = 24;
    const size_t width = (size_t(snapshot.width) + step - 1) / step;
    const size_t height = (size_t(snapshot.height) + step - 1) / step;
    const size_t row_bytes = (width * 3 + 3) / 4 * 4;
    const auto total = std::uint32_t(HEADERS + row_bytes * height);
    std::string bytes = "BM";
    bytes.reserve(total);
    append_whole(bytes, total, 4);
    append_whole(bytes, 0, 4);
    append_whole(bytes, HEADERS, 4);
    append_whole(bytes, INFO_HEADER, 4);
    append_whole(bytes, std::uint32_t(width), 4);
    append_whole(bytes, ~std::uint32_t(height) + 1, 4);
    append_whole(bytes, 1, 2);
    append_whole(bytes, BITS, 2);
    bytes.resize(HEADERS, '\0'); // no compression, sizes follow, no palette
    for (size_t y = 0; y < height; ++y) {
        for (size_t x = 0; x < width; ++x) {
            const Colour colour = colour_of(y * step * size_t(snapshot.width) + x * step);
            bytes += char(colour[2]);
            bytes += char(colour[1]);
            bytes += char(colour[0]);
        }
        bytes.resize(HEADERS + (y + 1) * row_bytes, '\0');
    }
    return bytes;
}

/// At `place` from 0 to 1 of the scale.
Colour error_colour(double place) {
    const double at = std::clamp(place, 0.0, 1.0) * double(ERROR_COLOUR_COUNT - 1);
    const size_t low = std::min(size_t(at), ERROR_COLOUR_COUNT - 2);
    Colour colour{};
    for (size_t c = 0; c < 3; ++c) {
        const double a = ERROR_COLOURS[low][c], b = ERROR_COLOURS[low + 1][c];
        colour[c] = std::uint8_t(std::lround(a + (at - double(low)) * (b - a)));
    }
    return colour;
}

} // namespace

std::string page_picture(const Snapshot& snapshot, double exposure_ev, Tonemap tonemap, size_t most_pixels) {
    const double factor = std::exp2(exposure_ev);
    return encode_bmp(snapshot, page_step(snapshot, most_pixels), [&](size_t pixel) {
        const float* rgb = &snapshot.rgb[3 * pixel];
        return display_colour({rgb[0], rgb[1], rgb[2]}, factor, tonemap);
    });
}

std::optional<ErrorScale> error_scale(const Snapshot& snapshot) {
    if (snapshot.errors.empty() || !snapshot.error || !(snapshot.error->relative_rmse > 0))
        return std::nullopt;
    const double error = snapshot.error->relative_rmse;
    ErrorScale scale{error / ERROR_SPAN, error * ERROR_SPAN, {}};
    for (const Colour& colour : ERROR_COLOURS)
        scale.colours.push_back(fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]));
    return scale;
}

std::string page_error_map(const Snapshot& snapshot, size_t most_pixels) {
    const std::optional<ErrorScale> scale = error_scale(snapshot);
    const double span = scale ? std::log(scale->high / scale->low) : 1;
    return encode_bmp(snapshot, page_step(snapshot, most_pixels), [&](size_t pixel) {
        const double error = scale ? double(snapshot.errors[pixel]) : 0;
        return error > 0 ? error_colour(std::log(error / scale->low) / span) : Colour{};
    });
}

} // namespace clrt
