// SPDX-License-Identifier: Apache-2.0
#include "scene/atmosphere.h"

#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

// Lengths in km.
constexpr double EARTH_RADIUS = 6360, AIR_HEIGHT = 100;
constexpr double MOLECULE_HEIGHT =
    8.44; ///< over which density falls by e: the column at sea level, 2.15e29 / m^2
constexpr double HAZE_HEIGHT = 1.2;
constexpr double OZONE_MIDDLE = 25, OZONE_REACH = 15; ///< densest there, linear to 0 at this distance

// Air at 288 K and 1013 hPa: molecules per m^3, refractive index less 1, depolarisation (Bucholtz 1995).
constexpr double MOLECULES_PER_M3 = 2.547e25, AIR_INDEX_LESS_1 = 2.78e-4, DEPOLARISATION = 0.0279;

// Haze: extinction as wavelength^-1.3 (Angstrom 1929), nine tenths of it scattering, mostly forward.
constexpr double ANGSTROM_EXPONENT = 1.3, HAZE_ALBEDO = 0.9, HAZE_ASYMMETRY = 0.76;
constexpr double TURBIDITY_NM = 550;

// Ozone's Chappuis band, about: 5.1e-25 m^2 a molecule at 594 nm; 300 Dobson units, 2.69e20 / m^2 each.
constexpr double OZONE_CROSS_SECTION = 5.1e-25, OZONE_PEAK_NM = 594, OZONE_WIDTH_NM = 48;
constexpr double OZONE_MOLECULES_PER_M2 = 300 * 2.69e20;

/// A column that lets nothing through, and has a product with 0.
constexpr double BEHIND_GROUND = 1e9;

constexpr int HEIGHTS = 16, COSINES = 64; ///< of the tables
constexpr int STEPS = 32;                 ///< of a way through the air
// Of light that is nearly even: AROUND^2 directions. Twice as much of both moves no sky by 2 %.
constexpr int AROUND = 6, LATER_STEPS = 16;
/// Deeper below the horizon the sun lights no air that scatters: 20 degrees.
constexpr double NIGHT_COSINE = -0.35;

double rayleigh_per_km(double nm) {
    const double n2 = (1 + AIR_INDEX_LESS_1) * (1 + AIR_INDEX_LESS_1) - 1;
    const double king = (6 + 3 * DEPOLARISATION) / (6 - 7 * DEPOLARISATION);
    const double metres = nm * 1e-9;
    return 1000 * 8 * PI * PI * PI * n2 * n2 / (3 * MOLECULES_PER_M3 * std::pow(metres, 4)) * king;
}

double rayleigh_phase(double c) {
    return 3 / (16 * PI) * (1 + c * c);
}

/// Cornette and Shanks 1992.
double haze_phase(double c) {
    const double g2 = HAZE_ASYMMETRY * HAZE_ASYMMETRY;
    return 3 / (8 * PI) * (1 - g2) * (1 + c * c) /
           ((2 + g2) * std::pow(1 + g2 - 2 * HAZE_ASYMMETRY * c, 1.5));
}

/// Of molecules, haze and ozone, over where each is densest.
glm::dvec3 densities(double height) {
    return {std::exp(-height / MOLECULE_HEIGHT), std::exp(-height / HAZE_HEIGHT),
            std::max(1 - std::fabs(height - OZONE_MIDDLE) / OZONE_REACH, 0.0)};
}

double cosine_to_ground(double height) {
    const double sine = EARTH_RADIUS / (EARTH_RADIUS + height);
    return -std::sqrt(std::max(1 - sine * sine, 0.0));
}

/// Way from a height along a direction to the ground, or out of the air.
double way_through_air(double height, double cosine, bool meets_ground) {
    const double r = EARTH_RADIUS + height, target = EARTH_RADIUS + (meets_ground ? 0 : AIR_HEIGHT);
    const double root = std::sqrt(std::max(r * r * (cosine * cosine - 1) + target * target, 0.0));
    return std::max(meets_ground ? -r * cosine - root : -r * cosine + root, 0.0);
}

double height_at(double height, double cosine, double way) {
    const double r = EARTH_RADIUS + height;
    return std::max(std::sqrt(r * r + way * way + 2 * r * way * cosine) - EARTH_RADIUS, 0.0);
}

/// The cosine with the zenith of another place, of a direction that has `cos_sun` here.
double cosine_at(double height, double cos_view, double way, double cos_sun, double cos_apart) {
    const double r = EARTH_RADIUS + height;
    return std::clamp((r * cos_sun + way * cos_apart) / (EARTH_RADIUS + height_at(height, cos_view, way)),
                      -1.0, 1.0);
}

// Tables are dense near the ground, and near the horizon, which falls with height.
double table_height(int i) {
    return AIR_HEIGHT * std::pow(double(i) / (HEIGHTS - 1), 3);
}

double place_of_height(double height) {
    return (HEIGHTS - 1) * std::cbrt(std::clamp(height / AIR_HEIGHT, 0.0, 1.0));
}

double table_cosine(int i) {
    const double t = 2 * double(i) / (COSINES - 1) - 1;
    return t * std::fabs(t);
}

double place_of_cosine(double cosine) {
    return (COSINES - 1) * 0.5 * (1 + std::copysign(std::sqrt(std::fabs(cosine)), cosine));
}

/// Calls add(index, weight) for the four table entries around a place.
template <class Add>
void interpolate(double height, double cosine, const Add& add) {
    const double y = place_of_height(height), x = place_of_cosine(std::clamp(cosine, -1.0, 1.0));
    const int row = std::min(int(y), HEIGHTS - 2), column = std::min(int(x), COSINES - 2);
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            add(size_t((row + i) * COSINES + column + j),
                std::fabs(1 - i - (y - row)) * std::fabs(1 - j - (x - column)));
}

} // namespace

/// Visits the middles of steps that grow with the cube of the way: visit(height, way, length of the step).
template <class Visit>
void Atmosphere::march(double height, double cos_view, double length, int steps, const Visit& visit) {
    double begin = 0;
    for (int i = 0; i < steps; ++i) {
        const double end = length * std::pow((i + 1.0) / steps, 3), middle = 0.5 * (begin + end);
        visit(height_at(height, cos_view, middle), middle, end - begin);
        begin = end;
    }
}

Atmosphere::Atmosphere(double turbidity, double ground_albedo) : albedo_(ground_albedo) {
    const double haze_550 = (turbidity - 1) * rayleigh_per_km(TURBIDITY_NM) * MOLECULE_HEIGHT / HAZE_HEIGHT;
    for (size_t i = 0; i < SPECTRUM_BANDS; ++i) {
        const double nm = band_wavelength(i), apart = (nm - OZONE_PEAK_NM) / OZONE_WIDTH_NM;
        molecules_[i] = rayleigh_per_km(nm);
        haze_[i] = haze_550 * std::pow(nm / TURBIDITY_NM, -ANGSTROM_EXPONENT);
        // The tent's column is OZONE_REACH of where it is densest.
        ozone_[i] =
            OZONE_CROSS_SECTION * std::exp(-0.5 * apart * apart) * OZONE_MOLECULES_PER_M2 / OZONE_REACH;
    }
    columns_.resize(size_t(HEIGHTS * COSINES));
    later_.resize(columns_.size());
    for (int row = 0; row < HEIGHTS; ++row)
        for (int column = 0; column < COSINES; ++column) {
            const double height = table_height(row),
                         cosine = std::max(table_cosine(column), cosine_to_ground(height));
            glm::dvec3 sum(0);
            march(height, cosine, way_through_air(height, cosine, false), STEPS,
                  [&](double at, double, double step) { sum += densities(at) * step; });
            columns_[size_t(row * COSINES + column)] = sum;
        }
    tbb::parallel_for(0, HEIGHTS * COSINES, [&](int i) {
        later_[size_t(i)] = later_scattering(table_height(i / COSINES), table_cosine(i % COSINES));
    });
}

Spectrum Atmosphere::transmittance(const glm::dvec3& column) const {
    Spectrum result;
    for (size_t i = 0; i < SPECTRUM_BANDS; ++i)
        result[i] = std::exp(-(molecules_[i] * column.x + haze_[i] * column.y + ozone_[i] * column.z));
    return result;
}

glm::dvec3 Atmosphere::column_to(double height, double cosine) const {
    if (cosine < cosine_to_ground(height))
        return glm::dvec3(BEHIND_GROUND);
    glm::dvec3 sum(0);
    interpolate(height, cosine, [&](size_t i, double weight) { sum += weight * columns_[i]; });
    return sum;
}

Spectrum Atmosphere::later_at(double height, double cos_sun) const {
    Spectrum sum{};
    interpolate(height, cos_sun, [&](size_t i, double weight) {
        for (size_t band = 0; band < SPECTRUM_BANDS; ++band)
            sum[band] += weight * later_[i][band];
    });
    return sum;
}

/// With L the light of the second scattering and f the share of even light that a scattering hands on, all
/// later ones give L (1 + f + f^2 + ...).
Spectrum Atmosphere::later_scattering(double height, double cos_sun) const {
    Spectrum second{}, share{};
    if (cos_sun < NIGHT_COSINE)
        return second;
    const double sin_sun = std::sqrt(std::max(1 - cos_sun * cos_sun, 0.0));
    for (int k = 0; k < AROUND * AROUND; ++k) {
        const double z = 1 - 2 * (k / AROUND + 0.5) / AROUND, azimuth = (k % AROUND + 0.5) * PI / AROUND;
        const double apart = z * cos_sun + std::sqrt(1 - z * z) * sin_sun * std::cos(azimuth);
        const bool meets_ground = z < cosine_to_ground(height);
        const double length = way_through_air(height, z, meets_ground);
        glm::dvec3 column(0);
        march(height, z, length, LATER_STEPS, [&](double at, double way, double step) {
            const glm::dvec3 density = densities(at);
            const Spectrum seen = transmittance(column + 0.5 * step * density);
            const Spectrum lit = transmittance(column_to(at, cosine_at(height, z, way, cos_sun, apart)));
            column += step * density;
            for (size_t i = 0; i < SPECTRUM_BANDS; ++i) {
                const double scattered =
                    seen[i] * step * (molecules_[i] * density.x + HAZE_ALBEDO * haze_[i] * density.y);
                second[i] += scattered * lit[i] / (4 * PI);
                share[i] += scattered;
            }
        });
        const double cos_there = cosine_at(height, z, length, cos_sun, apart);
        if (!meets_ground || cos_there <= 0)
            continue;
        const Spectrum there = transmittance(column + column_to(0, cos_there));
        for (size_t i = 0; i < SPECTRUM_BANDS; ++i)
            second[i] += there[i] * albedo_ / PI * cos_there;
    }
    for (size_t i = 0; i < SPECTRUM_BANDS; ++i)
        second[i] = second[i] / (AROUND * AROUND) / (1 - share[i] / (AROUND * AROUND));
    return second;
}

Spectrum Atmosphere::sunlight(double cos_sun) const {
    return transmittance(column_to(0, cos_sun));
}

Spectrum Atmosphere::sky(double cos_view, double cos_sun, double cos_apart) const {
    Spectrum sum{};
    glm::dvec3 column(0);
    march(0, cos_view, way_through_air(0, cos_view, false), STEPS, [&](double at, double way, double step) {
        const glm::dvec3 density = densities(at);
        const Spectrum seen = transmittance(column);
        const double cos_there = cosine_at(0, cos_view, way, cos_sun, cos_apart);
        const Spectrum lit = transmittance(column_to(at, cos_there)), later = later_at(at, cos_there);
        column += step * density;
        for (size_t i = 0; i < SPECTRUM_BANDS; ++i) {
            const double molecules = molecules_[i] * density.x, haze = HAZE_ALBEDO * haze_[i] * density.y;
            const double first = molecules * rayleigh_phase(cos_apart) + haze * haze_phase(cos_apart);
            const double source = first * lit[i] + (molecules + haze) * later[i];
            // Along a step the source stays and what is seen of it falls.
            const double depth = step * (molecules + haze_[i] * density.y + ozone_[i] * density.z);
            sum[i] += seen[i] * source * step * (depth > 1e-9 ? -std::expm1(-depth) / depth : 1.0);
        }
    });
    return sum;
}

} // namespace clrt
