// SPDX-License-Identifier: Apache-2.0
#include "app/layer_option.h"

#include "error.h"
#include "kernels/shared/path_types.h"
#include "options/summed_layers.h"
#include "paths/path_expression.h"
#include "render/layer_table.h"

#include <algorithm>
#include <vector>

namespace clrt {

namespace {

constexpr size_t LARGEST_LAYER_NAME = 60;

/// A layer NAME=EXPR of paths.
void add_path_layer(Options& o, const OptionValue& v, const std::string& name,
                    const std::string& expression) {
    static const std::string LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz",
                             REST = "0123456789_-";
    const bool is_name = !name.empty() && name.size() <= LARGEST_LAYER_NAME &&
                         LETTERS.find(name[0]) != std::string::npos &&
                         name.find_first_not_of(LETTERS + REST) == std::string::npos;
    const bool is_taken =
        is_layer_taken(name) || std::any_of(o.output.path_layers.begin(), o.output.path_layers.end(),
                                            [&](const auto& l) { return l.name == name; });
    if (!is_name || is_taken)
        reject_value(v,
                     "NAME=EXPR with a new name of letters, digits, '_' and '-' that starts with a letter");
    if (o.output.path_layers.size() == PATH_LAYERS_LIMIT)
        reject_value(v, "at most " + std::to_string(PATH_LAYERS_LIMIT) + " layers NAME=EXPR");
    check_paths(v, expression);
    o.output.path_layers.push_back({name, expression});
}

/// The layers of strategies, "strategies" or "strategies:K".
const std::string STRATEGIES = "strategies";

bool is_of_strategies(const std::string& layer) {
    return layer == STRATEGIES || layer.rfind(STRATEGIES + ":", 0) == 0;
}

void add_strategies(Options& o, const OptionValue& v, const std::string& layer) {
    int segments = USUAL_STRATEGY_SEGMENTS;
    if (layer != STRATEGIES) {
        const std::string text = layer.substr(STRATEGIES.size() + 1);
        segments = text.size() == 1 && text[0] >= '1' && text[0] <= '9' ? text[0] - '0' : 0;
        static_assert(LARGEST_STRATEGY_SEGMENTS < 10, "one digit");
    }
    if (segments < 1 || segments > LARGEST_STRATEGY_SEGMENTS || o.output.strategies)
        reject_value(v, "strategies or strategies:K once, K path segments from 1 to " +
                            std::to_string(LARGEST_STRATEGY_SEGMENTS));
    o.output.strategies = segments;
}

} // namespace

void check_paths(const OptionValue& v, const std::string& expression) {
    try {
        parse_path_expression(expression);
    } catch (const UsageError& error) {
        throw UsageError(v.origin + "option " + v.option + ": " + error.what());
    }
}

void apply_aov(Options& o, const OptionValue& v) {
    const bool is_first = !o.output.aovs;
    if (is_first)
        o.output.aovs.emplace();
    if (v.text == "none" && is_first)
        return;
    for (const std::string& layer : split_list(v.text)) {
        if (const size_t equals = layer.find('='); equals != std::string::npos) {
            add_path_layer(o, v, layer.substr(0, equals), layer.substr(equals + 1));
            continue;
        }
        if (is_of_strategies(layer)) {
            add_strategies(o, v, layer);
            continue;
        }
        const bool repeated =
            std::find(o.output.aovs->begin(), o.output.aovs->end(), layer) != o.output.aovs->end();
        if (!find_layer(layer) || repeated)
            reject_value(v, "none or a list such as albedo,N of different layers out of " +
                                layer_names(", ") + ", strategies, and NAME=EXPR");
        o.output.aovs->push_back(layer);
    }
}

} // namespace clrt
