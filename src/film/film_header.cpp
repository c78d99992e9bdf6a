// SPDX-License-Identifier: Apache-2.0
#include "film/film_header.h"

#include "film/film_error.h"
#include "film/guide_header.h"
#include "film/whole_numbers.h"

#include <algorithm>

namespace clrt {

namespace {

using Json = FilmHeader;

/// More of them are left out of the header, which they would make too large.
constexpr size_t MOST_BAD_PIXELS = size_t(1) << 20;

/// More of them, too.
constexpr size_t MOST_RUNS = size_t(1) << 20;

/// Lengths of the runs of pixels that do not show the scene, that do, that do not, ...
PixelRuns runs_of(const std::vector<std::uint8_t>& shown) {
    PixelRuns runs;
    for (size_t first = 0, end = 0; first < shown.size() && runs.size() <= MOST_RUNS; first = end) {
        const std::uint8_t kind = runs.size() % 2;
        end = size_t(std::find(shown.begin() + std::ptrdiff_t(first), shown.end(), 1 - kind) - shown.begin());
        runs.push_back(end - first);
    }
    return runs;
}

Json counts_json(const RenderCounts& counts) {
    Json json = {{"primary", counts.primary},       {"secondary", counts.secondary},
                 {"shadow", counts.shadow},         {"cut_paths", counts.cut_paths},
                 {"cut_weight", counts.cut_weight}, {"nan", counts.nan},
                 {"infinite", counts.infinite},     {"negative", counts.negative},
                 {"overflow", counts.overflow},     {"bad_samples", counts.bad_samples}};
    if (!counts.bad_pixels.empty() && counts.bad_pixels.size() <= MOST_BAD_PIXELS)
        json["bad_pixels"] = counts.bad_pixels; // pairs of pixel and count
    return json;
}

RenderCounts read_counts(const Json& json) {
    RenderCounts counts;
    counts.primary = whole<decltype(counts.primary)>(json.at("primary"));
    counts.secondary = whole<decltype(counts.secondary)>(json.at("secondary"));
    counts.shadow = whole<decltype(counts.shadow)>(json.at("shadow"));
    counts.cut_paths = whole<decltype(counts.cut_paths)>(json.at("cut_paths"));
    counts.cut_weight = whole<decltype(counts.cut_weight)>(json.at("cut_weight"));
    counts.nan = whole<decltype(counts.nan)>(json.at("nan"));
    counts.infinite = whole<decltype(counts.infinite)>(json.at("infinite"));
    counts.negative = whole<decltype(counts.negative)>(json.at("negative"));
    counts.overflow = whole<decltype(counts.overflow)>(json.at("overflow"));
    counts.bad_samples = whole<decltype(counts.bad_samples)>(json.at("bad_samples"));
    if (json.contains("bad_pixels"))
        counts.bad_pixels = whole<decltype(counts.bad_pixels)>(json.at("bad_pixels"));
    return counts;
}

Json history_json(const std::vector<SquaredError>& history) {
    Json json = Json::array();
    for (const SquaredError& error : history)
        json.push_back({{"samples", error.samples},
                        {"mean_squared", error.mean_squared},
                        {"mean_radiance", error.mean_radiance},
                        {"without", error.without}});
    return json;
}

std::vector<SquaredError> read_history(const Json& json) {
    std::vector<SquaredError> history;
    for (const Json& error : json)
        history.push_back({whole<std::uint64_t>(error.at("samples")), error.at("mean_squared"),
                           error.at("mean_radiance"), error.at("without").get<std::vector<double>>()});
    return history;
}

std::vector<SampleRange> read_ranges(const Json& json) {
    std::vector<SampleRange> ranges;
    for (const Json& range : json.at("ranges"))
        ranges.push_back({whole<std::uint64_t>(range.at(0)), whole<std::uint64_t>(range.at(1))});
    return ranges;
}

/// Powers of two among the samples of a tile.
constexpr size_t MOST_LEVELS = 32;

/// The round of an adaptive film, with room for the samples of its tiles.
AdaptiveRound read_round(const Json& json, const Film& film, ErrorMeasure measure) {
    AdaptiveRound round;
    round.measure = measure;
    round.first = whole<std::uint64_t>(json.at("first"));
    round.end = whole<std::uint64_t>(json.at("end"));
    json.at("gain").get_to(round.gain);
    for (TileSamples* samples : {&round.start, &round.target})
        for (std::vector<std::uint32_t>& half : *samples)
            half.resize(film_tiles(film));
    const std::vector<double> noise(film_tiles(film));
    round.noise.assign(std::min(whole<size_t>(json.at("levels")), MOST_LEVELS), {noise, noise});
    return round;
}

HitLight read_hits(const Json& json) {
    HitLight hits{json.at("paths"), json.at("radiance")};
    if (!(hits.radiance >= 0))
        throw Json::out_of_range::create(401, "expected a radiance of 0 or more", &json);
    return hits;
}

} // namespace

FilmHeader film_header(const FilmFile& film) {
    const RenderProgress& render = film.render;
    Json json;
    json["identity"] = film.identity;
    json["command"] = film.origin.command;
    json["folder"] = film.origin.folder;
    json["device"] = film.origin.device;
    json["replicates"] = render.film.replicates;
    json["ranges"] = Json::array();
    for (const SampleRange& range : render.film.ranges)
        json["ranges"].push_back({range.first, range.end});
    if (is_adaptive(render.film))
        json["round"] = {{"first", render.round.first},
                         {"end", render.round.end},
                         {"gain", render.round.gain},
                         {"levels", render.round.noise.size()}};
    if (render.guide.end != 0)
        json["guide"] = guide_header(render.guide);
    json["counts"] = counts_json(render.counts);
    const std::optional<double>& radiance = film.bias.cut_radiance;
    json["cut_radiance"] = radiance ? Json(*radiance) : Json(nullptr);
    json["blind_spots"] = blind_spots_json(film.bias.blind_spots);
    if (const std::optional<HitLight>& hits = film.bias.hits)
        json["hits"] = {{"paths", hits->paths}, {"radiance", hits->radiance}};
    if (const PixelRuns runs = runs_of(render.film.shown); !runs.empty() && runs.size() <= MOST_RUNS)
        json["shown"] = runs;
    json["history"] = history_json(render.history);
    json["seconds"] = render.seconds;
    return json;
}

FilmContent film_content_of(const FilmHeader& json) {
    return {json.at("identity"), read_ranges(json)};
}

FilmOrigin film_origin_of(const FilmHeader& json) {
    return {json.at("command"), json.at("folder"), json.at("device")};
}

FilmFile film_of_header(const FilmHeader& json) {
    FilmFile film;
    film.identity = json.at("identity");
    film.origin = film_origin_of(json);
    Film& sums = film.render.film;
    const Crop window = film_window(film.identity).window;
    sums.width = window.x1 - window.x0;
    sums.height = window.y1 - window.y0;
    sums.scale = {film.identity.at("quantum"), film.identity.at("largest")};
    sums.replicates = whole<int>(json.at("replicates"));
    sums.block = error_block(film_integrator(film.identity), film_reuses_paths(film.identity));
    sums.ranges = read_ranges(json);
    if (const std::optional<ErrorMeasure> measure = film_measure(film.identity))
        film.render.round = read_round(json.at("round"), sums, *measure);
    if (json.contains("guide"))
        film.render.guide = guide_of_header(json.at("guide"));
    film.render.counts = read_counts(json.at("counts"));
    if (const Json& radiance = json.at("cut_radiance"); !radiance.is_null())
        film.bias.cut_radiance = radiance.get<double>();
    film.bias.blind_spots = read_blind_spots(json.at("blind_spots"));
    if (json.contains("hits"))
        film.bias.hits = read_hits(json.at("hits"));
    film.render.history = read_history(json.at("history"));
    json.at("seconds").get_to(film.render.seconds);
    film.render.path_layers.assign(film_layer_names(film.identity).size(), film_layer(sums));
    return film;
}

PixelRuns shown_runs_of(const FilmHeader& json) {
    return json.contains("shown") ? whole<PixelRuns>(json.at("shown")) : PixelRuns();
}

std::optional<std::vector<std::uint8_t>> shown_of_runs(const PixelRuns& runs, size_t pixels) {
    std::vector<std::uint8_t> shown;
    for (size_t i = 0; i < runs.size(); ++i) {
        if (runs[i] > pixels - shown.size())
            return std::nullopt;
        shown.resize(shown.size() + runs[i], std::uint8_t(i % 2));
    }
    if (shown.size() != pixels)
        return std::nullopt;
    return shown;
}

bool is_possible(const AdaptiveRound& round, const Film& film) {
    const std::uint64_t samples = film_samples(film);
    bool possible = round.first < round.end && round.first <= samples && samples <= round.end &&
                    film.replicates % 2 == 0 && film.ranges.size() == 1 && film.ranges[0].first == 0;
    const std::uint64_t most = FILM_SAMPLES_PER_REPLICATE * std::uint64_t(film.replicates);
    for (int half = 0; half < 2; ++half)
        for (size_t tile = 0; tile < round.start[half].size(); ++tile)
            possible = possible && round.start[half][tile] <= round.target[half][tile] &&
                       round.target[half][tile] <= most;
    return possible;
}

} // namespace clrt
