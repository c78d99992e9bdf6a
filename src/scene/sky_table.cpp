// SPDX-License-Identifier: Apache-2.0
#include "scene/sky_table.h"

#include "colour.h"
#include "scene/alias_table.h"
#include "scene/sky_texels.h"
#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// A map whose bright texels exceed its mean by less than this share of its light is constant: more is not
/// rounding.
constexpr double SMALLEST_EXCESS = 1e-6;

/// Radiance, in means of the map, that BSDF sampling finds as well.
double left_to_bsdf(SkySampling sampling) {
    switch (sampling) {
    case SkySampling::BRIGHTEST_BY_TABLE:
        return 4;
    case SkySampling::BY_TABLE_AND_BSDF:
        return 1;
    case SkySampling::BY_TABLE:
        break;
    }
    return 0;
}

/// Weights of a tile's texels, row by row.
using TileWeights = std::array<double, SKY_TILE_TEXELS>;

double tile_sum(const TileWeights& weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
}

/// The light of each texel less `radiance` times its solid angle, not below 0; of a row of tiles.
std::vector<TileWeights> tile_weights(const Environment& sky, int tile_row, double radiance) {
    std::vector<TileWeights> weights(size_t(sky_tiles(sky.width)), TileWeights{});
    const int first = tile_row * SKY_TILE, end = std::min(first + SKY_TILE, sky.height);
    const std::vector<double> light = cell_luminance(sky, first, end);
    for (int y = first; y < end; ++y) {
        const double solid_angle = texel_solid_angle(y, sky.width, sky.height);
        const double* row = &light[size_t(y - first) * size_t(sky.width)];
        for (int x = 0; x < sky.width; ++x)
            weights[size_t(x / SKY_TILE)][size_t((y - first) * SKY_TILE + x % SKY_TILE)] =
                std::fmax(row[x] - radiance, 0.0) * solid_angle;
    }
    return weights;
}

/// Whole shares of SKY_SHARES in proportion to weights that are not all 0, which differ from that by less
/// than 1 or, since each positive weight gets a share, are 1 more than that. The largest deviations give way.
std::array<u32, SKY_TILE_TEXELS> shares_of(const TileWeights& weights) {
    const double factor = SKY_SHARES / tile_sum(weights);
    std::array<u32, SKY_TILE_TEXELS> shares{};
    int left = int(SKY_SHARES);
    for (size_t i = 0; i < shares.size(); ++i) {
        shares[i] = weights[i] > 0 ? u32(std::fmax(std::floor(weights[i] * factor), 1.0)) : 0;
        left -= int(shares[i]);
    }
    for (; left != 0; left += left < 0 ? 1 : -1) {
        const int step = left < 0 ? -1 : 1;
        size_t best = shares.size();
        double deviation = 0;
        for (size_t i = 0; i < shares.size(); ++i) {
            const double d = step * (weights[i] * factor - double(shares[i]));
            if (shares[i] > (step < 0 ? 1u : 0u) && (best == shares.size() || d > deviation)) {
                best = i;
                deviation = d;
            }
        }
        shares[best] = u32(int(shares[best]) + step);
    }
    return shares;
}

/// Fills in the shares of all tiles; returns the tiles' weights.
std::vector<double> share_tiles(Environment& sky, double radiance) {
    const int across = sky_tiles(sky.width), down = sky_tiles(sky.height);
    std::vector<double> sums(size_t(across) * size_t(down));
    sky.tiles.assign(sums.size(), SkyTile{});
    tbb::parallel_for(0, down, [&](int tile_row) {
        size_t i = size_t(tile_row) * size_t(across);
        for (const TileWeights& weights : tile_weights(sky, tile_row, radiance)) {
            sums[i] = tile_sum(weights);
            if (sums[i] > 0) {
                const auto shares = shares_of(weights);
                for (size_t k = 0; k < shares.size(); ++k)
                    sky.tiles[i].shares[k / SKY_TILE] |= shares[k] << (k % SKY_TILE * 8);
            }
            ++i;
        }
    });
    return sums;
}

} // namespace

std::vector<double> cell_luminance(const Environment& sky, int first, int end) {
    const size_t width = size_t(sky.width);
    const auto inside = [&](int y) { return std::clamp(y, 0, sky.height - 1); };
    const auto luminances = [&](int y) {
        std::vector<double> row(width);
        for (int x = 0; x < sky.width; ++x)
            row[size_t(x)] = luminance(glm::dvec3(sky_texel(sky, x, y)));
        return row;
    };
    std::vector<double> above = luminances(inside(first - 1)), here = luminances(first), column(width),
                        result;
    result.reserve(width * size_t(end - first));
    for (int y = first; y < end; ++y) {
        std::vector<double> below = luminances(inside(y + 1));
        // Over its own cell a bilinear tent has the mean 6/8, over each neighbour's 1/8.
        for (size_t x = 0; x < width; ++x)
            column[x] = 0.125 * above[x] + 0.75 * here[x] + 0.125 * below[x];
        for (size_t x = 0; x < width; ++x)
            result.push_back(0.125 * column[x == 0 ? width - 1 : x - 1] + 0.75 * column[x] +
                             0.125 * column[x == width - 1 ? 0 : x + 1]);
        above = std::move(here);
        here = std::move(below);
    }
    return result;
}

double texel_solid_angle(int row, int width, int height) {
    // cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2): no cancellation at the poles.
    const double middle = PI * (row + 0.5) / height, half = 0.5 * PI / height;
    return 2 * PI / width * 2 * std::sin(middle) * std::sin(half);
}

double light_of_map(const Environment& sky) {
    std::vector<double> sums(size_t(sky_tiles(sky.height)));
    tbb::parallel_for(size_t(0), sums.size(), [&](size_t row) {
        for (const TileWeights& weights : tile_weights(sky, int(row), 0))
            sums[row] += tile_sum(weights);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

void tabulate_sky(Environment& sky, SkySampling sampling) {
    if (sky.texels.empty() || sky.sampling == sampling)
        return;
    sky.tabulated_share = 1;
    std::vector<double> weights;
    if (const double means = left_to_bsdf(sampling); means > 0) {
        const double light = light_of_map(sky);
        weights = share_tiles(sky, means * light / (4 * PI));
        sky.tabulated_share = std::accumulate(weights.begin(), weights.end(), 0.0) / light;
    }
    if (weights.empty() || !(sky.tabulated_share > SMALLEST_EXCESS)) {
        weights = share_tiles(sky, 0);
        sky.tabulated_share = 1;
    }
    const AliasTable table = build_alias_table(weights);
    for (size_t i = 0; i < sky.tiles.size(); ++i) {
        sky.tiles[i].probability = float(table.probability[i]);
        sky.tiles[i].alias = table.entries[i].alias;
        sky.tiles[i].threshold = table.entries[i].threshold;
    }
    sky.sampling = sampling;
}

double texel_probability(const Environment& sky, int x, int y) {
    const SkyTile& tile =
        sky.tiles[size_t(y / SKY_TILE) * size_t(sky_tiles(sky.width)) + size_t(x / SKY_TILE)];
    const u32 share = tile.shares[y % SKY_TILE] >> (x % SKY_TILE * 8) & 255;
    return double(tile.probability) * share / SKY_SHARES;
}

} // namespace clrt
