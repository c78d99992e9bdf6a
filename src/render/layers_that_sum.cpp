// SPDX-License-Identifier: Apache-2.0
#include "render/layers_that_sum.h"

#include "options/summed_layers.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace clrt {

namespace {

/// The sum of value `i` of all layers.
double sum_of_layers(const std::vector<std::vector<float>>& layers, size_t i) {
    return std::accumulate(
        layers.begin(), layers.end(), 0.0,
        [i](double sum, const std::vector<float>& layer) { return sum + double(layer[i]); });
}

/// Layers by value `i`, the largest first.
std::vector<size_t> largest_layers(const std::vector<std::vector<float>>& layers, size_t i) {
    std::vector<size_t> order(layers.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return layers[a][i] > layers[b][i]; });
    return order;
}

} // namespace

void round_to_sum(const std::vector<float>& whole, std::vector<std::vector<float>>& layers) {
    for (size_t i = 0; i < whole.size(); ++i) {
        if (float(sum_of_layers(layers, i)) == whole[i])
            continue;
        // A second value has finer digits than the whole: two of them are enough.
        for (const size_t layer : largest_layers(layers, i)) {
            float& value = layers[layer][i];
            value = std::max(float(double(value) + (double(whole[i]) - sum_of_layers(layers, i))), 0.0f);
            if (float(sum_of_layers(layers, i)) == whole[i])
                break;
        }
    }
}

void add_summed_layers(const std::vector<std::string>& names, const std::vector<Film>& films,
                       Picture& picture) {
    std::vector<std::vector<float>> means;
    for (const Film& film : films)
        means.push_back(film_mean(film));
    if (!names.empty() && is_strategy_layer(names.front()))
        round_to_sum(picture.layers.front().values, means);
    for (size_t i = 0; i < means.size(); ++i)
        picture.layers.push_back({names[i], {"R", "G", "B"}, std::move(means[i]), false});
}

} // namespace clrt
