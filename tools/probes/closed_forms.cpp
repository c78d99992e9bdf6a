// SPDX-License-Identifier: Apache-2.0
// Closed forms and one quadrature, all in double.
#include "probes/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

/// The part of a polygon with z >= 0 along the normal (Sutherland and Hodgman 1974).
std::vector<glm::dvec3> above_horizon(const std::vector<glm::dvec3>& corners, const glm::dvec3& normal) {
    std::vector<glm::dvec3> result;
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const double height_a = glm::dot(a, normal), height_b = glm::dot(b, normal);
        if (height_a >= 0)
            result.push_back(a);
        if ((height_a >= 0) != (height_b >= 0))
            result.push_back(a + (b - a) * (height_a / (height_a - height_b)));
    }
    return result;
}

/// Smith's Lambda for GGX.
double lambda(const glm::dvec3& w, double alpha_x, double alpha_y) {
    const double x = alpha_x * w.x / w.z, y = alpha_y * w.y / w.z;
    return (std::sqrt(1 + x * x + y * y) - 1) / 2;
}

/// Sums term(wo, h) over normals h that are distributed as D(h) cos h, times (wo.h) / (cos wo cos h): the
/// density that reflection and refraction share. Normals facing away from wo are left out.
double over_normals(const RoughSurface& surface,
                    const std::function<double(const glm::dvec3&, const glm::dvec3&)>& term) {
    constexpr int STEPS = 512; // in each of two dimensions
    const double sin_o = std::sqrt(1 - surface.cos_o * surface.cos_o);
    const glm::dvec3 wo(sin_o * std::cos(surface.azimuth_o), sin_o * std::sin(surface.azimuth_o),
                        surface.cos_o);
    double sum = 0;
    for (int i = 0; i < STEPS; ++i)
        for (int k = 0; k < STEPS; ++k) {
            // D cos h is uniform in 1 - s^2; in s itself the factor 1 / cos h does no harm.
            const double s = (i + 0.5) / STEPS, phi = 2 * PI * (k + 0.5) / STEPS;
            const double r = std::sqrt(1 - s * s) / s;
            const glm::dvec3 h = glm::normalize(
                glm::dvec3(surface.alpha_x * r * std::cos(phi), surface.alpha_y * r * std::sin(phi), 1.0));
            const double cos_oh = glm::dot(wo, h);
            if (cos_oh > 0)
                sum += 2 * s * term(wo, h) * cos_oh / (wo.z * h.z);
        }
    return sum / (double(STEPS) * STEPS);
}

} // namespace

double polygon_irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                          const std::vector<glm::dvec3>& corners) {
    std::vector<glm::dvec3> seen;
    for (const glm::dvec3& corner : corners)
        seen.push_back(corner - point);
    seen = above_horizon(seen, normal);
    double sum = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        const glm::dvec3 a = glm::normalize(seen[i]), b = glm::normalize(seen[(i + 1) % seen.size()]);
        const glm::dvec3 across = glm::cross(a, b);
        const double sine = glm::length(across);
        if (sine > 0)
            sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, normal);
    }
    return std::abs(sum) / 2;
}

double fresnel_reflectance(double cos_i, double eta) {
    const double sin_t_squared = eta * eta * (1 - cos_i * cos_i);
    if (sin_t_squared >= 1)
        return 1;
    const double cos_t = std::sqrt(1 - sin_t_squared);
    const double s = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const double p = (eta * cos_t - cos_i) / (eta * cos_t + cos_i);
    return (s * s + p * p) / 2;
}

double rough_reflection_albedo(const RoughSurface& surface, const std::function<double(double)>& fresnel) {
    const auto term = [&](const glm::dvec3& wo, const glm::dvec3& h) {
        const double cos_oh = glm::dot(wo, h);
        const glm::dvec3 wi = 2 * cos_oh * h - wo;
        if (wi.z <= 0)
            return 0.0;
        const double g2 = 1 / (1 + lambda(wo, surface.alpha_x, surface.alpha_y) +
                               lambda(wi, surface.alpha_x, surface.alpha_y));
        return fresnel(cos_oh) * g2;
    };
    return over_normals(surface, term);
}

double rough_transmission_albedo(const RoughSurface& surface, double eta) {
    const auto term = [&](const glm::dvec3& wo, const glm::dvec3& h) {
        const double cos_oh = glm::dot(wo, h);
        const double f = fresnel_reflectance(cos_oh, eta);
        if (f >= 1)
            return 0.0;
        const double cos_t = std::sqrt(1 - eta * eta * (1 - cos_oh * cos_oh));
        const glm::dvec3 wi = h * (eta * cos_oh - cos_t) - eta * wo;
        if (wi.z >= 0)
            return 0.0;
        const glm::dvec3 below(wi.x, wi.y, -wi.z);
        const double g2 = 1 / (1 + lambda(wo, surface.alpha_x, surface.alpha_y) +
                               lambda(below, surface.alpha_x, surface.alpha_y));
        return (1 - f) * g2;
    };
    return over_normals(surface, term);
}

} // namespace clrt
