// SPDX-License-Identifier: Apache-2.0
#include "device/fact_operands.h"

#include "kernels/shared/fact_types.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace clrt {

namespace {

/// A sequence of words that is the same everywhere (Wellons 2018, "lowbias32").
class Words {
public:
    std::uint32_t next() {
        std::uint32_t x = counter_++ * 0x9e3779b9u;
        x = (x ^ (x >> 16)) * 0x7feb352du;
        x = (x ^ (x >> 15)) * 0x846ca68bu;
        return x ^ (x >> 16);
    }
    /// In [1, 2), a float.
    double mantissa() { return 1 + (next() >> 9) / 8388608.0; }
    /// Of either sign, from 2^-20 to 2^20, a float.
    double number() {
        // One draw a statement: compilers evaluate arguments in either order.
        const int exponent = int(next() % 40) - 20;
        const double size = std::ldexp(mantissa(), exponent);
        return next() & 1u ? size : -size;
    }

private:
    std::uint32_t counter_ = 1;
};

/// A float between 1 and 2, and half a unit in its last place more.
double middle(Words& words) {
    return words.mantissa() + std::ldexp(1.0, -24);
}

} // namespace

FactOperands make_fact_operands() {
    FactOperands o;
    Words words;
    for (int i = 0; i < FACT_COUNT; ++i) {
        const bool is_hard = i % 2 != 0;
        const double b = words.number(), m = middle(words);
        o.b.push_back(float(b));
        o.a.push_back(float(is_hard ? b * m : words.number()));
        const double c = is_hard ? -double(o.a.back()) * b * (1 + 1e-6) : words.number();
        o.c.push_back(float(c));
        o.squares.push_back(float(is_hard ? m * m : std::abs(words.number())));
        o.units.push_back(float(((words.next() >> 8) | 1u) / 16777216.0));
    }
    const float infinity = std::numeric_limits<float>::infinity();
    o.numbers = {std::numeric_limits<float>::quiet_NaN(), infinity, 0.0f, -0.0f, 1.0f, 2.75f};
    return o;
}

} // namespace clrt
