// SPDX-License-Identifier: Apache-2.0
#include "film/film_buffers.h"

#include "device/buffer_size.h"
#include "device/buffer_values.h"
#include "device/opencl_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// Slots of the film: whole tiles.
size_t film_slots(const RenderParams& params) {
    return size_t(params.tile_count) * TILE_PIXELS;
}

/// Buffers are read and written in pieces of about this size: what a render needs at its end is there from
/// its start.
constexpr size_t PIECE_BYTES = size_t(4) << 20;

/// What the bits of a sum on the device say: one that splats have filled has its sign set
/// (kernels/film/sum.h).
std::int64_t number_of_sum(std::int64_t bits) {
    return bits < 0 ? INT64_MAX : bits;
}

const char* const READING_FILM = "reading the picture back";

} // namespace

std::vector<std::string> film_defines(const DeviceInfo& device, FilmAccess access) {
    if (access == FilmAccess::GATHER)
        return {};
    return {"FILM_SPLATS=1", fmt::format("FILM_INT64_ATOMICS={}", int(device.int64_atomics))};
}

int fitting_replicates(const Device& device, const RenderParams& params, size_t layers) {
    const size_t plane = film_slots(params) * 3 * sizeof(std::int64_t);
    const size_t most = std::min(device.info.largest_buffer_bytes, device.info.memory_bytes / 2);
    int replicates = int(params.replicates);
    while ((size_t(replicates) + layers) * plane > most && replicates % 2 == 0)
        replicates /= 2;
    if (replicates != int(params.replicates))
        spdlog::warn(
            "the film of {} replicates does not fit the device: {} are kept apart, the error is coarser",
            params.replicates, replicates);
    check_picture_buffer(device.info, "film", (size_t(replicates) + layers) * plane);
    return replicates;
}

FilmBuffers::FilmBuffers(const Device& device, const RenderParams& params, size_t layers)
    : device_(device), params_(params), slots_(film_slots(params)), layers_(layers),
      film_(create_buffer(device, "film",
                          slots_ * 3 * (params.film_replicates + layers) * sizeof(std::int64_t))),
      pixel_rays_(
          create_buffer(device, "pixel_rays",
                        (slots_ * PIXEL_RAYS_WORDS + params.tile_count * TILE_RANGE_WORDS) * sizeof(u32))),
      counters_(create_buffer(device, "counters", (COUNT_WORDS + 2 * REPLAY_CAPACITY) * sizeof(u32))) {}

void FilmBuffers::bind(Kernel& kernel) const {
    bind_sums(kernel);
    kernel.set("pixel_rays", pixel_rays_);
    kernel.set("counters", counters_);
}

void FilmBuffers::bind_sums(Kernel& kernel) const {
    kernel.set("film", film_);
}

void FilmBuffers::write_emission(const std::vector<std::uint8_t>& states) const {
    if (states.empty())
        return;
    for (const Band& band : bands()) {
        std::vector<u32> words(slot_count(band) * PIXEL_RAYS_WORDS, 0);
        for_each_pixel(band, [&](size_t on_device, size_t in_film) {
            words[on_device / 3 * PIXEL_RAYS_WORDS + PIXEL_EMISSION] = states[in_film / 3];
        });
        check_opencl("preparing the picture", [&] {
            device_.queue.enqueueWriteBuffer(pixel_rays_, CL_TRUE,
                                             first_slot(0, band) * PIXEL_RAYS_WORDS * sizeof(u32),
                                             words.size() * sizeof(u32), words.data());
        });
    }
}

void FilmBuffers::bind_ranges(Kernel& kernel) const {
    kernel.set("pixel_rays", pixel_rays_);
}

std::vector<FilmBuffers::Band> FilmBuffers::bands() const {
    const size_t rows = params_.tile_count / params_.tiles_x;
    const size_t row_bytes = size_t(params_.tiles_x) * TILE_PIXELS * 3 * sizeof(std::int64_t);
    const size_t at_once = std::max<size_t>(PIECE_BYTES / row_bytes, 1);
    std::vector<Band> bands;
    for (size_t row = 0; row < rows; row += at_once)
        bands.push_back({row, std::min(at_once, rows - row)});
    return bands;
}

size_t FilmBuffers::first_slot(size_t plane, const Band& band) const {
    return plane * slots_ + slot_count({0, band.first});
}

size_t FilmBuffers::slot_count(const Band& band) const {
    return band.count * params_.tiles_x * TILE_PIXELS;
}

template <class Action>
void FilmBuffers::for_each_pixel(const Band& band, Action&& action) const {
    const size_t width = params_.crop_width, first = band.first * TILE_SIZE;
    const size_t end = std::min<size_t>(params_.crop_height, (band.first + band.count) * TILE_SIZE);
    tbb::parallel_for(first, end, [&](size_t y) {
        for (size_t x = 0; x < width; ++x) {
            const size_t tile = (y - first) / TILE_SIZE * params_.tiles_x + x / TILE_SIZE;
            const size_t slot = tile * TILE_PIXELS + (y % TILE_SIZE) * TILE_SIZE + x % TILE_SIZE;
            action(3 * slot, 3 * (y * width + x));
        }
    });
}

void FilmBuffers::write_plane(size_t plane, const std::int64_t* sums) const {
    for (const Band& band : bands()) {
        std::vector<std::int64_t> piece(3 * slot_count(band), 0);
        if (sums)
            for_each_pixel(band, [&](size_t on_device, size_t in_film) {
                std::copy_n(sums + in_film, 3, &piece[on_device]);
            });
        check_opencl("continuing the picture", [&] {
            device_.queue.enqueueWriteBuffer(film_, CL_TRUE,
                                             3 * first_slot(plane, band) * sizeof(std::int64_t),
                                             piece.size() * sizeof(std::int64_t), piece.data());
        });
    }
}

void FilmBuffers::read_plane(size_t plane, std::int64_t* sums) const {
    for (const Band& band : bands()) {
        const auto piece = read_values<std::int64_t>(device_, READING_FILM, film_,
                                                     3 * first_slot(plane, band), 3 * slot_count(band));
        for_each_pixel(band, [&](size_t on_device, size_t in_film) {
            std::transform(&piece[on_device], &piece[on_device] + 3, sums + in_film, number_of_sum);
        });
    }
}

u32 FilmBuffers::pixel_of_slot(size_t slot) const {
    const u32 tile = u32(slot / TILE_PIXELS), within = u32(slot % TILE_PIXELS);
    const u32 x = params_.crop_x + tile % params_.tiles_x * TILE_SIZE + within % TILE_SIZE;
    const u32 y = params_.crop_y + tile / params_.tiles_x * TILE_SIZE + within / TILE_SIZE;
    return y * params_.width + x;
}

void FilmBuffers::write_tile_ranges(const std::vector<std::uint32_t>& from,
                                    const std::vector<std::uint32_t>& to) {
    static_assert(ADAPTIVE_TILE_SIZE % TILE_SIZE == 0, "a tile of the device lies in one adaptive tile");
    const u32 ratio = ADAPTIVE_TILE_SIZE / TILE_SIZE, across = (params_.tiles_x + ratio - 1) / ratio;
    std::vector<u32> ranges(size_t(params_.tile_count) * TILE_RANGE_WORDS);
    for (u32 i = 0; i < params_.tile_count; ++i) {
        const size_t tile = size_t(i / params_.tiles_x / ratio) * across + i % params_.tiles_x / ratio;
        ranges[TILE_RANGE_WORDS * i + TILE_RANGE_FIRST] = from[tile];
        ranges[TILE_RANGE_WORDS * i + TILE_RANGE_COUNT] = to[tile] - from[tile];
    }
    check_opencl("dealing out samples", [&] {
        device_.queue.enqueueWriteBuffer(pixel_rays_, CL_TRUE, slots_ * PIXEL_RAYS_WORDS * sizeof(u32),
                                         ranges.size() * sizeof(u32), ranges.data());
    });
}

void FilmBuffers::write_sums(const RenderProgress& render) {
    const size_t replicates = params_.film_replicates;
    for (size_t i = 0; i < replicates; ++i)
        write_plane(i, &render.film.sums[i * film_plane(render.film)]);
    for (size_t i = 0; i < layers_; ++i)
        write_plane(replicates + i, render.path_layers[i].sums.data());
}

void FilmBuffers::clear_sums() {
    for (size_t plane = 0; plane < params_.film_replicates + layers_; ++plane)
        write_plane(plane, nullptr);
}

void FilmBuffers::read_sums(RenderProgress& render) const {
    const size_t replicates = params_.film_replicates, plane = film_plane(render.film);
    render.film.sums.resize(replicates * plane);
    for (size_t i = 0; i < replicates; ++i)
        read_plane(i, &render.film.sums[i * plane]);
    render.path_layers.resize(layers_);
    for (size_t i = 0; i < layers_; ++i) {
        Film& layer = render.path_layers[i];
        std::vector<std::int64_t> sums = std::move(layer.sums);
        layer = film_layer(render.film);
        layer.sums = std::move(sums);
        layer.sums.resize(plane);
        read_plane(replicates + i, layer.sums.data());
    }
}

void FilmBuffers::read_shown(Film& film) const {
    if (film.shown.empty())
        return;
    for (const Band& band : bands()) {
        const auto rays =
            read_values<u32>(device_, READING_FILM, pixel_rays_, first_slot(0, band) * PIXEL_RAYS_WORDS,
                             slot_count(band) * PIXEL_RAYS_WORDS);
        for_each_pixel(band, [&](size_t on_device, size_t in_film) {
            film.shown[in_film / 3] |= std::uint8_t(rays[on_device / 3 * PIXEL_RAYS_WORDS + PIXEL_SHOWN]);
        });
    }
}

RenderCounts FilmBuffers::read_counts() const {
    const auto words =
        read_values<u32>(device_, READING_FILM, counters_, 0, COUNT_WORDS + 2 * REPLAY_CAPACITY);
    RenderCounts counts;
    counts.nan = words[COUNT_NAN];
    counts.infinite = words[COUNT_INFINITE];
    counts.negative = words[COUNT_NEGATIVE];
    counts.overflow = words[COUNT_OVERFLOW];
    const u32 noted = std::min<u32>(words[COUNT_BAD_SAMPLES], REPLAY_CAPACITY);
    for (u32 i = 0; i < noted; ++i)
        counts.bad_samples.emplace_back(words[COUNT_WORDS + 2 * i], words[COUNT_WORDS + 2 * i + 1]);
    for (const Band& band : bands()) {
        const size_t first = first_slot(0, band);
        const auto rays = read_values<u32>(device_, READING_FILM, pixel_rays_, first * PIXEL_RAYS_WORDS,
                                           slot_count(band) * PIXEL_RAYS_WORDS);
        for (size_t i = 0; i < rays.size(); i += PIXEL_RAYS_WORDS) {
            counts.secondary += rays[i + PIXEL_RAYS_SECONDARY];
            counts.shadow += rays[i + PIXEL_RAYS_SHADOW];
            counts.cut_paths += rays[i + PIXEL_CUT_PATHS];
            counts.cut_weight +=
                std::uint64_t(rays[i + PIXEL_CUT_WEIGHT_HIGH]) << 32 | rays[i + PIXEL_CUT_WEIGHT_LOW];
            counts.outline_pixels += (rays[i + PIXEL_EMISSION] & EMISSION_BY_RAYS) != 0;
            if (const u32 bad = rays[i + PIXEL_BAD_SAMPLES])
                counts.bad_pixels[pixel_of_slot(first + i / PIXEL_RAYS_WORDS)] = bad;
        }
    }
    return counts;
}

} // namespace clrt
