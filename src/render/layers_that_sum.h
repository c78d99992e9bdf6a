// SPDX-License-Identifier: Apache-2.0
// The layers that a film sums beside its picture, as layers of the picture.
#pragma once

#include "film/film.h"
#include "output/image.h"

#include <string>
#include <vector>

namespace clrt {

/// Rounds layers so that they add up in files too. Their sums in the film do to the last quantum, but each
/// mean is rounded by itself. Values are moved by a last digit, the largest ones first, until their sum in
/// double precision, in the layers' order, rounds to `whole`. Both are means, value by value of the same
/// pixels.
void round_to_sum(const std::vector<float>& whole, std::vector<std::vector<float>>& layers);

/// Adds the layers of summed_layers() to a picture that has its radiance alone; strategies add up to that.
void add_summed_layers(const std::vector<std::string>& names, const std::vector<Film>& films,
                       Picture& picture);

} // namespace clrt
