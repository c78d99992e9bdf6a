// SPDX-License-Identifier: Apache-2.0
#include "film/film_capacity.h"

#include "error.h"
#include "options/summed_layers.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

std::uint64_t film_capacity(const Film& film, const Options& options) {
    return FILM_SAMPLES_PER_REPLICATE * std::uint64_t(summed_layers(options).empty() ? film.replicates : 1);
}

std::uint64_t film_limit(const Film& film, const Options& options) {
    const std::uint64_t next = film.ranges.empty() ? options.sampling.first_sample : film.ranges.back().end;
    return std::min(film_capacity(film, options), film_samples(film) + UINT32_MAX - next);
}

void check_film_capacity(const Options& options, const Film& film) {
    const std::uint64_t most = film_capacity(film, options);
    if (options.sampling.spp && *options.sampling.spp > most)
        throw UsageError(fmt::format("--spp {}: the film holds at most {} samples a pixel with {}; "
                                     "render disjoint ranges with --first-sample",
                                     *options.sampling.spp, most,
                                     summed_layers(options).empty()
                                         ? fmt::format("{} replicates", film.replicates)
                                         : "layers of paths"));
}

} // namespace clrt
