// SPDX-License-Identifier: Apache-2.0
#include "render/layer_table.h"

#include "output/cryptomatte.h"
#include "render/render.h"
#include "render/render_params.h"
#include "scene/normalise.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

void append_value(std::vector<float>& values, double x) {
    values.push_back(float(x));
}

void append_value(std::vector<float>& values, const glm::dvec3& v) {
    for (int c = 0; c < 3; ++c)
        values.push_back(float(v[c]));
}

/// A value or a vector of each pixel's primary hits.
template <class Function>
std::vector<float> from_hits(const LayerSources& from, Function&& value_of) {
    using Value = decltype(value_of(PixelHits()));
    std::vector<float> values;
    if (from.render.hits.empty())
        return values;
    const Film& film = from.render.film;
    const size_t pixels = film_plane(film) / 3;
    values.reserve(pixels * (sizeof(Value) / sizeof(double)));
    for (size_t pixel = 0; pixel < pixels; ++pixel)
        append_value(values, value_of(pixel_hits(from.render.hits, film, pixel)));
    return values;
}

/// The mean position in world units.
glm::dvec3 world_position(const PixelHits& hits, const Normalisation& frame) {
    return hits.mean(AOV_POSITION) / frame.scale + frame.centre;
}

/// Reflectance; 0 where nothing was hit.
std::vector<float> make_albedo(const LayerSources& from) {
    return from_hits(from, [](const PixelHits& hits) { return hits.mean(AOV_ALBEDO); });
}

/// Mean shading normal, unit length.
std::vector<float> make_normal(const LayerSources& from) {
    return from_hits(from, [](const PixelHits& hits) {
        const glm::dvec3 normal = hits.mean(AOV_NORMAL);
        const double length = glm::length(normal);
        return length > 0 ? normal / length : normal;
    });
}

/// What denoisers are guided by: the mean over all samples, those that miss as 0, so that edges are as soft
/// as the picture's.
template <size_t vector>
std::vector<float> make_guide(const LayerSources& from) {
    return from_hits(from, [](const PixelHits& hits) { return hits.share * hits.mean(vector); });
}

/// Distance of the mean position, world units: along the look vector, in panoramas from the eye; infinite
/// where nothing was hit. The camera is that of the shutter's opening.
std::vector<float> make_depth(const LayerSources& from) {
    const Camera& camera = from.scene.camera;
    const glm::dvec3 look = glm::normalize(camera.at - camera.eye);
    return from_hits(from, [&](const PixelHits& hits) -> double {
        if (!(hits.share > 0))
            return INFINITY;
        const glm::dvec3 way = world_position(hits, from.scene.normalisation) - camera.eye;
        return is_panorama(camera.projection) ? glm::length(way) : glm::dot(way, look);
    });
}

/// Mean position in world units, from position_origin().
std::vector<float> make_position(const LayerSources& from) {
    const Normalisation& frame = from.scene.normalisation;
    return from_hits(from, [&](const PixelHits& hits) {
        return hits.share > 0 ? world_position(hits, frame) - position_origin(frame) : glm::dvec3(0);
    });
}

/// The index that a word of the first hit says plus 1; 0 where nothing was hit.
template <u32 word>
std::vector<float> make_id(const LayerSources& from) {
    return from_hits(from, [](const PixelHits& hits) { return hits.share > 0 ? hits.first[word] + 1.0 : 0; });
}

std::vector<float> make_alpha(const LayerSources& from) {
    return from_hits(from, [](const PixelHits& hits) { return hits.share; });
}

std::vector<float> make_variance(const LayerSources& from) {
    return film_variance(from.render.film);
}

std::vector<float> make_samples(const LayerSources& from) {
    return film_pixel_samples(from.render.film);
}

/// How many bad samples each pixel has.
std::vector<float> make_bad_samples(const LayerSources& from) {
    const Film& film = from.render.film;
    const Crop window = render_window(from.options.film);
    const int full_width = from.options.film.size.x;
    std::vector<float> values(size_t(film.width) * size_t(film.height));
    for (const auto& [pixel, count] : from.render.counts.bad_pixels) {
        const int x = int(pixel) % full_width - window.x0, y = int(pixel) / full_width - window.y0;
        if (x >= 0 && y >= 0 && x < film.width && y < film.height)
            values[size_t(y) * size_t(film.width) + size_t(x)] = float(count);
    }
    return values;
}

const std::string OBJECT_MATTES = "CryptoObject", MATERIAL_MATTES = "CryptoMaterial";

/// By kind of matte.
const std::vector<std::string>& matte_names(const Scene& scene, u32 kind) {
    return kind == MATTE_OBJECTS ? scene.object_names : scene.material_names;
}

/// Ids and coverage, MATTE_RANKS pairs a pixel.
template <u32 kind>
std::vector<float> make_mattes(const LayerSources& from) {
    const HitSums& hits = from.render.hits;
    const Film& film = from.render.film;
    std::vector<float> values, ids;
    if (hits.mattes[0].empty())
        return values;
    for (const std::string& name : matte_names(from.scene, kind))
        ids.push_back(matte_id(name));
    const size_t pixels = film_plane(film) / 3;
    values.reserve(2 * MATTE_RANKS * pixels);
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        std::vector<MatteShare> shares;
        for (const IndexShare& share : matte_shares(hits, film, pixel, kind))
            shares.push_back({ids[share.index], share.coverage});
        append_mattes(values, std::move(shares));
    }
    return values;
}

Metadata object_attributes(const Scene& scene) {
    return matte_attributes(OBJECT_MATTES, scene.object_names);
}

Metadata material_attributes(const Scene& scene) {
    return matte_attributes(MATERIAL_MATTES, scene.material_names);
}

/// Blender's pass of the picture itself.
const std::string BLENDER_PICTURE = "Combined";

/// A layer with a channel a letter.
LayerChannels within(const std::string& layer, const std::string& letters) {
    LayerChannels result{layer, {}};
    for (const char letter : letters)
        result.channels.emplace_back(1, letter);
    return result;
}

/// A channel by itself.
LayerChannels alone(const std::string& channel) {
    return {"", {channel}};
}

Layer make_named(const LayerChannels& names, std::vector<float> values) {
    Layer layer;
    layer.name = names.layer;
    layer.channel_names = names.channels;
    layer.values = std::move(values);
    return layer;
}

} // namespace

const std::vector<LayerRow>& layer_table() {
    using Default = LayerDefault;
    using Source = LayerSource;
    static const std::vector<LayerRow> rows = {
        {"albedo", within("albedo", "RGB"), within("Albedo", "RGB"), Default::SHOWN, Source::HITS, false,
         make_albedo},
        {"N", within("N", "XYZ"), within("Normal", "XYZ"), Default::SHOWN, Source::HITS, false, make_normal},
        {"Z", alone("Z"), within("Depth", "Z"), Default::SHOWN, Source::HITS, false, make_depth},
        {"P", within("P", "XYZ"), within("Position", "XYZ"), Default::SHOWN, Source::HITS, false,
         make_position},
        {"objectId", alone("objectId"), within("Object Index", "X"), Default::SHOWN, Source::HITS, true,
         make_id<AOV_OBJECT>},
        {"materialId", alone("materialId"), within("Material Index", "X"), Default::SHOWN, Source::HITS, true,
         make_id<AOV_MATERIAL>},
        {"variance", within("variance", "RGB"), within("Variance", "RGB"), Default::SHOWN, Source::FILM,
         false, make_variance},
        {"samples", alone("samples"), within("Debug Sample Count", "X"), Default::SHOWN, Source::FILM, false,
         make_samples},
        {"badSamples", alone("badSamples"), within("Bad Samples", "X"), Default::SHOWN_WHERE_BAD,
         Source::FILM, true, make_bad_samples},
        {ALPHA_LAYER, alone("A"), within(BLENDER_PICTURE, "A"), Default::HIDDEN, Source::HITS, false,
         make_alpha},
        {"denoisingAlbedo", within("denoisingAlbedo", "RGB"), within("Denoising Albedo", "RGB"),
         Default::HIDDEN, Source::HITS, false, make_guide<AOV_ALBEDO>},
        {"denoisingNormal", within("denoisingNormal", "XYZ"), within("Denoising Normal", "XYZ"),
         Default::HIDDEN, Source::HITS, false, make_guide<AOV_NORMAL>},
        {"cryptoObject",
         {"", matte_channels(OBJECT_MATTES)},
         {"", matte_channels(OBJECT_MATTES)},
         Default::HIDDEN,
         Source::MATTES,
         false,
         make_mattes<MATTE_OBJECTS>,
         object_attributes},
        {"cryptoMaterial",
         {"", matte_channels(MATERIAL_MATTES)},
         {"", matte_channels(MATERIAL_MATTES)},
         Default::HIDDEN,
         Source::MATTES,
         false,
         make_mattes<MATTE_MATERIALS>,
         material_attributes},
    };
    return rows;
}

const LayerRow* find_layer(const std::string& name) {
    const std::vector<LayerRow>& rows = layer_table();
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const LayerRow& row) { return row.name == name; });
    return found == rows.end() ? nullptr : &*found;
}

bool is_layer_taken(const std::string& layer) {
    const auto holds = [&](const LayerChannels& names) {
        return std::any_of(names.channels.begin(), names.channels.end(), [&](const std::string& channel) {
            const std::string whole = names.layer.empty() ? channel : names.layer + "." + channel;
            return whole.rfind(layer + ".", 0) == 0;
        });
    };
    if (layer == DENOISED_LAYER || layer == ERROR_LAYER)
        return true;
    const std::vector<LayerRow>& rows = layer_table();
    return std::any_of(rows.begin(), rows.end(), [&](const LayerRow& row) {
        return row.name == layer || holds(row.clrt) || holds(row.blender);
    });
}

Layer make_layer(const LayerRow& row, std::vector<float> values, ExrNames names) {
    Layer layer = make_named(names == ExrNames::BLENDER ? row.blender : row.clrt, std::move(values));
    layer.is_id = row.is_id;
    layer.is_coverage = row.name == ALPHA_LAYER;
    return layer;
}

Layer make_radiance_layer(std::vector<float> values, ExrNames names) {
    return make_named(within(names == ExrNames::BLENDER ? BLENDER_PICTURE : "", "RGB"), std::move(values));
}

Layer make_opaque_layer(size_t pixels) {
    return make_named(within(BLENDER_PICTURE, "A"), std::vector<float>(pixels, 1));
}

std::string layer_names(const char* separator) {
    std::vector<std::string> names;
    for (const LayerRow& row : layer_table())
        names.push_back(row.name);
    return fmt::format("{}", fmt::join(names, separator));
}

} // namespace clrt
