// SPDX-License-Identifier: Apache-2.0
// The tree of boxes.
#pragma once

namespace clrt {

enum class BvhChoice { AUTO, BVH8, BVH2, CWBVH };
enum class QualityChoice { AUTO, FAST, HIGH };

struct BvhOptions {
    BvhChoice layout = BvhChoice::AUTO;
    QualityChoice quality = QualityChoice::AUTO; ///< work put into the tree
};

} // namespace clrt
