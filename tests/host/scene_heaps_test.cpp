// SPDX-License-Identifier: Apache-2.0
// Arrays in heaps: aligned, apart, and in no heap larger than a device that they fit on allows.
#include "render/scene_heaps.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

using namespace clrt;

namespace {

/// Bytes that a device of four times as much memory allows for one buffer.
constexpr size_t LARGEST = size_t{1} << 30;

size_t largest_heap(const std::vector<size_t>& sizes, size_t head = 0) {
    const HeapPlan plan = place_arrays(sizes, head);
    return *std::max_element(plan.bytes.begin(), plan.bytes.end());
}

/// Arrays of at most LARGEST bytes that together fit `memory`: some of all sizes, some alike.
std::vector<size_t> random_sizes(std::mt19937& random, size_t memory) {
    std::uniform_real_distribution<double> unit(0, 1);
    const double scale = unit(random), spread = unit(random);
    std::vector<size_t> sizes;
    for (size_t total = 0; sizes.size() < 20;) {
        const auto size = size_t(double(LARGEST) * (scale + (1 - scale) * spread * unit(random)));
        const size_t aligned = size / SCENE_ALIGNMENT * SCENE_ALIGNMENT;
        if (total + aligned > memory)
            break;
        sizes.push_back(aligned);
        total += aligned;
    }
    return sizes;
}

} // namespace

TEST(SceneHeaps, ArraysAreAlignedAndApart) {
    std::mt19937 random(1);
    std::uniform_int_distribution<size_t> bytes(0, 5000);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<size_t> sizes(30);
        for (size_t& size : sizes)
            size = bytes(random);
        const size_t head = bytes(random);
        const HeapPlan plan = place_arrays(sizes, head);

        ASSERT_EQ(plan.places.size(), sizes.size());
        std::vector<std::vector<std::pair<size_t, size_t>>> spans(SCENE_HEAPS);
        spans[0].emplace_back(0, head);
        for (size_t i = 0; i < sizes.size(); ++i) {
            ASSERT_LT(plan.places[i].heap, u32(SCENE_HEAPS));
            const size_t first = size_t(plan.places[i].first) * SCENE_ALIGNMENT;
            EXPECT_LE(first + sizes[i], plan.bytes[plan.places[i].heap]);
            spans[plan.places[i].heap].emplace_back(first, first + sizes[i]);
        }
        for (auto& span : spans) {
            std::sort(span.begin(), span.end());
            for (size_t i = 1; i < span.size(); ++i)
                EXPECT_LE(span[i - 1].second, span[i].first);
        }
    }
}

TEST(SceneHeaps, LargeArraysHaveHeapsOfTheirOwn) {
    const HeapPlan plan = place_arrays({1, 7000, 10, 6000, 5000, 4000, 3000, 2000, 20}, 64);
    std::vector<size_t> arrays_of(SCENE_HEAPS, 0);
    for (const ArrayPlace& place : plan.places)
        ++arrays_of[place.heap];
    for (const size_t large : {1, 3, 4, 5, 6, 7})
        EXPECT_EQ(arrays_of[plan.places[large].heap], 1u) << large;
    EXPECT_EQ(arrays_of[0], 3u) << "the small ones";
}

TEST(SceneHeaps, WhatFitsTheMemoryFitsTheHeaps) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 20000; ++trial) {
        const std::vector<size_t> sizes = random_sizes(random, 4 * LARGEST);
        EXPECT_LE(largest_heap(sizes), LARGEST) << trial;
    }
    const size_t above_half = LARGEST / 2 + SCENE_ALIGNMENT;
    EXPECT_LE(largest_heap(std::vector<size_t>(7, above_half)), LARGEST);
    EXPECT_GT(largest_heap(std::vector<size_t>(8, above_half)), LARGEST) << "more than the memory";
}

TEST(SceneHeaps, BeginningsReachBeyondFourGibibytes) {
    const size_t size = size_t{3} << 30;
    const HeapPlan plan = place_arrays(std::vector<size_t>(3 * SCENE_HEAPS, size), 0);
    EXPECT_EQ(size_t(plan.places.back().first) * SCENE_ALIGNMENT, 2 * size);
    EXPECT_EQ(plan.bytes[0], 3 * size);
}
