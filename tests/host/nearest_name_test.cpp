// SPDX-License-Identifier: Apache-2.0
// The name that was meant.
#include "app/nearest_name.h"

#include <gtest/gtest.h>

namespace clrt {

TEST(NearestName, CountsEditsAndSwaps) {
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("abc", "abc"), 0);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
    EXPECT_EQ(edit_distance("szie", "size"), 1);
    EXPECT_EQ(edit_distance("ab", "ba"), 1);
    EXPECT_EQ(nearest_name("tent", {"box", "rent", "tents"}), "tents");
}

} // namespace clrt
