// SPDX-License-Identifier: Apache-2.0
#include "output/agx.h"

#include "output/tonemap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace clrt {

namespace {

/// Stops about middle grey that the curve spreads over the display's range, those of AgX.
constexpr double DARKEST_STOP = -10, BRIGHTEST_STOP = 6.5;
/// The curve is drawn over display values of this exponent, where equal steps look about equal.
constexpr double DISPLAY_EXPONENT = 2.2;
/// How gently the curve bends towards both ends: 1 bends most slowly, as x / (1 + x) does, infinity not at
/// all before the end.
constexpr double BEND = 1.5;
/// Of middle grey: d(log display) / d(log radiance). With that bend the four stops about middle grey stay
/// four stops; with 1 they would be 3.6, and pictures look flat.
constexpr double CONTRAST = 1.15;

using Chromaticities = std::array<glm::dvec2, 3>;

/// Rec. 709's primaries and its white, D65 (ITU-R BT.709-6, items 1.3 and 1.4).
const Chromaticities REC709 = {glm::dvec2(0.64, 0.33), glm::dvec2(0.30, 0.60), glm::dvec2(0.15, 0.06)};
const glm::dvec2 D65(0.3127, 0.3290);
/// How far the primaries move towards white: far enough for a pure red 8 stops over middle grey to be white.
constexpr double INSET = 0.4;
/// Degrees by which blue turns about white, towards cyan: pure blue that pales along a straight line turns
/// violet to the eye (Abney 1909). In Oklab's hue, of ten saturated colours over 13 stops, 4 degrees leave a
/// root mean square of 4.5 degrees, weighted by chroma, instead of 5.5; turning red and green gains nothing.
constexpr double BLUE_TURN_DEGREES = -4;

/// RGB of these primaries -> XYZ, where (1, 1, 1) is white (SMPTE RP 177-1993).
glm::dmat3 rgb_to_xyz(const Chromaticities& primaries) {
    const auto colour = [](const glm::dvec2& xy) {
        return glm::dvec3(xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y);
    };
    const glm::dmat3 columns(colour(primaries[0]), colour(primaries[1]), colour(primaries[2]));
    const glm::dvec3 amounts = glm::inverse(columns) * colour(D65);
    return {columns[0] * amounts.x, columns[1] * amounts.y, columns[2] * amounts.z};
}

/// What light of the inset primaries is in Rec. 709: its rows sum to 1, so that grey stays grey.
glm::dmat3 make_inset() {
    Chromaticities primaries = REC709;
    const double angle = glm::radians(BLUE_TURN_DEGREES);
    const glm::dmat2 turn(std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle));
    for (glm::dvec2& primary : primaries)
        primary = D65 + (1 - INSET) * (primary - D65);
    primaries[2] = D65 + turn * (primaries[2] - D65);
    return glm::inverse(rgb_to_xyz(REC709)) * rgb_to_xyz(primaries);
}

} // namespace

double agx_curve(double linear) {
    // Middle grey is the pivot. The slope there, in display values a stop, is d(x^(1/e)) / d(log2 x) times
    // the contrast.
    const double pivot = std::pow(MIDDLE_GREY, 1 / DISPLAY_EXPONENT);
    const double slope = CONTRAST * pivot * std::log(2.0) / DISPLAY_EXPONENT;
    const double stops =
        linear > 0 ? std::clamp(std::log2(linear / MIDDLE_GREY), DARKEST_STOP, BRIGHTEST_STOP) : DARKEST_STOP;

    // Over `reach` stops a straight line would leave the range of `room` above or below the pivot. Bend it:
    // y = slope u / (1 + (c - 1) (u / reach)^p)^(1/p) starts with that slope and, for c = (slope reach /
    // room)^p, ends at y(reach) = room.
    const double reach = stops < 0 ? -DARKEST_STOP : BRIGHTEST_STOP;
    const double room = stops < 0 ? pivot : 1 - pivot;
    const double c = std::pow(slope * reach / room, BEND);
    const double u = std::fabs(stops);
    const double y = slope * u / std::pow(1 + (c - 1) * std::pow(u / reach, BEND), 1 / BEND);
    return std::pow(std::clamp(stops < 0 ? pivot - y : pivot + y, 0.0, 1.0), DISPLAY_EXPONENT);
}

glm::dvec3 agx(const glm::dvec3& linear) {
    static const glm::dmat3 inset = make_inset(), outset = glm::inverse(inset);
    const glm::dvec3 mixed = inset * linear;
    // What lies outside of the display's colours is cut.
    return glm::clamp(outset * glm::dvec3(agx_curve(mixed.x), agx_curve(mixed.y), agx_curve(mixed.z)), 0.0,
                      1.0);
}

} // namespace clrt
