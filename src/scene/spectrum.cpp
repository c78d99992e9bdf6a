// SPDX-License-Identifier: Apache-2.0
#include "scene/spectrum.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace clrt {
namespace {

constexpr double FIRST_NM = 380, LAST_NM = 780;

/// Planck's second radiation constant h c / k, nm kelvin.
constexpr double SECOND_RADIATION = 1.438776877e7;

/// A normal distribution's shape with one width on either side of its peak, nm.
double lobe(double wavelength, double peak, double below, double above) {
    const double t = (wavelength - peak) / (wavelength < peak ? below : above);
    return std::exp(-0.5 * t * t);
}

glm::dvec3 observer(double w) {
    return {1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) -
                0.065 * lobe(w, 501.1, 20.4, 26.2),
            0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1),
            1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8)};
}

} // namespace

double band_wavelength(size_t band) {
    return FIRST_NM + (double(band) + 0.5) * (LAST_NM - FIRST_NM) / double(SPECTRUM_BANDS);
}

Spectrum black_body(double kelvin) {
    Spectrum result;
    for (size_t i = 0; i < SPECTRUM_BANDS; ++i) {
        const double nm = band_wavelength(i);
        result[i] = std::pow(nm / 560, -5) / std::expm1(SECOND_RADIATION / (nm * kelvin));
    }
    return result;
}

glm::dvec3 to_xyz(const Spectrum& spectrum) {
    glm::dvec3 sum(0), even(0);
    for (size_t i = 0; i < SPECTRUM_BANDS; ++i) {
        const glm::dvec3 seen = observer(band_wavelength(i));
        sum += spectrum[i] * seen;
        even += seen;
    }
    return sum / even.y;
}

glm::dvec3 to_linear_srgb(const glm::dvec3& xyz) {
    const glm::dvec3 rgb(3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
                         -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
                         0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z);
    return glm::max(rgb, 0.0);
}

} // namespace clrt
