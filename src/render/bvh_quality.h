// SPDX-License-Identifier: Apache-2.0
// Whether a render is long enough to pay for a better tree.
#pragma once

#include "bvh/bvh.h"
#include "options/options.h"

#include <cstddef>
#include <string>

namespace clrt {

/// A quality and the reason, for the report.
struct BvhQualityChoice {
    BvhQuality quality = BvhQuality::FAST;
    std::string reason; ///< "as chosen", or what was predicted
};

/// The tree's quality: as chosen with --bvh, else HIGH where the time that it is expected to save is more
/// than twice the time that it takes longer to build.
///
/// Predicted from the options and the number of triangles alone, never from measured times, so that the same
/// command builds the same tree everywhere:
///   render = --time, else pixels * spp * rays a sample * ns a ray (more for larger trees),
///            the smaller where both are given;
///   saved  = SAVED_SHARE of it;  extra = triangles * EXTRA_BUILD_NS.
/// Both sides shrink alike with more or faster cores. The constants are processor times of one core.
BvhQualityChoice choose_bvh_quality(const Options& options, size_t triangles);

} // namespace clrt
