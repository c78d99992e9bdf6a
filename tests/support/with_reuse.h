// SPDX-License-Identifier: Apache-2.0
// Pictures with path reuse and without: whether the light is the same, and what the noise costs.
#pragma once

#include "film/film_error.h"
#include "support/lit_rooms.h"

#include <gtest/gtest.h>
#include <utility>

namespace clrt {

/// Whether a room has the same light in every tile with and without reuse, to 8 % of the picture's mean.
inline void expect_same_light(const Room& room, Integrator integrator) {
    constexpr double SHARPNESS = 0.08;
    Options alone = room.options;
    alone.transport.guide = Toggle::OFF;
    Options reusing = alone;
    reusing.transport.path_reuse = Toggle::ON;
    reusing.sampling.seed = 1;
    expect_equal(tile_means(room, reusing, integrator, ""), tile_means(room, alone, integrator, ""),
                 SHARPNESS);
}

/// Pictures without reuse and with it, of other seeds; the second may be guided.
inline std::pair<Film, Film> both_ways(TestScene& scene, Toggle guide = Toggle::OFF) {
    scene.options.sampling.replicates = 32;
    scene.options.transport.guide = Toggle::OFF;
    Film alone = scene.render().film;
    scene.options.transport.guide = guide;
    scene.options.transport.path_reuse = Toggle::ON;
    scene.options.sampling.seed = 1;
    const Render reusing = scene.render();
    EXPECT_EQ(reusing.counts.bad(), 0u);
    return {std::move(alone), reusing.film};
}

/// The mean over pixels of their squared difference over its variance: light that is given to the wrong pixel
/// of a tile changes no mean of the tile.
inline double mean_square_z(const std::pair<Film, Film>& films) {
    const auto& [alone, reusing] = films;
    double sum = 0;
    for (int y = 0; y < alone.height; ++y)
        for (int x = 0; x < alone.width; ++x) {
            const Estimate a = film_estimate(alone, 0, {x, y, x + 1, y + 1});
            const Estimate b = film_estimate(reusing, 0, {x, y, x + 1, y + 1});
            const double variance = a.error * a.error + b.error * b.error;
            sum += variance > 0 ? (a.mean - b.mean) * (a.mean - b.mean) / variance : 0;
        }
    return sum / (alone.width * alone.height);
}

/// Of Student's distribution with 31 degrees of freedom or more it is at most 31 / 29; pixels have some noise
/// in common.
constexpr double LARGEST_MEAN_SQUARE_Z = 1.2;
/// Of the 64 pixels of one tile: four standard deviations more than the mean.
constexpr double LARGEST_MEAN_SQUARE_Z_OF_A_TILE = 1.8;

/// A render, its squared error of a sample times its rays.
struct Cost {
    Render render;
    double cost;
    Cost(TestScene& scene, Toggle path_reuse) {
        scene.options.transport.path_reuse = path_reuse;
        render = scene.render();
        cost = sample_error(render.film, ErrorMeasure::RELATIVE) * double(render.counts.rays());
    }
};

} // namespace clrt
