// SPDX-License-Identifier: Apache-2.0
// A picture as 8-bit sRGB, row by row.
#pragma once

#include "output/flat_pixels.h"

#include <cstdint>
#include <vector>

namespace clrt {

/// Refers to the picture.
class DisplayRows {
public:
    /// `path` names the format; exposure in stops.
    DisplayRows(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap);

    /// 3, or 4 with unassociated alpha.
    int channels() const { return pixels_.channels(); }
    /// What an encoder is told.
    ImageLayout layout() const;
    /// Appends a row's pixels to `bytes`; 0 is at the top.
    void append(int y, std::vector<std::uint8_t>& bytes);

private:
    FlatPixels pixels_;
    double factor_;
    Tonemap tonemap_;
};

} // namespace clrt
