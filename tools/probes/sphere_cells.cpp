// SPDX-License-Identifier: Apache-2.0
// Equal cells of the sphere with a Gauss-Legendre rule in each.
#include "probes/sphere_cells.h"

#include "probes/random_inputs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace clrt {

std::vector<QuadraturePoint> gauss_legendre(size_t count) {
    std::vector<QuadraturePoint> rule(count);
    const double n = double(count);
    for (size_t i = 0; i < count; ++i) {
        // Newton's method from Chebyshev's guess for the roots of the Legendre polynomial.
        double x = std::cos(PI * (double(i) + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 100; ++step) {
            double p = 1, before = 0;
            for (double k = 1; k <= n; ++k) {
                const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                before = p;
                p = next;
            }
            slope = n * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        rule[i] = {0.5 * (1 - x), 1 / ((1 - x * x) * slope * slope)};
    }
    return rule;
}

SphereCells::SphereCells(size_t rows, size_t columns, size_t points)
    : rows_(rows), columns_(columns), rule_(gauss_legendre(points)) {}

size_t SphereCells::cell_of(const glm::dvec3& direction) const {
    const double row = (direction.z + 1) / 2 * double(rows_);
    const double column = (std::atan2(direction.y, direction.x) + PI) / (2 * PI) * double(columns_);
    return std::min(size_t(row), rows_ - 1) * columns_ + std::min(size_t(column), columns_ - 1);
}

std::vector<double> SphereCells::histogram(const std::vector<glm::dvec3>& directions) const {
    std::vector<double> counts(count());
    for (const glm::dvec3& direction : directions)
        ++counts[cell_of(direction)];
    return counts;
}

std::vector<glm::dvec3> SphereCells::nodes() const {
    std::vector<glm::dvec3> nodes;
    nodes.reserve(count() * rule_.size() * rule_.size());
    for (size_t row = 0; row < rows_; ++row)
        for (size_t column = 0; column < columns_; ++column)
            for (const QuadraturePoint& down : rule_)
                for (const QuadraturePoint& across : rule_)
                    nodes.push_back(
                        direction_at((double(row) + down.at) / double(rows_) * 2 - 1,
                                     (double(column) + across.at) / double(columns_) * 2 * PI - PI));
    return nodes;
}

std::vector<double> SphereCells::integrals(const std::vector<double>& densities) const {
    if (densities.size() != count() * rule_.size() * rule_.size())
        throw std::invalid_argument("SphereCells::integrals: expected one density for each of nodes()");
    std::vector<double> integrals(count());
    size_t node = 0;
    for (double& integral : integrals) {
        for (const QuadraturePoint& down : rule_)
            for (const QuadraturePoint& across : rule_)
                integral += down.weight * across.weight * densities[node++];
        integral *= 4 * PI / double(count());
    }
    return integrals;
}

double total(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

} // namespace clrt
