// SPDX-License-Identifier: Apache-2.0
#include "film/merge_films.h"

#include "error.h"
#include "render/error_report.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace clrt {

namespace {

/// The ranges of both, in order, neighbours joined. Throws where they overlap.
std::vector<SampleRange> join_ranges(const Film& a, const std::string& a_path, const Film& b,
                                     const std::string& b_path) {
    std::vector<SampleRange> all = a.ranges;
    all.insert(all.end(), b.ranges.begin(), b.ranges.end());
    std::sort(all.begin(), all.end(),
              [](const SampleRange& x, const SampleRange& y) { return x.first < y.first; });
    std::vector<SampleRange> joined;
    for (const SampleRange& range : all) {
        if (!joined.empty() && range.first < joined.back().end)
            throw SceneError(
                b_path, 0,
                fmt::format("expected samples that {} lacks, found samples {} to {} in both; render "
                            "disjoint ranges with --first-sample",
                            a_path, range.first, std::min(range.end, joined.back().end) - 1));
        if (!joined.empty() && range.first == joined.back().end)
            joined.back().end = range.end;
        else
            joined.push_back(range);
    }
    return joined;
}

/// The pixels in which either shows the scene; not known where one does not know.
std::vector<std::uint8_t> join_shown(const Film& a, const Film& b) {
    if (a.shown.empty() || b.shown.empty())
        return {};
    std::vector<std::uint8_t> joined = a.shown;
    for (size_t pixel = 0; pixel < joined.size(); ++pixel)
        joined[pixel] |= b.shown[pixel];
    return joined;
}

std::string ranges_text(const Film& film) {
    std::string text;
    for (const SampleRange& range : film.ranges)
        text += fmt::format("{}{}-{}", text.empty() ? "" : ", ", range.first, range.end - 1);
    return text;
}

} // namespace

void merge_film(FilmFile& sum, const std::string& sum_path, FilmFile part, const std::string& part_path) {
    for (const auto& [film, path] : {std::pair(&sum, &sum_path), std::pair(&part, &part_path)})
        if (is_adaptive(film->render.film))
            throw SceneError(
                *path, 0,
                "expected a film with adaptive: false, found adaptive: true; the samples of an --adaptive "
                "render were dealt out by its own noise and only --resume can add to them");
    if (const auto difference = identity_difference(sum.identity, part.identity))
        throw SceneError(part_path, 0,
                         fmt::format("expected a film of the same scene and options as {}, found another {}",
                                     sum_path, *difference));
    Film& film = sum.render.film;
    std::vector<SampleRange> ranges = join_ranges(film, sum_path, part.render.film, part_path);

    // Add the sums.
    const int kept = std::gcd(film.replicates, part.render.film.replicates);
    fold_replicates(film, kept);
    fold_replicates(part.render.film, kept);
    bool fits = add_sums(film.sums, part.render.film.sums);
    for (size_t i = 0; i < sum.render.path_layers.size(); ++i)
        fits &= add_sums(sum.render.path_layers[i].sums, part.render.path_layers[i].sums);
    if (!fits)
        throw SceneError(
            part_path, 0,
            fmt::format("expected sums that fit 64 bits together with those of {}, found brighter ones; "
                        "merge fewer samples",
                        sum_path));

    // The command of the first samples is the one that --resume can repeat; errors of parts are none of the
    // whole.
    if (part.render.film.ranges.front().first < film.ranges.front().first)
        sum.origin = part.origin;
    film.ranges = std::move(ranges);
    film.shown = join_shown(film, part.render.film);
    for (Film& layer : sum.render.path_layers)
        layer.ranges = film.ranges;
    sum.render.counts.add(part.render.counts);
    if (!sum.bias.cut_radiance) // a film of which nothing was cut does not tell
        sum.bias.cut_radiance = part.bias.cut_radiance;
    sum.render.seconds += part.render.seconds;
    sum.render.history.clear();
}

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
    picture.layers.push_back({"", {"R", "G", "B"}, film_mean(film), false});
    picture.is_transparent = file.identity.value("background", FilmIdentity()) == TRANSPARENT_BACKGROUND;
    const std::vector<std::string> layer_names = film_layer_names(file.identity);
    for (size_t i = 0; i < layer_names.size(); ++i)
        picture.layers.push_back(
            {layer_names[i], {"R", "G", "B"}, film_mean(file.render.path_layers[i]), false});
    if (std::vector<float> variance = film_variance(film); !variance.empty())
        picture.layers.push_back({"variance", {"R", "G", "B"}, std::move(variance), false});
    picture.layers.push_back({"", {"samples"}, film_pixel_samples(film), false});

    for (const auto& [name, value] : file.identity.items())
        picture.metadata.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
    picture.metadata.emplace_back("spp", std::to_string(film_samples(film)));
    picture.metadata.emplace_back("samples", ranges_text(film));
    add_error_metadata(make_error_report(file.render, file.bias, picture.x0, picture.y0), picture.metadata);
    return picture;
}

} // namespace clrt
