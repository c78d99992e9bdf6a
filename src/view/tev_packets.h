// SPDX-License-Identifier: Apache-2.0
// Packets of tev's protocol (tev 1.x and 2.x, Ipc.h): little endian, a length that counts itself, a type, a
// payload; strings end in NUL.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace clrt {

/// A picture in tev: its name, by which it is updated, and its channels.
struct TevImage {
    std::string name;
    int width = 0, height = 0;
    std::vector<std::string> channels;
};

/// Makes the image, or makes it anew, and selects it.
std::string tev_create(const TevImage& image);

/// Rows [y, y + rows) of the image: channels side by side, pixel by pixel.
std::string tev_update(const TevImage& image, int y, int rows, const std::vector<float>& values);

} // namespace clrt
