// SPDX-License-Identifier: Apache-2.0
#include "output/flat_pixels.h"

namespace clrt {

FlatPixels::FlatPixels(const Picture& picture, const std::string& path, size_t layer)
    : picture_(picture), radiance_(picture.layers[layer].values),
      alpha_(can_hold_alpha(path) ? picture_coverage(picture) : nullptr) {}

ImageLayout FlatPixels::layout(ChannelType type) const {
    ImageLayout layout;
    layout.width = layout.full_width = picture_.width;
    layout.height = layout.full_height = picture_.height;
    layout.channels = {{"R", type}, {"G", type}, {"B", type}};
    if (alpha_)
        layout.channels.push_back({"A", type});
    layout.unassociated_alpha = alpha_ != nullptr;
    return layout;
}

const std::vector<float>& FlatPixels::row(int y) {
    const size_t width = size_t(picture_.width), first = size_t(y) * width;
    row_.clear();
    for (size_t pixel = first; pixel < first + width; ++pixel) {
        const float alpha = alpha_ ? (*alpha_)[pixel] : 1;
        for (size_t c = 0; c < 3; ++c)
            row_.push_back(alpha > 0 ? radiance_[3 * pixel + c] / alpha : 0);
        if (alpha_)
            row_.push_back(alpha);
    }
    return row_;
}

} // namespace clrt
