// SPDX-License-Identifier: Apache-2.0
#include "scene/rectified_sky.h"

#include "colour.h"
#include "scene/sky_table.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>
#include <numeric>
#include <tbb/parallel_for.h>
#include <utility>
#include <vector>

namespace clrt {

namespace {

constexpr int SIZE = int(RECTIFIED_SIZE);
/// Directions across and down a texel that are looked along.
constexpr int VIEWS = 4;
/// Texels of the sky across at most: finer ones fall between the directions.
constexpr int MOST_ACROSS = 1024;
/// Of the sums, with one for each texel to spare.
constexpr double MOST_UNITS = 4294967295.0 - double(SIZE) * SIZE;

/// Luminance of a lat-long map in cells.
class SkyCells {
public:
    explicit SkyCells(const Environment& sky)
        : cosine_(std::cos(glm::radians(sky.rotation_degrees))),
          sine_(std::sin(glm::radians(sky.rotation_degrees))) {
        const int step = (sky.width + MOST_ACROSS - 1) / MOST_ACROSS;
        across_ = (sky.width + step - 1) / step;
        down_ = (sky.height + step - 1) / step;
        luminance_.assign(size_t(across_) * size_t(down_), 0);
        tbb::parallel_for(0, down_, [&](int row) {
            const int first = row * step, end = std::min(first + step, sky.height);
            const std::vector<double> cells = cell_luminance(sky, first, end);
            for (size_t i = 0; i < cells.size(); ++i) {
                const int x = int(i % size_t(sky.width)) / step;
                const int columns = std::min(step, sky.width - x * step);
                luminance_[size_t(row) * size_t(across_) + size_t(x)] += cells[i] / (columns * (end - first));
            }
        });
    }

    /// In the world direction d, of any length.
    double towards(const glm::dvec3& d) const {
        const double x = cosine_ * d.x - sine_ * d.z, z = sine_ * d.x + cosine_ * d.z;
        const double u = 0.5 + std::atan2(z, x) / (2 * PI), v = std::atan2(std::hypot(x, z), d.y) / PI;
        const int column = std::clamp(int(u * across_), 0, across_ - 1);
        const int row = std::clamp(int(v * down_), 0, down_ - 1);
        return luminance_[size_t(row) * size_t(across_) + size_t(column)];
    }

private:
    double cosine_, sine_;
    int across_, down_;
    std::vector<double> luminance_;
};

/// The slope at a coordinate in [0, SIZE], and how fast it grows there.
std::pair<double, double> slope(double coordinate) {
    const double m = 2 * coordinate / SIZE - 1, rest = 1 - std::abs(m);
    return {m / rest, 2 / (SIZE * rest * rest)};
}

/// Light of each texel of the map seen along axes[2].
std::vector<double> light_along(const SkyCells& cells, const glm::dmat3& axes) {
    std::vector<double> light(size_t(SIZE) * SIZE);
    tbb::parallel_for(0, SIZE, [&](int y) {
        for (int i = 0; i < SIZE * VIEWS * VIEWS; ++i) {
            const int x = i / (VIEWS * VIEWS), across = i % VIEWS, down = i / VIEWS % VIEWS;
            const auto [a, growth_a] = slope(x + (across + 0.5) / VIEWS);
            const auto [b, growth_b] = slope(y + (down + 0.5) / VIEWS);
            const double square = 1 + a * a + b * b;
            const double solid_angle = growth_a * growth_b / (square * std::sqrt(square) * VIEWS * VIEWS);
            light[size_t(y) * SIZE + size_t(x)] +=
                solid_angle * cells.towards(a * axes[0] + b * axes[1] + axes[2]);
        }
    });
    return light;
}

/// Appends the sums of a map, in units that are returned.
double add_sums(const std::vector<double>& light, std::vector<u32>& sums) {
    const double unit = std::accumulate(light.begin(), light.end(), 0.0) / MOST_UNITS;
    std::vector<u32> below(size_t(SIZE) + 1, 0);
    sums.insert(sums.end(), below.begin(), below.end());
    for (int y = 0; y < SIZE; ++y) {
        u32 row = 0;
        for (int x = 0; x < SIZE; ++x) {
            const double units = unit > 0 ? std::floor(light[size_t(y) * SIZE + size_t(x)] / unit) : 0;
            row += 1 + u32(units);
            below[size_t(x) + 1] += row;
        }
        sums.insert(sums.end(), below.begin(), below.end());
    }
    return unit;
}

} // namespace

void rectify_sky(Environment& sky) {
    sky.portal_sums.clear();
    if (sky.texels.empty()) {
        for (SkyPortal& portal : sky.portals)
            portal.corner.w = 1;
        return;
    }
    const SkyCells cells(sky);
    std::vector<std::pair<glm::dmat3, double>> made; // axes and units
    for (SkyPortal& portal : sky.portals) {
        const glm::dmat3 axes(to_dvec3(portal.axis_u), to_dvec3(portal.axis_v), -to_dvec3(portal.normal));
        auto like =
            std::find_if(made.begin(), made.end(), [&](const auto& map) { return map.first == axes; });
        if (like == made.end())
            like = made.insert(made.end(), {axes, add_sums(light_along(cells, axes), sky.portal_sums)});
        portal.first_sum = u32(like - made.begin()) * RECTIFIED_SUMS;
        portal.corner.w = float(like->second);
    }
}

} // namespace clrt
