// SPDX-License-Identifier: Apache-2.0
// The smallest deterministic automaton of path expressions over the letters that a scene has. It walks from
// the eye, as the path tracer does, so a path carries one number.
#pragma once

#include "kernels/shared/path_types.h"
#include "paths/path_expression.h"

#include <array>
#include <optional>
#include <vector>

namespace clrt {

/// What can occur in a scene.
struct PathAlphabet {
    unsigned letters = 0; ///< bit 1 << LETTER_*
    unsigned kinds = 0;   ///< KIND_*
};

/// One state, reached after some scattering events.
struct AutomatonState {
    std::array<int, LETTER_COUNT> next{};             ///< index of the state after a letter; 0: dead
    unsigned kinds = 0;                               ///< KIND_* that end an accepted path here
    std::array<unsigned, PATH_LAYERS_LIMIT> layers{}; ///< the same for each layer; parts of `kinds`
    int distance = 0;                                 ///< fewest letters up to a state with kinds
    int picture = 0; ///< equal for states that the picture alone does not tell apart
};

/// States by index: 0 is dead, 1 the start, unless no path is accepted and there is none but 0.
struct Automaton {
    std::vector<AutomatonState> states;

    bool is_empty() const { return states.size() < 2; }
};

/// Most states that the tables hold besides the dead one.
constexpr size_t AUTOMATON_STATES_LIMIT = STATES_LIMIT;

/// The automaton that accepts the picture's paths and tells which layers they belong to; a layer holds no
/// other paths than the picture does. Throws UsageError beyond AUTOMATON_STATES_LIMIT states.
Automaton make_automaton(const PathExpression& picture, const std::vector<PathExpression>& layers,
                         const PathAlphabet& alphabet);

/// The longest accepted path in scattering events; none if there is no longest.
std::optional<int> longest_path(const Automaton& automaton);

/// Whether everything in the alphabet is accepted and no layer tells paths apart.
bool accepts_everything(const Automaton& automaton, const PathAlphabet& alphabet);

} // namespace clrt
