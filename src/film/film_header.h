// SPDX-License-Identifier: Apache-2.0
// The header of a film file, a JSON object:
//   identity      every field that decides the bits (film_identity.h)
//   command       the command line, word by word, that --resume alone repeats
//   folder        where it was given
//   device        on which the samples were rendered
//   replicates    whose sums are kept apart
//   ranges        of sample numbers inside, [first, end), in order
//   round         with --adaptive: first and end, mean samples a pixel of the present round; gain that each
//                 half expects; levels of noise behind the tiles' samples
//   guide         where paths are or may be guided: stage and epoch (guide/guide_progress.h), numbers of
//   nodes
//                 and cells
//   counts        rays, cut paths and bad samples; bad_samples lists pairs of pixel and sample,
//                 bad_pixels (absent without bad samples) pairs of pixel and count
//   cut_radiance  what bounds the light of cut paths (render/cut_paths.h), or null
//   blind_spots   paths that no sample shows: paths, cause, where
//   hits          light that only hits find: paths, and the most a sample brings; absent: none or unknown
//   shown         pixels that show the scene: lengths of runs of pixels, row by row, that do not, that do,
//                 that do not, ...; absent where that is not known
//   history       errors at doublings of the samples
//   seconds       of rendering
#pragma once

#include "film/film_file.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace clrt {

using FilmHeader = nlohmann::ordered_json;

/// The header of a film.
FilmHeader film_header(const FilmFile& film);

// What a header says. All throw FilmHeader::exception where it lacks something, or has another type.

/// Everything but what lies behind the header: the sums and what the tiles of an adaptive film have, for
/// which there is room.
FilmFile film_of_header(const FilmHeader& header);
FilmOrigin film_origin_of(const FilmHeader& header);
FilmContent film_content_of(const FilmHeader& header);

/// Lengths of runs of pixels, row by row: those that do not show the scene, that do, that do not, ...
using PixelRuns = std::vector<std::uint64_t>;
/// Empty where it is not known.
PixelRuns shown_runs_of(const FilmHeader& header);
/// Film::shown; none where the runs are not those of so many pixels.
std::optional<std::vector<std::uint8_t>> shown_of_runs(const PixelRuns& runs, size_t pixels);

/// Whether a round is one that this film can be in.
bool is_possible(const AdaptiveRound& round, const Film& film);

} // namespace clrt
