// SPDX-License-Identifier: Apache-2.0
#include "film/film_file.h"

#include "error.h"
#include "film/film_header.h"
#include "film/guide_header.h"
#include "output/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <system_error>
#include <xxhash.h>

namespace clrt {

namespace {

using Json = FilmHeader;

constexpr char MAGIC[] = "CLRTFILM";
constexpr size_t MAGIC_BYTES = 8, START_BYTES = 16, CHECKSUM_BYTES = 16;
constexpr std::uint32_t FORMAT_VERSION = 3;
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

/// Of what a guide's cells have learnt.
std::uint64_t guide_bytes(const GuideProgress& progress) {
    if (!progress.guide)
        return 0;
    return progress.guide->nodes().size() * sizeof(u32) +
           progress.guide->lore().size() * (sizeof(DirectionSplits) + 3 * sizeof(double)) +
           progress.weights.size() * sizeof(float) + progress.sums.size() * sizeof progress.sums[0];
}

/// A film file that is being read.
class FilmReader {
public:
    explicit FilmReader(const std::string& path) : path_(path), input_(path, std::ios::binary) {
        std::error_code error(input_ ? 0 : errno, std::generic_category());
        if (!error)
            size_ = std::filesystem::file_size(path, error);
        if (error)
            throw SceneError(path, 0, "the film file cannot be opened: " + error.message());
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
        const std::uint64_t expected = position_ + 8 * (count + render.path_layers.size() * plane) +
                                       16 * tiles + guide_bytes(render.guide) + CHECKSUM_BYTES;
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
        if (render.guide.guide)
            guide(render.guide);
        const std::string computed = checksum_.text();
        if (take(CHECKSUM_BYTES) != computed)
            reject("damaged: the checksum at its end differs from that of its content");
    }

    [[noreturn]] void reject(const std::string& message) const { throw SceneError(path_, 0, message); }

private:
    /// Reads what the cells have learnt.
    void guide(GuideProgress& progress) {
        std::vector<u32> nodes = progress.guide->nodes();
        std::vector<GuideLore> lore = progress.guide->lore();
        take(nodes.data(), nodes.size() * sizeof(u32));
        for (GuideLore& cell : lore) {
            take(cell.splits.data(), sizeof cell.splits);
            for (double* number : {&cell.weight.sum, &cell.weight.count, &cell.vertices})
                take(number, sizeof *number);
        }
        take(progress.sums.data(), progress.sums.size() * sizeof progress.sums[0]);
        take(progress.weights.data(), progress.weights.size() * sizeof progress.weights[0]);
        progress.guide.emplace(std::move(nodes), std::move(lore));
    }
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
    const std::string header = film_header(film).dump();
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
    if (const GuideProgress& progress = film.render.guide; progress.guide) {
        const std::vector<u32>& nodes = progress.guide->nodes();
        append(nodes.data(), nodes.size() * sizeof(u32));
        for (const GuideLore& cell : progress.guide->lore()) {
            append(cell.splits.data(), sizeof cell.splits);
            for (const double* number : {&cell.weight.sum, &cell.weight.count, &cell.vertices})
                append(number, sizeof *number);
        }
        append(progress.sums.data(), progress.sums.size() * sizeof progress.sums[0]);
        append(progress.weights.data(), progress.weights.size() * sizeof progress.weights[0]);
    }
    const std::string end = checksum.text();
    append(end.data(), end.size());
    file.commit();
}

FilmFile read_film_file(const std::string& path) {
    FilmReader reader(path);
    PixelRuns shown;
    FilmFile film = parse_header(reader, [&](const Json& json) {
        shown = shown_runs_of(json);
        return film_of_header(json);
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
        std::optional<std::vector<std::uint8_t>> pixels = shown_of_runs(shown, film_plane(sums) / 3);
        if (!pixels)
            reader.reject("damaged: the pixels that show the scene are not those of its window");
        sums.shown = std::move(*pixels);
    }
    if (!is_possible(film.render.guide))
        reader.reject("damaged: the cells of its guide are impossible");
    if (const AdaptiveRound& round = film.render.round; round.end > 0) {
        if (!is_possible(round, sums))
            reader.reject("damaged: the samples of its tiles are impossible");
        sums.tile_samples = samples_within(round, film_samples(sums), sums.replicates);
    }
    return film;
}

FilmOrigin read_film_origin(const std::string& path) {
    FilmReader reader(path);
    return parse_header(reader, film_origin_of);
}

FilmContent read_film_content(const std::string& path) {
    FilmReader reader(path);
    return parse_header(reader, film_content_of);
}

} // namespace clrt
