// SPDX-License-Identifier: Apache-2.0
// Light in the Earth's air: what the sun sends through it, and what molecules and haze scatter, in a sphere
// of shells. The first scattering is integrated along each view (Nishita et al. 1993); all later ones are
// taken as even over directions and as a geometric series (Hillaire 2020, section 5.5). No coefficient is
// fitted to pictures: molecules by Rayleigh's formula, haze by Angstrom's, ozone by its Chappuis band.
#pragma once

#include "scene/spectrum.h"

#include <glm/vec3.hpp>
#include <vector>

namespace clrt {

/// Air without clouds over a matte ground at sea level. Directions are given by the cosine with the zenith.
/// Light is relative to the sun's irradiance above the air, in each band.
class Atmosphere {
public:
    /// Turbidity: optical depth of molecules and haze over that of molecules, at 550 nm, straight up; from 1.
    /// The ground's albedo is from 0 to 1.
    Atmosphere(double turbidity, double ground_albedo);

    /// The share of sunlight that reaches the ground from the sun's direction; 0 below the horizon.
    Spectrum sunlight(double cos_sun) const;

    /// Radiance of the sky from the ground: of a view above the horizon at the cosine cos_apart from the sun.
    Spectrum sky(double cos_view, double cos_sun, double cos_apart) const;

private:
    /// Scattering of molecules, extinction of haze, and absorption of ozone, per km where each is densest.
    Spectrum molecules_, haze_, ozone_;
    double albedo_;
    /// Of molecules, haze and ozone, what lies on the way out of the air, km of the densest; by height and
    /// cosine, at least that of the horizon.
    std::vector<glm::dvec3> columns_;
    /// Radiance of all scattering but the first, over the sun's irradiance; by height and cosine of the sun.
    std::vector<Spectrum> later_;

    Spectrum transmittance(const glm::dvec3& column) const;
    glm::dvec3 column_to(double height, double cosine) const;
    Spectrum later_at(double height, double cos_sun) const;
    Spectrum later_scattering(double height, double cos_sun) const;
    template <class Visit>
    static void march(double height, double cos_view, double length, int steps, const Visit& visit);
};

} // namespace clrt
