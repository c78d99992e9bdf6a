// SPDX-License-Identifier: Apache-2.0
// Cells of the sphere for chi-squared tests of sampled directions against their density.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace clrt {

/// A quadrature point of [0, 1] and its weight.
struct QuadraturePoint {
    double at, weight;
};

/// The Gauss-Legendre rule with `count` points on [0, 1]: exact for polynomials of degree 2 count - 1.
std::vector<QuadraturePoint> gauss_legendre(size_t count);

/// The sphere cut into rows of equal height in z and columns of equal azimuth: all cells have the same solid
/// angle, and with an even number of rows none crosses the horizon.
class SphereCells {
public:
    /// `points`: quadrature points along each side of a cell.
    SphereCells(size_t rows, size_t columns, size_t points);

    size_t count() const { return rows_ * columns_; }
    /// The cell of a unit direction.
    size_t cell_of(const glm::dvec3& direction) const;
    /// How many of the directions lie in each cell.
    std::vector<double> histogram(const std::vector<glm::dvec3>& directions) const;

    /// Directions at which a density must be known to integrate it.
    std::vector<glm::dvec3> nodes() const;
    /// Integral over each cell of a density per steradian, given at nodes().
    std::vector<double> integrals(const std::vector<double>& densities) const;

private:
    size_t rows_, columns_;
    std::vector<QuadraturePoint> rule_;
};

/// Sum of all values.
double total(const std::vector<double>& values);

} // namespace clrt
