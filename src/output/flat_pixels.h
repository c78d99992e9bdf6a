// SPDX-License-Identifier: Apache-2.0
// The pixels of formats without layers: linear R, G, B, and the coverage as unassociated alpha where a
// picture has it and the format holds it.
#pragma once

#include "images/image_library.h"
#include "output/image.h"

#include <string>
#include <vector>

namespace clrt {

/// Refers to the picture.
class FlatPixels {
public:
    /// `path` names the format, `layer` the radiance among the picture's layers.
    FlatPixels(const Picture& picture, const std::string& path, size_t layer = 0);

    /// 3, or 4 with alpha.
    int channels() const { return alpha_ ? 4 : 3; }
    /// What an encoder of such pixels is told.
    ImageLayout layout(ChannelType type) const;
    /// A row of pixels, 0 at the top. With alpha, colours are those of what covers the pixel, black where
    /// nothing does.
    const std::vector<float>& row(int y);

private:
    const Picture& picture_;
    const std::vector<float>& radiance_;
    const std::vector<float>* alpha_ = nullptr; ///< layer "A"; none: opaque
    std::vector<float> row_;
};

} // namespace clrt
