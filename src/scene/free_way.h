// SPDX-License-Identifier: Apache-2.0
// How far one can go in a scene before its tree is built: every triangle is asked.
#pragma once

#include "scene/scene.h"

#include <vector>

namespace clrt {

/// The way from a point along each direction (unit) to the first triangle; infinite where there is none.
/// Everything in the normalised frame. Time grows with triangles times directions.
std::vector<double> free_ways(const Scene& scene, const glm::dvec3& from,
                              const std::vector<glm::dvec3>& directions);

} // namespace clrt
