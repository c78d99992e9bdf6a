// SPDX-License-Identifier: Apache-2.0
// Path notation (Heckbert 1990): the text of an expression -> its positions, from which the automaton is
// built.
//   light     L any, La area, Lp point, Ld sun, Le environment
//   surface   D matte, G glossy, S specular (R mirror, T refraction), . any of them
//   eye       E, or C
//   operators | choice, * any number, + one or more, ? one or none, ( ) grouping; blanks mean nothing
// Written from the light (L...E) or from the eye (E...L). Where G does not occur, D means D or G.
#pragma once

#include <string>
#include <vector>

namespace clrt {

/// One letter of an expression and what it stands for; exactly one of `letters`, `kinds`, `is_eye` is set.
struct PathPosition {
    unsigned letters = 0; ///< bit 1 << LETTER_* of each letter it matches
    unsigned kinds = 0;   ///< KIND_*
    bool is_eye = false;
    size_t column = 0;          ///< in the text, from 0
    std::vector<int> following; ///< positions that can come next, walking from the eye; sorted
};

/// An expression as the automaton of its positions (Glushkov 1961), walked from the eye: every word starts
/// with one of `eyes`, goes over surfaces, and ends with a light.
struct PathExpression {
    std::string text;
    std::vector<PathPosition> positions;
    std::vector<int> eyes; ///< positions that are the eye; sorted
};

/// The longest expression that is read, characters.
constexpr size_t LONGEST_PATH_EXPRESSION = 500;

/// Reads an expression. Throws UsageError: what was expected and found, then the expression with a caret
/// under the offending character.
PathExpression parse_path_expression(const std::string& text);

} // namespace clrt
