// SPDX-License-Identifier: Apache-2.0
#include "render/scene_heaps.h"

#include <algorithm>
#include <numeric>

namespace clrt {

HeapPlan place_arrays(const std::vector<size_t>& sizes, size_t head) {
    HeapPlan plan;
    plan.places.resize(sizes.size());
    plan.bytes[0] = head;

    std::vector<size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return sizes[a] > sizes[b]; });

    for (const size_t i : order) {
        const auto emptiest = std::min_element(plan.bytes.begin(), plan.bytes.end());
        const size_t first = (*emptiest + SCENE_ALIGNMENT - 1) / SCENE_ALIGNMENT;
        plan.places[i] = {u32(emptiest - plan.bytes.begin()), u32(first), sizes[i] == 0 ? 1u : 0u, 0};
        *emptiest = first * SCENE_ALIGNMENT + sizes[i];
    }
    return plan;
}

} // namespace clrt
