// SPDX-License-Identifier: Apache-2.0
#include "options/summed_layers.h"

#include <algorithm>

namespace clrt {

namespace {

/// No name of NAME=EXPR has a dot.
const std::string STRATEGY = "strategy.";

PathLayerOption strategy_layer(int s, int t) {
    const std::string light = std::to_string(s), eye = std::to_string(t);
    return {STRATEGY + "s" + light + ".t" + eye, light + " vertices from a light, " + eye + " from the eye"};
}

} // namespace

int strategy_segments(const Options& options) {
    return std::min(options.output.strategies.value_or(0), effective_max_depth(options.transport));
}

std::vector<PathLayerOption> summed_layers(const Options& options) {
    const int longest = strategy_segments(options);
    if (longest == 0)
        return options.output.path_layers;
    std::vector<PathLayerOption> layers = {strategy_layer(0, 2)}; // a path of one segment is only ever met
    for (int segments = 2; segments <= longest; ++segments)
        for (int s = 0; s <= segments; ++s)
            layers.push_back(strategy_layer(s, segments + 1 - s));
    layers.push_back({STRATEGY + "longer", "paths of more than " + std::to_string(longest) + " segments"});
    return layers;
}

bool is_strategy_layer(const std::string& name) {
    return name.rfind(STRATEGY, 0) == 0;
}

} // namespace clrt
