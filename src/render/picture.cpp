// SPDX-License-Identifier: Apache-2.0
#include "render/picture.h"

#include "render/render_params.h"
#include "scene/normalise.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// Where the sums of kernels/integrators/aov.cl lie within a pixel.
enum HitOffset { ALBEDO = 0, NORMAL = 3, POSITION = 6, DEPTH = 9, HITS = 10, OBJECT = 11, MATERIAL = 12 };

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
    if (!options.aovs)
        return name != "alpha";
    return std::find(options.aovs->begin(), options.aovs->end(), name) != options.aovs->end();
}

/// Makes layers from the sums over the primary hits.
class HitLayerMaker {
public:
    HitLayerMaker(const Render& render, const Scene& scene) : render_(render), scene_(scene) {}

    /// `count` sums from `offset`, over the number of hits (or of samples); 0 where nothing was hit.
    Layer average(const char* name, std::vector<std::string> channels, int offset,
                  bool over_samples = false) const {
        Layer layer{name, std::move(channels), {}, false};
        const int count = int(layer.channel_names.size());
        for_each_pixel([&](const float* sums) {
            const float over = over_samples ? float(render_.layer_samples) : std::max(sums[HITS], 1.0f);
            for (int c = 0; c < count; ++c)
                layer.values.push_back(sums[offset + c] / over);
        });
        return layer;
    }
    /// Mean shading normal, unit length.
    Layer normal() const {
        Layer layer = average("N", {"X", "Y", "Z"}, NORMAL);
        for (size_t i = 0; i < layer.values.size(); i += 3) {
            float* n = &layer.values[i];
            const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (int c = 0; c < 3 && length > 0; ++c)
                n[c] /= length;
        }
        return layer;
    }
    /// Mean position in world units, from position_origin().
    Layer position() const {
        Layer layer = average("P", {"X", "Y", "Z"}, POSITION);
        const Normalisation& frame = scene_.normalisation;
        const glm::dvec3 centre = frame.centre - position_origin(frame);
        size_t i = 0;
        for_each_pixel([&](const float* sums) {
            for (int c = 0; c < 3; ++c, ++i)
                layer.values[i] =
                    sums[HITS] > 0 ? float(double(layer.values[i]) / frame.scale + centre[c]) : 0.0f;
        });
        return layer;
    }
    /// Mean distance along the look vector, world units; infinite where nothing was hit.
    Layer depth() const {
        Layer layer = average("", {"Z"}, DEPTH);
        size_t i = 0;
        for_each_pixel([&](const float* sums) {
            layer.values[i] =
                sums[HITS] > 0 ? float(double(layer.values[i]) / scene_.normalisation.scale) : INFINITY;
            ++i;
        });
        return layer;
    }
    /// Index of the first hit's object or material plus 1; 0 where nothing was hit.
    Layer id(const char* name, int offset) const {
        Layer layer{"", {name}, {}, true};
        for_each_pixel(
            [&](const float* sums) { layer.values.push_back(sums[HITS] > 0 ? sums[offset] + 1.0f : 0.0f); });
        return layer;
    }

private:
    template <class Function>
    void for_each_pixel(Function&& function) const {
        for (size_t i = 0; i < render_.layers.size(); i += HIT_LAYER_FLOATS)
            function(&render_.layers[i]);
    }
    const Render& render_;
    const Scene& scene_;
};

void add_hit_layers(const Render& render, const Scene& scene, const Options& options, Picture& picture) {
    if (render.layers.empty())
        return;
    const HitLayerMaker maker(render, scene);
    if (wants(options, "alpha"))
        picture.layers.push_back(maker.average("", {"A"}, HITS, true));
    if (wants(options, "albedo"))
        picture.layers.push_back(maker.average("albedo", {"R", "G", "B"}, ALBEDO));
    if (wants(options, "N"))
        picture.layers.push_back(maker.normal());
    if (wants(options, "Z"))
        picture.layers.push_back(maker.depth());
    if (wants(options, "P"))
        picture.layers.push_back(maker.position());
    if (wants(options, "objectId"))
        picture.layers.push_back(maker.id("objectId", OBJECT));
    if (wants(options, "materialId"))
        picture.layers.push_back(maker.id("materialId", MATERIAL));
}

} // namespace

Picture make_picture(const Render& render, const Scene& scene, const Options& options) {
    const Crop window = render_window(options);
    Picture picture;
    picture.width = render.film.width;
    picture.height = render.film.height;
    picture.x0 = window.x0;
    picture.y0 = window.y0;
    picture.full_width = options.size.x;
    picture.full_height = options.size.y;
    picture.layers.push_back({"", {"R", "G", "B"}, film_mean(render.film), false});
    for (size_t i = 0; i < render.path_layers.size(); ++i)
        picture.layers.push_back(
            {options.path_layers[i].name, {"R", "G", "B"}, film_mean(render.path_layers[i]), false});
    add_hit_layers(render, scene, options, picture);
    if (wants(options, "variance")) {
        std::vector<float> variance = film_variance(render.film);
        if (!variance.empty())
            picture.layers.push_back({"variance", {"R", "G", "B"}, std::move(variance), false});
    }
    if (wants(options, "samples"))
        picture.layers.push_back({"", {"samples"}, film_pixel_samples(render.film), false});
    if (options.aovs ? wants(options, "badSamples") : !render.counts.bad_pixels.empty())
        picture.layers.push_back(bad_samples_layer(render, window, options.size.x));
    return picture;
}

} // namespace clrt
