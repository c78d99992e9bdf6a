// SPDX-License-Identifier: Apache-2.0
// Where the scene's arrays lie in the few buffers that kernels take them from.
#pragma once

#include "kernels/shared/scene_arrays.h"

#include <array>
#include <cstddef>
#include <vector>

namespace clrt {

/// The places of some arrays, and the bytes of each heap.
struct HeapPlan {
    std::vector<ArrayPlace> places;             ///< in the order of the arrays
    std::array<size_t, SCENE_HEAPS> bytes = {}; ///< with the unused ones before aligned beginnings
};

/// Places arrays of these many bytes, the largest first, each in the heap that is the emptiest, so that no
/// heap exceeds what a device allows as long as any way to place them does not either (SCENE_HEAPS). Heap 0
/// begins with `head` bytes of something else. A function of the sizes alone.
HeapPlan place_arrays(const std::vector<size_t>& sizes, size_t head);

} // namespace clrt
