// SPDX-License-Identifier: Apache-2.0
// The layers that a film sums beside its picture, in the order of its planes: --aov NAME=EXPR or strategies.
#pragma once

#include "options/options.h"

#include <string>
#include <vector>

namespace clrt {

/// Segments up to which --aov strategies tells paths apart, where it does not say, and at most: 20 and 44
/// layers, of 24 bytes a pixel each.
constexpr int USUAL_STRATEGY_SEGMENTS = 5, LARGEST_STRATEGY_SEGMENTS = 8;

/// Segments up to which strategies are told apart (kernels/path/strategies.h); 0: they are not.
int strategy_segments(const Options& options);

/// Names of the layers and what they hold: a path expression, or of strategies how the paths are found.
std::vector<PathLayerOption> summed_layers(const Options& options);

/// Whether a layer of this name is one of strategies: together they are the picture.
bool is_strategy_layer(const std::string& name);

} // namespace clrt
