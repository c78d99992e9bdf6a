// SPDX-License-Identifier: Apache-2.0
#include "view/snapshot.h"

#include "film/error_map.h"
#include "render/render_params.h"

namespace clrt {

SnapshotPointer make_snapshot(const Render& render, const Options& options) {
    auto snapshot = std::make_shared<Snapshot>();
    const Crop window = render_window(options.film);
    snapshot->width = render.film.width;
    snapshot->height = render.film.height;
    snapshot->x0 = window.x0;
    snapshot->y0 = window.y0;
    snapshot->rgb = film_mean(render.film);
    snapshot->errors = error_map(render.film, options.sampling.measure());
    snapshot->error = render.error;
    snapshot->samples = film_samples(render.film);
    snapshot->seconds = render.seconds;
    snapshot->guided_from = render.guide.guided_from;
    return snapshot;
}

} // namespace clrt
