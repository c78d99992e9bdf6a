// SPDX-License-Identifier: Apache-2.0
// Which light is simulated.
#pragma once

#include <optional>
#include <string>

namespace clrt {

enum class Integrator { RAYCAST, WHITTED, PATH };

struct TransportOptions {
    Integrator integrator = Integrator::PATH;
    std::optional<int> max_depth;    ///< path segments; 4096, whitted 10, raycast always 2
    int roulette_depth = 5;          ///< path: first segment that Russian roulette may end
    double min_contribution = 0.002; ///< whitted: smallest weight worth a ray
    std::string paths;               ///< path notation (paths/path_expression.h); empty: every path
};

/// Segments of the longest path when --max-depth does not say: Russian roulette ends paths long before, and
/// where nothing ends them, because surfaces reflect all light, this does within milliseconds.
constexpr int DEFAULT_PATH_DEPTH = 4096;
/// The same for whitted, whose trees can double with every segment.
constexpr int DEFAULT_WHITTED_DEPTH = 10;

/// The largest path length in segments for these options; raycast has always 2.
int effective_max_depth(const TransportOptions& transport);

} // namespace clrt
