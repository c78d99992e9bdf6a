// SPDX-License-Identifier: Apache-2.0
// Textbook formulas in double precision (Fresnel in long double) that kernel functions are compared with.
// Written for clarity, by angles where the kernels use components, so that an error is not repeated.
#pragma once

#include "probes/random_inputs.h"

#include <algorithm>
#include <complex>

namespace clrt::reference {

/// Square of the refracted angle's cosine by Snell's law; negative under total internal reflection. eta:
/// index on the incident side over index on the other.
inline long double cos_t_squared(double cos_i, double eta) {
    const long double c = cos_i, e = eta;
    return 1 - e * e * (1 - c * c);
}

/// Fresnel's reflectance for unpolarised light: the mean of the squared amplitudes of both polarisations.
inline double fresnel_dielectric(double cos_i, double eta) {
    const long double squared = cos_t_squared(cos_i, eta);
    if (squared <= 0)
        return eta == 1 ? 0 : 1;
    const long double ci = cos_i, ct = std::sqrt(squared), e = eta;
    if (eta == 1)
        return 0;
    const long double s = (e * ci - ct) / (e * ci + ct), p = (ci - e * ct) / (ci + e * ct);
    return double((s * s + p * p) / 2);
}

inline double fresnel_schlick(double f0, double cos_i) {
    return f0 + (1 - f0) * std::pow(1 - std::clamp(cos_i, 0.0, 1.0), 5);
}

/// Of a conductor of index eta + i k beside air: the same mean, with complex amplitudes.
inline double fresnel_conductor(double cos_i, double eta, double k) {
    using Complex = std::complex<long double>;
    const long double c = cos_i;
    const Complex n(eta, k), ct = std::sqrt(Complex(1) - Complex(1 - c * c) / (n * n));
    const Complex s = (c - n * ct) / (c + n * ct), p = (n * c - ct) / (n * c + ct);
    return double((std::norm(s) + std::norm(p)) / 2);
}

/// GGX by slopes: D(h) = P22(-h.x / h.z, -h.y / h.z) / h.z^4.
inline double ggx_d(const glm::dvec3& h, double alpha_x, double alpha_y) {
    const double slope_x = -h.x / h.z, slope_y = -h.y / h.z;
    const double s = 1 + std::pow(slope_x / alpha_x, 2) + std::pow(slope_y / alpha_y, 2);
    return 1 / (PI * alpha_x * alpha_y * s * s) / std::pow(h.z, 4);
}

/// Smith's Lambda for GGX: (sqrt(1 + (alpha tan theta)^2) - 1) / 2.
inline double ggx_lambda(const glm::dvec3& w, double alpha_x, double alpha_y) {
    const long double x = alpha_x * w.x / w.z, y = alpha_y * w.y / w.z;
    return double((std::sqrt(1 + x * x + y * y) - 1) / 2);
}

inline double ggx_g1(const glm::dvec3& w, double alpha_x, double alpha_y) {
    return 1 / (1 + ggx_lambda(w, alpha_x, alpha_y));
}

inline double ggx_g2(const glm::dvec3& wo, const glm::dvec3& wi, double alpha_x, double alpha_y) {
    return 1 / (1 + ggx_lambda(wo, alpha_x, alpha_y) + ggx_lambda(wi, alpha_x, alpha_y));
}

} // namespace clrt::reference
