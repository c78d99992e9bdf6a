// SPDX-License-Identifier: Apache-2.0
// Random inputs of probes that sample lights.
#pragma once

#include "probes/random_inputs.h"

#include <vector>

namespace clrt {

/// Positions with second numbers, and words; the words are only moved, so NaN patterns stay what they are.
struct LightNumbers {
    std::vector<vec4> positions, words;
};

/// So many for one position; a seed always gives the same.
inline LightNumbers light_numbers_at(const glm::dvec3& position, size_t count, u32 seed) {
    Random random(seed);
    LightNumbers numbers;
    for (size_t i = 0; i < count; ++i) {
        const u32 word = random.word(), alias = random.word();
        numbers.words.push_back({bits_to_float(word), bits_to_float(alias), 0, 0});
        numbers.positions.push_back(to_vec4(position, random.unit()));
    }
    return numbers;
}

} // namespace clrt
