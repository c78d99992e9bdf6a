// SPDX-License-Identifier: Apache-2.0
#include "film/film_file.h"

#include "error.h"
#include "film/whole_numbers.h"
#include "output/atomic_file.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <xxhash.h>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

constexpr char MAGIC[] = "CLRTFILM";
constexpr size_t MAGIC_BYTES = 8, START_BYTES = 16, CHECKSUM_BYTES = 16;
constexpr std::uint32_t FORMAT_VERSION = 2;
/// Larger than any header; keeps a damaged length from asking for all memory.
constexpr std::uint32_t LARGEST_HEADER = 1u << 26;

/// Appends an unsigned number, least significant byte first.
template <class T>
void append_little_endian(std::string& bytes, T value) {
    for (size_t i = 0; i < sizeof value; ++i)
        bytes += char((value >> (8 * i)) & 0xff);
}

std::uint32_t read_little_endian(const std::string& bytes, size_t at) {
    std::uint32_t value = 0;
    for (size_t i = 0; i < sizeof value; ++i)
        value |= std::uint32_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
}

// Sums are written and read as they lie in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "film files need their sums swapped on this machine");

/// Checksum of all bytes of a file but the last.
class Checksum {
public:
    Checksum() : state_(XXH3_createState(), XXH3_freeState) {
        if (!state_)
            throw std::bad_alloc();
        XXH3_128bits_reset(state_.get());
    }
    void add(const void* bytes, size_t count) { XXH3_128bits_update(state_.get(), bytes, count); }
    std::string text() const {
        XXH128_canonical_t canonical;
        XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_.get()));
        return std::string(reinterpret_cast<const char*>(canonical.digest), sizeof canonical.digest);
    }

private:
    std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

/// More of them are left out of the header, which they would make too large.
constexpr size_t MOST_BAD_PIXELS = size_t(1) << 20;

/// More of them, too.
constexpr size_t MOST_RUNS = size_t(1) << 20;

using Runs = std::vector<std::uint64_t>;

/// Lengths of the runs of pixels that do not show the scene, that do, that do not, ...
Runs runs_of(const std::vector<std::uint8_t>& shown) {
    Runs runs;
    for (size_t first = 0, end = 0; first < shown.size() && runs.size() <= MOST_RUNS; first = end) {
        const std::uint8_t kind = runs.size() % 2;
        end = size_t(std::find(shown.begin() + std::ptrdiff_t(first), shown.end(), 1 - kind) - shown.begin());
        runs.push_back(end - first);
    }
    return runs;
}

/// The other way round; none where they are not the runs of so many pixels.
std::optional<std::vector<std::uint8_t>> shown_of(const Runs& runs, size_t pixels) {
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

Json header_json(const FilmFile& film) {
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
        json["round"] = {render.round.first, render.round.end, render.round.noise.size()};
    json["counts"] = counts_json(render.counts);
    const std::optional<double>& radiance = film.bias.cut_radiance;
    json["cut_radiance"] = radiance ? Json(*radiance) : Json(nullptr);
    json["blind_spots"] = blind_spots_json(film.bias.blind_spots);
    if (const Runs runs = runs_of(render.film.shown); !runs.empty() && runs.size() <= MOST_RUNS)
        json["shown"] = runs;
    json["history"] = Json::array();
    for (const SquaredError& error : render.history)
        json["history"].push_back({{"samples", error.samples},
                                   {"mean_squared", error.mean_squared},
                                   {"mean_radiance", error.mean_radiance},
                                   {"without", error.without}});
    json["seconds"] = render.seconds;
    return json;
}

std::vector<SampleRange> read_ranges(const Json& json) {
    std::vector<SampleRange> ranges;
    for (const Json& range : json.at("ranges"))
        ranges.push_back({whole<std::uint64_t>(range.at(0)), whole<std::uint64_t>(range.at(1))});
    return ranges;
}

FilmContent read_content(const Json& json) {
    return {json.at("identity"), read_ranges(json)};
}

FilmOrigin read_origin(const Json& json) {
    return {json.at("command"), json.at("folder"), json.at("device")};
}

/// Powers of two among the samples of a tile.
constexpr size_t MOST_LEVELS = 32;

/// The round of an adaptive film, with room for the samples of its tiles.
AdaptiveRound read_round(const Json& json, const Film& film) {
    AdaptiveRound round;
    round.first = whole<std::uint64_t>(json.at(0));
    round.end = whole<std::uint64_t>(json.at(1));
    for (TileSamples* samples : {&round.start, &round.target})
        for (std::vector<std::uint32_t>& half : *samples)
            half.resize(film_tiles(film));
    const std::vector<double> noise(film_tiles(film));
    round.noise.assign(std::min(whole<size_t>(json.at(2)), MOST_LEVELS), {noise, noise});
    return round;
}

/// Whether a round is one that this film can be in.
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

/// Everything but the sums and the samples of tiles.
FilmFile read_header(const Json& json) {
    FilmFile film;
    film.identity = json.at("identity");
    film.origin = read_origin(json);
    Film& sums = film.render.film;
    const Crop window = film_window(film.identity).window;
    sums.width = window.x1 - window.x0;
    sums.height = window.y1 - window.y0;
    sums.scale = {film.identity.at("quantum"), film.identity.at("largest")};
    sums.replicates = whole<int>(json.at("replicates"));
    sums.ranges = read_ranges(json);
    if (film.identity.value("adaptive", false))
        film.render.round = read_round(json.at("round"), sums);
    film.render.counts = read_counts(json.at("counts"));
    if (const Json& radiance = json.at("cut_radiance"); !radiance.is_null())
        film.bias.cut_radiance = radiance.get<double>();
    film.bias.blind_spots = read_blind_spots(json.at("blind_spots"));
    for (const Json& error : json.at("history"))
        film.render.history.push_back({whole<std::uint64_t>(error.at("samples")), error.at("mean_squared"),
                                       error.at("mean_radiance"),
                                       error.at("without").get<std::vector<double>>()});
    json.at("seconds").get_to(film.render.seconds);
    film.render.path_layers.assign(film_layer_names(film.identity).size(), film_layer(sums));
    return film;
}

/// A film file that is being read.
class FilmReader {
public:
    explicit FilmReader(const std::string& path) : path_(path), input_(path, std::ios::binary) {
        std::error_code error;
        size_ = std::filesystem::file_size(path, error);
        if (!input_ || error)
            throw SceneError(path, 0,
                             "expected a film file as --checkpoint writes it, found none that can be read");
    }

    /// Checks the beginning and parses the header.
    Json header() {
        std::string start = take(START_BYTES);
        if (start.compare(0, MAGIC_BYTES, MAGIC) != 0)
            reject("expected a film file as --checkpoint writes it, found another kind of file; pictures "
                   "lack the "
                   "sums that --resume and clrt-merge need");
        const std::uint32_t version = read_little_endian(start, MAGIC_BYTES);
        if (version != FORMAT_VERSION)
            reject(fmt::format("expected format version {}, found {}", FORMAT_VERSION, version));
        const std::uint32_t length = read_little_endian(start, MAGIC_BYTES + 4);
        if (length > LARGEST_HEADER)
            reject(fmt::format("damaged: expected a header of at most {} bytes, found {}", LARGEST_HEADER,
                               length));
        Json json = Json::parse(take(length), nullptr, false);
        if (json.is_discarded())
            reject("damaged: the header is no JSON");
        return json;
    }

    /// Reads the sums of film and layers and compares the checksum.
    void sums(RenderProgress& render) {
        const std::uint64_t plane = film_plane(render.film),
                            count = std::uint64_t(render.film.replicates) * plane;
        const std::uint64_t tiles = render.round.start[0].size() * (1 + render.round.noise.size());
        const std::uint64_t expected =
            position_ + 8 * (count + render.path_layers.size() * plane) + 16 * tiles + CHECKSUM_BYTES;
        if (size_ != expected)
            reject(fmt::format("{}: expected {} bytes, found {}", size_ < expected ? "truncated" : "damaged",
                               expected, size_));
        render.film.sums.resize(count);
        take(render.film.sums.data(), 8 * count);
        for (Film& layer : render.path_layers) {
            layer.sums.resize(plane);
            take(layer.sums.data(), 8 * plane);
        }
        for (TileSamples* samples : {&render.round.start, &render.round.target})
            for (std::vector<std::uint32_t>& half : *samples)
                take(half.data(), 4 * half.size());
        for (TileNoise& noise : render.round.noise)
            for (std::vector<double>& half : noise)
                take(half.data(), 8 * half.size());
        const std::string computed = checksum_.text();
        if (take(CHECKSUM_BYTES) != computed)
            reject("damaged: the checksum at its end differs from that of its content");
    }

    [[noreturn]] void reject(const std::string& message) const { throw SceneError(path_, 0, message); }

private:
    void take(void* bytes, size_t count) {
        input_.read(static_cast<char*>(bytes), std::streamsize(count));
        if (size_t(input_.gcount()) != count)
            reject(fmt::format("truncated: expected {} bytes or more, found {}", position_ + count, size_));
        checksum_.add(bytes, count);
        position_ += count;
    }
    std::string take(size_t count) {
        std::string bytes(std::min<std::uint64_t>(count, size_ + 1), '\0');
        take(bytes.data(), bytes.size());
        return bytes;
    }

    std::string path_;
    std::ifstream input_;
    Checksum checksum_;
    std::uint64_t size_ = 0, position_ = 0;
};

/// Parses a header; a wrong one is the file's fault.
template <class Parse>
auto parse_header(FilmReader& reader, Parse&& parse) {
    const Json json = reader.header();
    try {
        return parse(json);
    } catch (const Json::exception& error) {
        reader.reject(fmt::format("damaged: the header lacks what it must have ({})", error.what()));
    }
}

} // namespace

void write_film_file(const std::string& path, const FilmFile& film) {
    const std::string header = header_json(film).dump();
    std::string start(MAGIC, MAGIC_BYTES);
    append_little_endian(start, FORMAT_VERSION);
    append_little_endian(start, std::uint32_t(header.size()));
    start += header;

    AtomicFile file(path);
    Checksum checksum;
    std::int64_t position = 0;
    const auto append = [&](const void* bytes, size_t count) {
        checksum.add(bytes, count);
        file.write_at(bytes, count, position);
        position += std::int64_t(count);
    };
    append(start.data(), start.size());
    const auto append_sums = [&](const Film& part) {
        append(part.sums.data(), part.sums.size() * sizeof(std::int64_t));
    };
    append_sums(film.render.film);
    for (const Film& layer : film.render.path_layers)
        append_sums(layer);
    if (is_adaptive(film.render.film)) {
        for (const TileSamples* samples : {&film.render.round.start, &film.render.round.target})
            for (const std::vector<std::uint32_t>& half : *samples)
                append(half.data(), half.size() * sizeof(std::uint32_t));
        for (const TileNoise& noise : film.render.round.noise)
            for (const std::vector<double>& half : noise)
                append(half.data(), half.size() * sizeof(double));
    }
    const std::string end = checksum.text();
    append(end.data(), end.size());
    file.commit();
}

FilmFile read_film_file(const std::string& path) {
    FilmReader reader(path);
    Runs shown;
    FilmFile film = parse_header(reader, [&](const Json& json) {
        if (json.contains("shown"))
            shown = whole<Runs>(json.at("shown"));
        return read_header(json);
    });
    Film& sums = film.render.film;
    bool in_order = !sums.ranges.empty() && sums.replicates > 0 && sums.width > 0 && sums.height > 0;
    std::uint64_t end = 0;
    for (const SampleRange& range : sums.ranges) {
        in_order = in_order && end <= range.first && range.first < range.end;
        end = range.end;
    }
    if (!in_order)
        reader.reject("damaged: the header's window, replicates or ranges are impossible");
    reader.sums(film.render);
    if (!shown.empty()) {
        std::optional<std::vector<std::uint8_t>> pixels = shown_of(shown, film_plane(sums) / 3);
        if (!pixels)
            reader.reject("damaged: the pixels that show the scene are not those of its window");
        sums.shown = std::move(*pixels);
    }
    if (const AdaptiveRound& round = film.render.round; round.end > 0) {
        if (!is_possible(round, sums))
            reader.reject("damaged: the samples of its tiles are impossible");
        sums.tile_samples = samples_within(round, film_samples(sums), sums.replicates);
    }
    return film;
}

FilmOrigin read_film_origin(const std::string& path) {
    FilmReader reader(path);
    return parse_header(reader, read_origin);
}

FilmContent read_film_content(const std::string& path) {
    FilmReader reader(path);
    return parse_header(reader, read_content);
}

} // namespace clrt
