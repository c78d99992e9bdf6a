// SPDX-License-Identifier: Apache-2.0
// A tone curve in the manner of AgX (Troy Sobotka, 2019): bright saturated light goes to white, as on film,
// instead of to the nearest corner of the colour cube.
#pragma once

#include <glm/vec3.hpp>

namespace clrt {

/// Linear Rec. 709 RGB from 0 -> linear RGB in 0..1, in three steps: primaries are moved towards white, so
/// that saturated light has some of every channel; each channel goes through a sigmoid over the logarithm of
/// radiance; and the primaries are moved back, so that colours around middle grey stay what they are. Grey
/// stays grey, and middle grey 0.18 is mapped to itself, the four stops about it to four stops.
glm::dvec3 agx(const glm::dvec3& linear);

/// The sigmoid of one channel: 0 ten stops below middle grey and under, 1 six and a half above it and over,
/// rising between them.
double agx_curve(double linear);

} // namespace clrt
