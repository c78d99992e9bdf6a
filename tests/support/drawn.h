// SPDX-License-Identifier: Apache-2.0
// What the suite tests of more than it has time for: a share, drawn by the kernels. The same kernels draw the
// same, and after every change of one it is another. With CLRT_TEST_LONG all are tested, and so are kernels
// with planted faults (CLRT_TEST_KERNELS).
#pragma once

#include "support/test_device.h"

#include <cstddef>
#include <vector>

namespace clrt {

/// A number below `count` by a hash of the embedded kernels.
size_t drawn_number(size_t count);

/// Every share-th of some, from a drawn one on, or all.
template <typename T>
std::vector<T> drawn(const std::vector<T>& all, size_t share) {
    if (tests_are_long() || !test_kernels_folder().empty())
        return all;
    std::vector<T> some;
    for (size_t i = drawn_number(share); i < all.size(); i += share)
        some.push_back(all[i]);
    return some;
}

} // namespace clrt
