// SPDX-License-Identifier: Apache-2.0
// The pixels that an error is stated over.
#pragma once

#include "film/film.h"

namespace clrt {

enum class ErrorPixels {
    SCENE, ///< those that show the scene; all where that is not known, and where none does
    ALL
};

/// Whether the error over the scene leaves pixels out: those that show nothing but what is behind it.
inline bool has_backdrop(const Film& film) {
    const std::optional<size_t> shown = film_shown_pixels(film);
    return shown && *shown > 0 && *shown < film.shown.size();
}

/// Tells whether an error is stated over a pixel. Refers to the film.
class PixelChoice {
public:
    PixelChoice(const Film& film, ErrorPixels pixels)
        : shown_(pixels == ErrorPixels::SCENE && has_backdrop(film) ? film.shown.data() : nullptr) {}
    bool has(size_t pixel) const { return !shown_ || shown_[pixel]; }

private:
    const std::uint8_t* shown_;
};

} // namespace clrt
