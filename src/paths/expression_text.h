// SPDX-License-Identifier: Apache-2.0
// An automaton -> an expression of the path notation, by elimination of its states (Brzozowski and
// McCluskey 1963).
#pragma once

#include "kernels/shared/path_types.h"

#include <array>
#include <string>
#include <vector>

namespace clrt {

/// Sets of letters: one bit each.
constexpr unsigned MATTE = 1u << LETTER_MATTE, GLOSSY = 1u << LETTER_GLOSSY, MIRROR = 1u << LETTER_MIRROR,
                   REFRACTION = 1u << LETTER_REFRACTION;

/// One state of a deterministic automaton that reads the letters of surfaces from the light to the eye.
struct LightState {
    std::array<int, LETTER_COUNT> next{-1, -1, -1, -1}; ///< state after a letter; -1: none
    bool accepts = false;                               ///< the eye may come next
};

/// The words that are accepted from state 0 on, such as "S+D(D|S)*"; parentheses are around a choice. States
/// must be useful: reachable, and with a way to one that accepts. Letters stand for themselves, D for matte
/// or glossy where the notation allows it.
std::string surface_expression(const std::vector<LightState>& states);

} // namespace clrt
