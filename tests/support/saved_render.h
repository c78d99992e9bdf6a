// SPDX-License-Identifier: Apache-2.0
// A render that is saved and gone on with.
#pragma once

#include "film/film_file.h"
#include "support/render_scene.h"

namespace clrt {

/// The render's film file, written to the scene's folder and read back.
inline RenderProgress through_a_file(const Render& render, const TestScene& scene) {
    const std::string path = scene.folder.file("part.film");
    FilmFile film;
    film.identity = {{"quantum", render.film.scale.quantum}, {"largest", render.film.scale.largest}};
    film.identity["size"] = {render.film.width, render.film.height};
    film.identity["window"] = {0, 0, render.film.width, render.film.height};
    film.render = render;
    write_film_file(path, film);
    return read_film_file(path).render;
}

} // namespace clrt
