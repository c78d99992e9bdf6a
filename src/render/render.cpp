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

Render render(const Device& device, const RenderPrograms& programs, const SceneBuffers& buffers,
              const Scene& scene, const Options& options, Progress& progress, const RenderHooks& hooks) {
    Render result;
    if (hooks.resume)
        static_cast<RenderProgress&>(result) = *hooks.resume;
    Film& film = result.film;
    film.scale = film_scale(scene);
    RenderParams params = make_render_params(scene, options, film.scale);
    restrict_lights(programs.paths, params);
    film.width = int(params.crop_width);
    film.height = int(params.crop_height);
    const int fitting = fitting_replicates(device, params, programs.paths.layers.size());
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
    Passes passes(device, programs, buffers, options, params, progress, hooks, result);
    passes.run();
    return result;
}

Render render_nothing(const Scene& scene, const Options& options) {
    const Crop window = render_window(options.film);
    Render result;
    Film& film = result.film;
    film.scale = film_scale(scene);
    film.width = window.x1 - window.x0;
    film.height = window.y1 - window.y0;
    film.sums.resize(film_plane(film));
    result.path_layers.assign(options.output.path_layers.size(), film);
    result.stop_text = "no path of the scene is asked for";
    return result;
}

} // namespace clrt
