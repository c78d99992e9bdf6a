// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include "error.h"
#include "film/film_buffers.h"
#include "film/film_capacity.h"
#include "render/passes.h"
#include "render/render_params.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

Render render(const PreparedScene& prepared, Progress& progress, const RenderHooks& hooks) {
    const PlannedScene& planned = *prepared.planned;
    const Options& options = planned.options;
    Render result;
    if (hooks.resume)
        static_cast<RenderProgress&>(result) = *hooks.resume;
    Film& film = result.film;
    film.scale = film_scale(planned.scene);
    RenderParams params = launch_params(planned);
    film.width = int(params.crop_width);
    film.height = int(params.crop_height);
    const int fitting = fitting_replicates(prepared.device, params, planned.effects.paths.layers.size());
    if (!hooks.resume) {
        film.replicates = fitting;
        film.shown.assign(film_plane(film) / 3, 0);
    } else
        fold_replicates(film, std::min(fitting, film.replicates));
    params.film_replicates = u32(film.replicates);
    check_film_capacity(options, film);
    if (options.sampling.adaptive && film.replicates != options.sampling.replicates)
        throw DeviceError(
            fmt::format("--adaptive compares {} replicates, but the film of only {} fits the device; take "
                        "a smaller --size or fewer --replicates",
                        options.sampling.replicates, film.replicates));

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
    result.path_layers.assign(options.output.path_layers.size(), film);
    result.stop_text = "no path of the scene is asked for";
    return result;
}

} // namespace clrt
