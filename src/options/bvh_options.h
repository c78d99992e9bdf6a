// SPDX-License-Identifier: Apache-2.0
// The tree of boxes.
#pragma once

#include "kernels/shared/bvh_types.h"
#include "options/names.h"

#include <optional>

namespace clrt {

/// How nodes and leaves lie in the device's memory (kernels/shared/bvh_types.h).
enum class BvhLayout { BVH8 = BVH_LAYOUT_BVH8, BVH2 = BVH_LAYOUT_BVH2, CWBVH = BVH_LAYOUT_CWBVH };

template <>
inline constexpr Named<BvhLayout> NAMES<BvhLayout>[] = {
    {BvhLayout::BVH8, "bvh8"}, {BvhLayout::BVH2, "bvh2"}, {BvhLayout::CWBVH, "cwbvh"}};

/// How much work goes into the tree. HIGH builds about three times as long: more rounds of reinsertion, and a
/// second tree with spatial splits, which is kept where it is cheaper, as among long thin triangles.
enum class BvhQuality { FAST, HIGH };

template <>
inline constexpr Named<BvhQuality> NAMES<BvhQuality>[] = {{BvhQuality::FAST, "fast"},
                                                          {BvhQuality::HIGH, "high"}};

struct BvhOptions {
    std::optional<BvhLayout> layout;   ///< none: the device's best
    std::optional<BvhQuality> quality; ///< none: high where a long render pays for it
};

} // namespace clrt
