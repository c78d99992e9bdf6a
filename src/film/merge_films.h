// SPDX-License-Identifier: Apache-2.0
// Film files of disjoint sample ranges -> the film of one run.
#pragma once

#include "film/film_file.h"

#include <string>

namespace clrt {

/// Adds `part` to `sum`; sums are integers, so that any order gives the same bits. Where one keeps fewer
/// replicates apart, both are folded to theirs. The paths name the files in messages. Throws SceneError that
/// names the field in which they differ, or the samples that both hold.
void merge_film(FilmFile& sum, const std::string& sum_path, FilmFile part, const std::string& part_path);

} // namespace clrt
