// SPDX-License-Identifier: Apache-2.0
// A plan of paths in words and as JSON: for the report, --explain and files.
#pragma once

#include "paths/path_plan.h"

#include <nlohmann/json.hpp>
#include <string>

namespace clrt {

/// One line: the expression, the number of states, the longest path; or that nothing matches, and why.
std::string path_summary(const PathPlan& plan);

/// The paragraph of --explain: letters with their witnesses, then the states.
std::string format_paths(const PathPlan& plan);

/// Expressions, layers, the scene's letters, and the automaton's size.
nlohmann::ordered_json paths_json(const PathPlan& plan);

} // namespace clrt
