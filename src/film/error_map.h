// SPDX-License-Identifier: Apache-2.0
// Where in a picture its error is.
#pragma once

#include "film/error_measure.h"

#include <vector>

namespace clrt {

/// The error of each pixel, rows from the top: the root of its squared error by a measure, averaged over the
/// channels, over the picture's mean radiance. So the root mean square over the pixels that show the scene
/// (ErrorPixels::SCENE) is the picture's error (FilmError); the others have 0. Empty where fewer than two
/// replicates have samples, or the picture is black.
std::vector<float> error_map(const Film& film, ErrorMeasure measure);

} // namespace clrt
