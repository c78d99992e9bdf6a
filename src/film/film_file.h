// SPDX-License-Identifier: Apache-2.0
// Film files: everything that is needed to go on with a render, or to merge it with others, to the last bit.
// --checkpoint writes them, --resume and clrt-merge read them.
//
//   bytes        what
//   8            "CLRTFILM"
//   4            version of this format, 3
//   4            n, the length of the header
//   n            the header, a JSON object in UTF-8 (film_header.h)
//   8 r w h 3    the sums in units of identity.quantum, as 64-bit integers:
//                [replicate][row][column][red, green, blue]
//   8 w h 3      of each layer of paths (identity.layers), in one replicate
//   16 t         with --adaptive: samples a pixel of t tiles (film.h) as unsigned 32-bit integers: before
//                the round in the first half of the replicates, in the second half, and likewise after
//                the round
//   16 t n       with --adaptive: noise of one sample as 64-bit floating point numbers: n times first
//                half, second half
//   4 n          of a guided film: n nodes of the trees over space as unsigned 32-bit integers
//                (guide/guide.h)
//   534 c        of its c cells: 255 splits as unsigned 16-bit integers (guide/direction_bins.h), then sum
//                and number of records and number of vertices as 64-bit floating point numbers
//   2056 c       sums of the present epoch as unsigned 64-bit integers
//   4 t          of t tiles, what gains weigh (guide/guide_progress.h) as 32-bit floating point numbers;
//                none where the guide is not on trial
//   16           XXH3-128 of all bytes before it, canonical (most significant byte first)
//
// Integers are little endian.
#pragma once

#include "film/bias_sources.h"
#include "film/film_identity.h"
#include "film/render_progress.h"

#include <string>
#include <vector>

namespace clrt {

/// Where a film's samples come from.
struct FilmOrigin {
    std::vector<std::string> command; ///< without --resume
    std::string folder;
    std::string device;
};

/// A film with what belongs to it.
struct FilmFile {
    FilmIdentity identity;
    FilmOrigin origin;
    RenderProgress render;
    BiasSources bias;
};

/// Writes under a temporary name and renames: a killed process leaves the older file whole. Throws
/// SceneError.
void write_film_file(const std::string& path, const FilmFile& film);

/// Reads and checks it all. Throws SceneError that says what was expected and what was found: no film file,
/// another version, truncated, damaged.
FilmFile read_film_file(const std::string& path);

/// Reads the header only. Throws SceneError likewise.
FilmOrigin read_film_origin(const std::string& path);

/// Which samples of what picture a film holds.
struct FilmContent {
    FilmIdentity identity;
    std::vector<SampleRange> ranges; ///< in order
};

/// Reads the header only. Throws SceneError likewise.
FilmContent read_film_content(const std::string& path);

} // namespace clrt
