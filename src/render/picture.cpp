// SPDX-License-Identifier: Apache-2.0
#include "render/picture.h"

#include "render/render_params.h"
#include "scene/normalise.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

/// How many bad samples each pixel has.
Layer bad_samples_layer(const Render& render, const Crop& window, int full_width) {
    Layer layer{
        "", {"badSamples"}, std::vector<float>(size_t(render.film.width) * size_t(render.film.height)), true};
    for (const auto& [pixel, count] : render.counts.bad_pixels) {
        const int x = int(pixel) % full_width - window.x0, y = int(pixel) / full_width - window.y0;
        if (x >= 0 && y >= 0 && x < render.film.width && y < render.film.height)
            layer.values[size_t(y) * size_t(render.film.width) + size_t(x)] = float(count);
    }
    return layer;
}

bool wants(const Options& options, const std::string& name) {
    if (!options.output.aovs)
        return name != "alpha";
    return std::find(options.output.aovs->begin(), options.output.aovs->end(), name) !=
           options.output.aovs->end();
}

/// Makes layers from the sums over the primary hits.
class HitLayerMaker {
public:
    HitLayerMaker(const Render& render, const Scene& scene)
        : render_(render), frame_(scene.normalisation), eye_(scene.camera.eye),
          look_(glm::normalize(scene.camera.at - scene.camera.eye)) {}

    /// Share of the samples that hit something.
    Layer alpha() const {
        return make("", {"A"}, [](const PixelHits& hits) { return hits.share; });
    }
    /// 0 where nothing was hit.
    Layer albedo() const {
        return make("albedo", {"R", "G", "B"}, [](const PixelHits& hits) { return hits.albedo; });
    }
    /// Mean shading normal, unit length.
    Layer normal() const {
        return make("N", {"X", "Y", "Z"}, [](const PixelHits& hits) {
            const double length = glm::length(hits.normal);
            return length > 0 ? hits.normal / length : hits.normal;
        });
    }
    /// Mean position in world units, from position_origin().
    Layer position() const {
        return make("P", {"X", "Y", "Z"}, [&](const PixelHits& hits) {
            return hits.share > 0 ? place(hits) - position_origin(frame_) : glm::dvec3(0);
        });
    }
    /// Mean distance along the look vector, world units; infinite where nothing was hit.
    Layer depth() const {
        return make("", {"Z"}, [&](const PixelHits& hits) {
            return hits.share > 0 ? glm::dot(place(hits) - eye_, look_) : INFINITY;
        });
    }
    /// Index of the first hit's object or material plus 1; 0 where nothing was hit.
    Layer id(const char* name, u32 PixelHits::*member) const {
        Layer layer =
            make("", {name}, [&](const PixelHits& hits) { return hits.share > 0 ? hits.*member + 1.0 : 0; });
        layer.is_id = true;
        return layer;
    }

private:
    /// The mean position in world units.
    glm::dvec3 place(const PixelHits& hits) const { return hits.position / frame_.scale + frame_.centre; }
    template <class Function>
    Layer make(const char* name, std::vector<std::string> channels, Function&& value_of) const {
        Layer layer{name, std::move(channels), {}, false};
        const size_t pixels = film_plane(render_.film) / 3;
        layer.values.reserve(pixels * layer.channel_names.size());
        for (size_t pixel = 0; pixel < pixels; ++pixel)
            append(layer.values, value_of(pixel_hits(render_.hits, render_.film, pixel)));
        return layer;
    }
    static void append(std::vector<float>& values, double x) { values.push_back(float(x)); }
    static void append(std::vector<float>& values, const glm::dvec3& v) {
        for (int c = 0; c < 3; ++c)
            values.push_back(float(v[c]));
    }

    const Render& render_;
    const Normalisation& frame_;
    const glm::dvec3 eye_, look_;
};

void add_hit_layers(const Render& render, const Scene& scene, const Options& options, Picture& picture) {
    if (render.hits.empty())
        return;
    const HitLayerMaker maker(render, scene);
    if (picture.is_transparent || wants(options, "alpha"))
        picture.layers.push_back(maker.alpha());
    if (wants(options, "albedo"))
        picture.layers.push_back(maker.albedo());
    if (wants(options, "N"))
        picture.layers.push_back(maker.normal());
    if (wants(options, "Z"))
        picture.layers.push_back(maker.depth());
    if (wants(options, "P"))
        picture.layers.push_back(maker.position());
    if (wants(options, "objectId"))
        picture.layers.push_back(maker.id("objectId", &PixelHits::object));
    if (wants(options, "materialId"))
        picture.layers.push_back(maker.id("materialId", &PixelHits::material));
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
    picture.layers.push_back({"", {"R", "G", "B"}, film_mean(render.film), false});
    picture.is_transparent = has_transparent_background(options.light);
    return picture;
}

Picture make_picture(const Render& render, const Scene& scene, const Options& options) {
    Picture picture = make_plain_picture(render, options);
    for (size_t i = 0; i < render.path_layers.size(); ++i)
        picture.layers.push_back(
            {options.output.path_layers[i].name, {"R", "G", "B"}, film_mean(render.path_layers[i]), false});
    add_hit_layers(render, scene, options, picture);
    if (wants(options, "variance")) {
        std::vector<float> variance = film_variance(render.film);
        if (!variance.empty())
            picture.layers.push_back({"variance", {"R", "G", "B"}, std::move(variance), false});
    }
    if (wants(options, "samples"))
        picture.layers.push_back({"", {"samples"}, film_pixel_samples(render.film), false});
    if (options.output.aovs ? wants(options, "badSamples") : !render.counts.bad_pixels.empty())
        picture.layers.push_back(bad_samples_layer(render, render_window(options.film), options.film.size.x));
    return picture;
}

} // namespace clrt
