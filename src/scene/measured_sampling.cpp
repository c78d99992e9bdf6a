// SPDX-License-Identifier: Apache-2.0
#include "scene/measured_sampling.h"

#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace clrt {
namespace {

/// Half vectors by which a cell is integrated: rings around the normal, and azimuths of each.
constexpr int HALF_RINGS = 4, HALF_AZIMUTHS = 64;

/// Shares of the cosine lobe that are tried: multiples of 1 / COSINE_SHARES.
constexpr int COSINE_SHARES = 16;

/// Light goes to the eye of view 0, on the horizon, from this cosine at least.
constexpr double SMALLEST_VIEW_COSINE = 1e-3;

/// A half vector and what its direction sends to the eye.
struct HalfVector {
    u32 cell;
    double solid_angle; ///< of the directions that it stands for
    double jacobian;    ///< of their density over that of half vectors
    double cosine;      ///< of the direction
    glm::dvec3 value;   ///< BRDF times cosine
    double size() const { return glm::length(value); }
};

/// 1 - cos of the half angle at which a cell begins.
double cell_edge(u32 cell) {
    const double root = double(cell) / MEASURED_CELLS, sine = std::sin(PI / 4 * root * root);
    return 2 * sine * sine;
}

double cell_solid_angle(u32 cell) {
    return 2 * PI * (cell_edge(cell + 1) - cell_edge(cell));
}

/// All half vectors that send light from above the surface to wo.
std::vector<HalfVector> half_vectors(const MeasuredValues& values, const glm::dvec3& wo) {
    std::vector<HalfVector> result;
    for (u32 cell = 0; cell < MEASURED_CELLS; ++cell)
        for (int ring = 0; ring < HALF_RINGS; ++ring) {
            const double share = (ring + 0.5) / HALF_RINGS;
            const double v = cell_edge(cell) + share * (cell_edge(cell + 1) - cell_edge(cell));
            const double sine = std::sqrt(v * (2 - v));
            for (int i = 0; i < HALF_AZIMUTHS; ++i) {
                const double azimuth = 2 * PI * (i + 0.5) / HALF_AZIMUTHS;
                const glm::dvec3 h(sine * std::cos(azimuth), sine * std::sin(azimuth), 1 - v);
                const double cos_h = glm::dot(wo, h);
                const glm::dvec3 wi = 2 * cos_h * h - wo;
                if (cos_h > 0 && wi.z > 0)
                    result.push_back({cell, 4 * cos_h * cell_solid_angle(cell) / (HALF_RINGS * HALF_AZIMUTHS),
                                      4 * cos_h, wi.z, values.at(wo, wi) * wi.z});
            }
        }
    return result;
}

using CellValues = std::array<double, MEASURED_CELLS>;

/// Probabilities of the cells; all 0 where nothing is reflected.
CellValues cell_probabilities(const std::vector<HalfVector>& vectors) {
    CellValues cells{};
    double sum = 0;
    for (const HalfVector& h : vectors) {
        cells[h.cell] += h.size() * h.solid_angle;
        sum += h.size() * h.solid_angle;
    }
    for (double& cell : cells)
        cell = sum > 0 ? cell / sum : 0;
    return cells;
}

/// The second moment of a sample that takes this share of its directions from the cosine lobe.
double second_moment(const std::vector<HalfVector>& vectors, const CellValues& density, double cosine_share) {
    double sum = 0;
    for (const HalfVector& h : vectors) {
        const double pdf = cosine_share * h.cosine / PI + (1 - cosine_share) * density[h.cell] / h.jacobian;
        sum += h.size() * h.size() / pdf * h.solid_angle;
    }
    return sum;
}

double best_cosine_share(const std::vector<HalfVector>& vectors, const CellValues& density) {
    double best = 1, least = std::numeric_limits<double>::max();
    for (int i = COSINE_SHARES; i > 0; --i) {
        const double share = double(i) / COSINE_SHARES, moment = second_moment(vectors, density, share);
        if (moment < least) {
            least = moment;
            best = share;
        }
    }
    return best;
}

} // namespace

MeasuredView sample_measured(const MeasuredValues& values, u32 view) {
    const double root = double(view) / (MEASURED_VIEWS - 1), z = std::max(root * root, SMALLEST_VIEW_COSINE);
    const std::vector<HalfVector> vectors = half_vectors(values, {std::sqrt(1 - z * z), 0, z});
    glm::dvec3 albedo(0);
    for (const HalfVector& h : vectors)
        albedo += h.value * h.solid_angle;
    const CellValues probabilities = cell_probabilities(vectors);
    CellValues density{};
    for (u32 cell = 0; cell < MEASURED_CELLS; ++cell)
        density[cell] = probabilities[cell] / cell_solid_angle(cell);
    const double cosine_share = best_cosine_share(vectors, density);

    MeasuredView result{};
    result.albedo = to_vec4(albedo, cosine_share);
    double sum = 0;
    for (u32 cell = 0; cell < MEASURED_CELLS; ++cell) {
        sum += probabilities[cell];
        result.density[cell] = float((1 - cosine_share) * density[cell]);
        result.cumulative[cell] = float(std::min(sum, 1.0));
    }
    result.cumulative[MEASURED_CELLS - 1] = 1;
    return result;
}

} // namespace clrt
