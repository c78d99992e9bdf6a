// SPDX-License-Identifier: Apache-2.0
#include "render/picture.h"

#include "options/summed_layers.h"
#include "render/layer_table.h"
#include "render/layers_that_sum.h"
#include "render/render_params.h"

#include <algorithm>

namespace clrt {

namespace {

bool is_wanted(const LayerRow& row, const Render& render, const Options& options) {
    const auto& asked = options.output.aovs;
    if (asked)
        return std::find(asked->begin(), asked->end(), row.name) != asked->end();
    return row.by_default == LayerDefault::SHOWN ||
           (row.by_default == LayerDefault::SHOWN_WHERE_BAD && !render.counts.bad_pixels.empty());
}

/// The denoised picture and its error by tiles, where there is one.
void add_denoised_layers(const Render& render, const Options& options, Picture& picture) {
    if (!render.denoised)
        return;
    if (options.denoise.png_from == PngFrom::DENOISED)
        picture.displayed = picture.layers.size();
    picture.layers.push_back({DENOISED_LAYER, {"R", "G", "B"}, render.denoised->radiance});
    if (render.denoised->errors)
        picture.layers.push_back({ERROR_LAYER, {DENOISED_LAYER}, render.denoised->errors->tiles});
}

} // namespace

Picture make_plain_picture(const Render& render, const Options& options) {
    const Crop window = render_window(options.film);
    Picture picture;
    picture.width = render.film.width;
    picture.height = render.film.height;
    picture.x0 = window.x0;
    picture.y0 = window.y0;
    picture.full_width = options.film.size.x;
    picture.full_height = options.film.size.y;
    picture.layers.push_back(make_radiance_layer(film_mean(render.film), options.output.exr_names));
    picture.is_transparent = has_transparent_background(options.light);
    return picture;
}

Picture make_picture(const Render& render, const Scene& scene, const Options& options) {
    Picture picture = make_plain_picture(render, options);
    std::vector<std::string> summed;
    for (const PathLayerOption& layer : summed_layers(options))
        summed.push_back(layer.name);
    add_summed_layers(summed, render.path_layers, picture);
    add_denoised_layers(render, options, picture);
    for (const LayerRow& row : layer_table()) {
        if (!is_wanted(row, render, options) && !(picture.is_transparent && row.name == ALPHA_LAYER))
            continue;
        std::vector<float> values = row.make({render, scene, options});
        if (values.empty())
            continue;
        picture.layers.push_back(make_layer(row, std::move(values), options.output.exr_names));
        if (row.attributes)
            picture.layers.back().attributes = row.attributes(scene);
    }
    const bool has_coverage = std::any_of(picture.layers.begin(), picture.layers.end(),
                                          [](const Layer& layer) { return layer.is_coverage; });
    if (options.output.exr_names == ExrNames::BLENDER && !picture.is_transparent && !has_coverage)
        picture.layers.push_back(make_opaque_layer(film_plane(render.film) / 3));
    return picture;
}

} // namespace clrt
