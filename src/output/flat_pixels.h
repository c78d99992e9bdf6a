// SPDX-License-Identifier: Apache-2.0
// The pixels of formats without layers: linear R, G, B, and the coverage as unassociated alpha where a
// picture has it and the format holds it.
#pragma once

#include "output/image.h"

#include <OpenImageIO/imageio.h>
#include <string>
#include <vector>

namespace clrt {

/// Refers to the picture.
class FlatPixels {
public:
    /// `path` names the format.
    FlatPixels(const Picture& picture, const std::string& path);

    /// 3, or 4 with alpha.
    int channels() const { return alpha_ ? 4 : 3; }
    /// The spec of a file of such pixels.
    OIIO::ImageSpec spec(OIIO::TypeDesc type) const;
    /// A row of pixels, 0 at the top. With alpha, colours are those of what covers the pixel, black where
    /// nothing does.
    const std::vector<float>& row(int y);

private:
    const Picture& picture_;
    const std::vector<float>* alpha_ = nullptr; ///< layer "A"; none: opaque
    std::vector<float> row_;
};

} // namespace clrt
