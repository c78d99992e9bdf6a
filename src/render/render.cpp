// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include "options/summed_layers.h"
#include "render/begin_film.h"
#include "render/passes.h"
#include "render/render_params.h"

namespace clrt {

Render render(const PreparedScene& prepared, Progress& progress, const RenderHooks& hooks) {
    Render result;
    const RenderParams params = begin_film(*prepared.planned, {&prepared.device}, hooks.resume, result);
    progress.update({"compile", -1, 0, -1, -1});
    Passes passes(prepared, params, progress, hooks, result);
    passes.run();
    return result;
}

Render render_nothing(const PlannedScene& planned) {
    const Options& options = planned.options;
    const Crop window = render_window(options.film);
    Render result;
    Film& film = result.film;
    film.scale = film_scale(planned.scene);
    film.width = window.x1 - window.x0;
    film.height = window.y1 - window.y0;
    film.sums.resize(film_plane(film));
    result.path_layers.assign(summed_layers(options).size(), film);
    result.stop_text = "no path of the scene is asked for";
    return result;
}

} // namespace clrt
