// SPDX-License-Identifier: Apache-2.0
// Spectra of visible light, and the colours that an eye sees in them.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace clrt {

/// Values at the middles of even bands from 380 to 780 nm.
constexpr size_t SPECTRUM_BANDS = 16;
using Spectrum = std::array<double, SPECTRUM_BANDS>;

/// Wavelength of a band's middle, nm.
double band_wavelength(size_t band);

/// Radiance of a black body of this temperature in kelvin, up to a factor (Planck).
Spectrum black_body(double kelvin);

/// CIE 1931 XYZ of a spectrum over that of an even one of 1, whose Y is 1; the observer is the fit of Wyman,
/// Sloan and Shirley (JCGT 2013, their sums of pieces of normal distributions).
glm::dvec3 to_xyz(const Spectrum& spectrum);

/// Linear sRGB of XYZ (IEC 61966-2-1); components outside of the gamut become 0.
glm::dvec3 to_linear_srgb(const glm::dvec3& xyz);

} // namespace clrt
