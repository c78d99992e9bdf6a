// SPDX-License-Identifier: Apache-2.0
#include "film/merge_films.h"

#include "error.h"

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
    if (const std::optional<HitLight>& hits = part.bias.hits) { // guides of parts are worth more or less
        if (!sum.bias.hits)
            sum.bias.hits = hits;
        sum.bias.hits->radiance = std::max(sum.bias.hits->radiance, hits->radiance);
    }
    sum.render.seconds += part.render.seconds;
    sum.render.history.clear();
    sum.render.guide = {}; // what was learnt is of one part alone: samples that --resume adds are not guided
}

} // namespace clrt
