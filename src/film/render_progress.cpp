// SPDX-License-Identifier: Apache-2.0
#include "film/render_progress.h"

#include "kernels/shared/render_types.h"

#include <algorithm>

namespace clrt {

void RenderCounts::add(const RenderCounts& other) {
    primary += other.primary;
    secondary += other.secondary;
    shadow += other.shadow;
    cut_paths += other.cut_paths;
    cut_weight += other.cut_weight;
    outline_pixels = std::max(outline_pixels, other.outline_pixels);
    nan += other.nan;
    infinite += other.infinite;
    negative += other.negative;
    overflow += other.overflow;
    for (const auto& [pixel, count] : other.bad_pixels)
        bad_pixels[pixel] += count;
    bad_samples.insert(bad_samples.end(), other.bad_samples.begin(), other.bad_samples.end());
    std::sort(bad_samples.begin(), bad_samples.end(), [](const auto& a, const auto& b) {
        return std::pair(a.second, a.first) < std::pair(b.second, b.first);
    });
    bad_samples.resize(std::min<size_t>(bad_samples.size(), REPLAY_CAPACITY));
}

} // namespace clrt
