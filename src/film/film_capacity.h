// SPDX-License-Identifier: Apache-2.0
// How many samples a film holds. No OpenCL here.
#pragma once

#include "film/film.h"
#include "options/options.h"

#include <cstdint>

namespace clrt {

/// Samples a pixel that every sum of the film can hold; a layer of paths has one for all replicates.
std::uint64_t film_capacity(const Film& film, const Options& options);

/// Samples a pixel that the film holds and that 32-bit sample numbers reach.
std::uint64_t film_limit(const Film& film, const Options& options);

/// Throws UsageError for --spp beyond what the film can hold.
void check_film_capacity(const Options& options, const Film& film);

} // namespace clrt
