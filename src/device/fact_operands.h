// SPDX-License-Identifier: Apache-2.0
// The numbers on which a device shows how it computes.
#pragma once

#include <vector>

namespace clrt {

/// FACT_COUNT operands of each kind. Every other quotient a / b and square root lies within a rounding of the
/// middle between two floats, where an approximation shows first.
struct FactOperands {
    std::vector<float> a, b, c; ///< of both signs, sizes from 2^-20 to 2^20; every other c nearly -a b
    std::vector<float> squares; ///< positive
    std::vector<float> units;   ///< in (0, 1)
    std::vector<float> numbers; ///< NaN, infinity, 0, -0, 1, 2.75
};

FactOperands make_fact_operands();

} // namespace clrt
