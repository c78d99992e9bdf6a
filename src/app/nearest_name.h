// SPDX-License-Identifier: Apache-2.0
// "Did you mean": the known name that is closest to a mistyped one.
#pragma once

#include <string>
#include <vector>

namespace clrt {

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment distance, Damerau 1964).
int edit_distance(const std::string& a, const std::string& b);

/// The known name with the smallest distance; a name that starts with `typed` is nearer than any other.
/// The first of equals wins. `known` is not empty.
std::string nearest_name(const std::string& typed, const std::vector<std::string>& known);

/// Whether `name` starts with `typed` or at most every third letter is wrong; dashes in front are no letters.
bool is_misspelling(const std::string& typed, const std::string& name);

} // namespace clrt
