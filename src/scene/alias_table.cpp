// SPDX-License-Identifier: Apache-2.0
#include "scene/alias_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace clrt {
namespace {

constexpr double WORDS = 4294967296.0; // 2^32 values of a random word
constexpr u32 FULL = 0xffffffffu;

/// Weights scaled to a mean of 1. Dividing by the largest first keeps the sum from overflowing.
std::vector<double> scaled_to_mean_one(const std::vector<double>& weights, double largest) {
    double sum = 0;
    for (double weight : weights)
        sum += weight / largest;
    const double factor = double(weights.size()) / sum;
    std::vector<double> scaled(weights.size());
    std::transform(weights.begin(), weights.end(), scaled.begin(),
                   [&](double weight) { return weight / largest * factor; });
    return scaled;
}

/// A positive weight keeps at least one word, so that nothing with a weight becomes unreachable.
u32 threshold_of(double share, double weight) {
    if (weight <= 0)
        return 0;
    return u32(std::clamp(std::round(share * WORDS), 1.0, WORDS - 1));
}

/// Counts the (entry, word) pairs that choose each index: n 2^32 pairs in all, fewer than 2^64.
std::vector<double> exact_probabilities(const std::vector<AliasEntry>& entries) {
    std::vector<std::uint64_t> pairs(entries.size(), 0);
    for (size_t i = 0; i < entries.size(); ++i) {
        pairs[i] += entries[i].threshold;
        pairs[entries[i].alias] += (std::uint64_t(1) << 32) - entries[i].threshold;
    }
    std::vector<double> probability(entries.size());
    std::transform(pairs.begin(), pairs.end(), probability.begin(),
                   [&](std::uint64_t count) { return double(count) / WORDS / double(entries.size()); });
    return probability;
}

} // namespace

AliasTable build_alias_table(const std::vector<double>& weights) {
    AliasTable table;
    if (weights.empty())
        return table;
    assert(weights.size() < FULL);
    const auto heaviest = std::max_element(weights.begin(), weights.end());
    assert(*heaviest > 0 && std::isfinite(*heaviest));
    std::vector<double> share = scaled_to_mean_one(weights, *heaviest);

    // Part the entries by whether their share fills a whole place of the table.
    std::vector<u32> small, large;
    for (size_t i = 0; i < share.size(); ++i)
        (share[i] < 1 ? small : large).push_back(u32(i));

    // Fill each small entry's place with a piece of a large one, until one kind is used up.
    table.entries.resize(weights.size());
    while (!small.empty() && !large.empty()) {
        const u32 i = small.back(), donor = large.back();
        small.pop_back();
        table.entries[i] = {donor, threshold_of(share[i], weights[i])};
        share[donor] = (share[donor] + share[i]) - 1;
        if (share[donor] < 1) {
            large.pop_back();
            small.push_back(donor);
        }
    }

    // What remains fills its place up to rounding: k remaining shares below 1 still sum to k, so none is 0.
    for (const std::vector<u32>* rest : {&small, &large})
        for (u32 i : *rest) {
            assert(weights[i] > 0);
            table.entries[i] = {i, FULL};
        }
    table.probability = exact_probabilities(table.entries);
    return table;
}

} // namespace clrt
