// SPDX-License-Identifier: Apache-2.0
#include "options/path_refusals.h"

#include "kernels/shared/render_types.h"

namespace clrt {

namespace {

/// Their spread tells the noise that a guide is to lower.
constexpr int FEWEST_GUIDED_REPLICATES = 4;

/// Whether a side of a window is one of a tile of the whole picture, which has this size.
bool is_tile_side(int x, int size) {
    return x % TILE_SIZE == 0 || x == size;
}

/// Whether the window is made of whole tiles of the picture.
bool has_whole_tiles(const FilmOptions& film) {
    return !film.crop ||
           (film.crop->x0 % TILE_SIZE == 0 && film.crop->y0 % TILE_SIZE == 0 &&
            is_tile_side(film.crop->x1, film.size.x) && is_tile_side(film.crop->y1, film.size.y));
}

} // namespace

std::optional<PathRefusal> guide_refusal(const Options& options) {
    if (!takes_option(options.transport.integrator, TAKES_GUIDE))
        return PathRefusal{"--integrator", "its paths are not guided"};
    if (options.sampling.first_sample != 0)
        return PathRefusal{"--first-sample", "guided samples need those before them; render other parts of a "
                                             "picture with other seeds"};
    if (is_adaptive(options))
        return PathRefusal{"--adaptive",
                           "its halves decide for each other and must not share what paths have learnt"};
    if (options.sampling.replicates < FEWEST_GUIDED_REPLICATES)
        return PathRefusal{"--replicates", "the spread of four or more tells what a guide is worth"};
    if (shares_picture(options.device))
        return PathRefusal{"--device with several names",
                           "guided samples need all those before them, which devices take at once"};
    if (options.run.ledger != LedgerOf::NOTHING)
        return PathRefusal{"--ledger", "the ledger compares pictures of the same samples"};
    if (options.run.pixel)
        return PathRefusal{"--pixel", "a guided sample needs all samples before it"};
    return std::nullopt;
}

std::optional<PathRefusal> reuse_refusal(const Options& options) {
    if (!takes_option(options.transport.integrator, TAKES_PATH_REUSE))
        return PathRefusal{"--integrator", "its paths are not reused"};
    if (options.transport.roulette_depth < 2)
        return PathRefusal{"--roulette-depth 1", "a path that ends at its first vertex leaves nothing"};
    if (!has_whole_tiles(options.film))
        return PathRefusal{"--crop",
                           "paths serve the pixels of a tile, so the window must be of whole tiles of "
                           "8 x 8 pixels"};
    if (options.run.ledger != LedgerOf::NOTHING)
        return PathRefusal{"--ledger", "the ledger tells what effects cost where every path is its own"};
    if (options.run.pixel)
        return PathRefusal{"--pixel", "a replay shows one path alone"};
    return std::nullopt;
}

bool may_guide(const Options& options) {
    return options.transport.guide != Toggle::OFF && !guide_refusal(options);
}

} // namespace clrt
