// SPDX-License-Identifier: Apache-2.0
// Triangles that are vast beside what lies near them are cut. The error of a hit grows with its triangle: on
// a ground of 1e7 units, hits are off by up to a unit and rays leave tens of units above it, over a ball of
// radius 1. Pieces near the ball have the precision that the ball needs; their number grows with the
// logarithm of the sizes.
#pragma once

#include "scene/scene.h"

#include <cstddef>

namespace clrt {

/// What cut_vast_triangles did.
struct CutTriangles {
    size_t vast = 0;  ///< triangles of the scene that were cut, neighbours that share a cut edge included
    size_t added = 0; ///< triangles more than before
};

/// Cuts triangles whose extent is more than 1024 times the extent of a smaller triangle plus the way to it,
/// at the middle of their longest edges (Rivara 1984): triangles that share an edge are cut at the same
/// point, so meshes stay closed. A piece keeps the index of its triangle, the others are appended. Triangles
/// with different corner normals stay whole, and so do those whose extent is small beside their place, where
/// that decides the error. Positions are in the normalised frame.
CutTriangles cut_vast_triangles(Scene& scene);

} // namespace clrt
