// SPDX-License-Identifier: Apache-2.0
#include "render/film_picture.h"

#include "render/error_report.h"
#include "render/layer_table.h"
#include "render/layers_that_sum.h"

#include <fmt/format.h>

namespace clrt {

namespace {

std::string ranges_text(const Film& film) {
    std::string text;
    for (const SampleRange& range : film.ranges)
        text += fmt::format("{}{}-{}", text.empty() ? "" : ", ", range.first, range.end - 1);
    return text;
}

} // namespace

Picture film_picture(const FilmFile& file) {
    const Film& film = file.render.film;
    const FilmWindow window = film_window(file.identity);
    Picture picture;
    picture.width = film.width;
    picture.height = film.height;
    picture.x0 = window.window.x0;
    picture.y0 = window.window.y0;
    picture.full_width = window.size.x;
    picture.full_height = window.size.y;
    picture.layers.push_back(make_radiance_layer(film_mean(film)));
    picture.is_transparent = file.identity.value("background", FilmIdentity()) == TRANSPARENT_BACKGROUND;
    add_summed_layers(film_layer_names(file.identity), file.render.path_layers, picture);
    if (std::vector<float> variance = film_variance(film); !variance.empty())
        picture.layers.push_back(make_layer(*find_layer("variance"), std::move(variance)));
    picture.layers.push_back(make_layer(*find_layer("samples"), film_pixel_samples(film)));

    for (const auto& [name, value] : file.identity.items())
        picture.metadata.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
    picture.metadata.emplace_back("spp", std::to_string(film_samples(film)));
    picture.metadata.emplace_back("samples", ranges_text(film));
    add_error_metadata(make_error_report(file.render, file.bias, picture.x0, picture.y0), picture.metadata);
    return picture;
}

} // namespace clrt
