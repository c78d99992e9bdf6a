// SPDX-License-Identifier: Apache-2.0
#include "render/begin_film.h"

#include "error.h"
#include "film/film_buffers.h"
#include "film/film_capacity.h"
#include "film/film_error.h"
#include "options/summed_layers.h"
#include "render/prepared_scene.h"

#include <algorithm>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// Says what layers of strategies take.
void say_layers(const Options& options, const Film& film) {
    if (strategy_segments(options) == 0)
        return;
    const size_t layers = summed_layers(options).size();
    spdlog::info("strategies of up to {} segments: {} layers, {:.3g} MB beside the {:.3g} MB of the film",
                 strategy_segments(options), layers, double(layers * film_plane(film)) * 8e-6,
                 double(size_t(film.replicates) * film_plane(film)) * 8e-6);
}

} // namespace

RenderParams begin_film(const PlannedScene& planned, const std::vector<const Device*>& devices,
                        const RenderProgress* resume, Render& result) {
    const Options& options = planned.options;
    if (resume)
        static_cast<RenderProgress&>(result) = *resume;
    Film& film = result.film;
    film.scale = film_scale(planned.scene);
    RenderParams params = launch_params(planned);
    film.width = int(params.crop_width);
    film.height = int(params.crop_height);
    film.block = error_block(options.transport.integrator, options.transport.path_reuse == Toggle::ON);
    int fitting = int(params.replicates);
    for (const Device* device : devices)
        fitting = std::min(fitting, fitting_replicates(*device, params, summed_layers(options).size()));
    if (!resume) {
        film.replicates = fitting;
        film.shown.assign(film_plane(film) / 3, 0);
    } else
        fold_replicates(film, std::min(fitting, film.replicates));
    params.film_replicates = u32(film.replicates);
    say_layers(options, film);
    check_film_capacity(options, film);
    if (is_adaptive(options) && film.replicates != options.sampling.replicates)
        throw DeviceError(
            fmt::format("--adaptive compares {} replicates, but the film of only {} fits the device; take "
                        "a smaller --size or fewer --replicates",
                        options.sampling.replicates, film.replicates));
    return params;
}

} // namespace clrt
