// SPDX-License-Identifier: Apache-2.0
#include "film/film_identity.h"

#include "device/kernel_source.h"
#include "film/whole_numbers.h"
#include "kernels/shared/scene_arrays.h"
#include "options/integrators.h"
#include "options/summed_layers.h"

#include <array>
#include <fmt/format.h>
#include <memory>
#include <xxhash.h>

namespace clrt {

namespace {

/// A hash that is fed piece by piece.
class Hash {
public:
    Hash() : state_(XXH3_createState(), XXH3_freeState) {
        if (!state_)
            throw std::bad_alloc();
        XXH3_128bits_reset(state_.get());
    }
    void bytes(const void* data, size_t count) {
        if (count > 0)
            XXH3_128bits_update(state_.get(), data, count);
    }
    /// An array with its length in front, so that bytes cannot move between arrays unseen.
    template <class T>
    void array(const std::vector<T>& values) {
        const std::uint64_t count = values.size();
        bytes(&count, sizeof count);
        bytes(values.data(), values.size() * sizeof(T));
    }
    void number(double value) { bytes(&value, sizeof value); }
    void vector(const glm::dvec3& v) {
        number(v.x);
        number(v.y);
        number(v.z);
    }

    // Each takes its struct apart by all of its members, so that a new one does not compile before it is
    // hashed or left out here.
    void add(const Camera& camera) {
        const auto& [eye, at, up, fov_degrees, projection, ortho_height, shift, aperture, focus, blades,
                     end] = camera;
        add(CameraPose{eye, at, up});
        number(fov_degrees);
        number(projection);
        number(ortho_height);
        number(shift.x);
        number(shift.y);
        number(aperture);
        number(focus);
        number(blades);
        number(end.has_value());
        if (end)
            add(*end);
    }
    void add(const CameraPose& pose) {
        const auto& [eye, at, up] = pose;
        vector(eye);
        vector(at);
        vector(up);
    }
    void add(const Environment& environment) {
        const auto& [radiance, width, height, texel_format, texels, tiles, rotation_degrees, mean_radiance,
                     sampling, tabulated_share, portals, portal_sums, portal_share, let_in] = environment;
        (void)texels; // of SCENE_ARRAYS
        (void)tiles;
        (void)mean_radiance; // of the others
        (void)sampling;      // the tiles tell
        (void)tabulated_share;
        (void)portals;
        (void)portal_sums;
        (void)portal_share;
        (void)let_in;
        vector(radiance);
        number(width);
        number(height);
        number(texel_format);
        number(rotation_degrees);
    }
    void add(const Normalisation& normalisation) {
        const auto& [centre, scale] = normalisation;
        vector(centre);
        number(scale);
    }

    std::string text() const {
        const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
        return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
    }

private:
    std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

/// "sky", "transparent", or a radiance.
FilmIdentity background_identity(const Scene& scene, const Options& options) {
    if (has_transparent_background(options.light))
        return TRANSPARENT_BACKGROUND;
    if (!scene.background)
        return "sky";
    return {scene.background->x, scene.background->y, scene.background->z};
}

/// Hash of the kernels that the options name.
std::string kernels_hash(const Options& options) {
    const KernelFiles files = options.device.kernels_folder.empty()
                                  ? embedded_kernel_files()
                                  : read_kernel_files(options.device.kernels_folder);
    const std::string source = expand_kernel_source(files, integrator_file(options.transport.integrator));
    Hash hash;
    hash.bytes(source.data(), source.size());
    return hash.text();
}

} // namespace

std::string scene_hash(const Scene& scene) {
    Hash hash;
#define HASH_ARRAY(type, name, member) hash.array(scene.member);
    SCENE_ARRAYS(HASH_ARRAY)
#undef HASH_ARRAY
    hash.add(scene.environment);
    hash.add(scene.camera);
    hash.add(scene.normalisation);
    return hash.text();
}

FilmIdentity film_identity(const Scene& scene, const Options& options, const RenderParams& params,
                           const FilmScale& scale) {
    FilmIdentity identity;
    identity["version"] = CLRT_VERSION;
    identity["integrator"] = name_of(options.transport.integrator);
    identity["kernels"] = kernels_hash(options);
    identity["size"] = {params.width, params.height};
    identity["window"] = {params.crop_x, params.crop_y, params.crop_x + params.crop_width,
                          params.crop_y + params.crop_height};
    identity["scene"] = scene_hash(scene); // after the size, which a fitted camera follows
    identity["precision"] = name_of(options.device.precision);
    identity["sampler"] = name_of(options.sampling.sampler);
    identity["light_sampler"] = name_of(options.sampling.light_sampler);
    identity["guide"] = options.transport.guide == Toggle::ON;
    identity["path_reuse"] = options.transport.path_reuse == Toggle::ON;
    identity["light_samples"] = 1 << LIGHT_SAMPLES_LOG(params);
    identity["emission_rays"] = options.transport.emission_rays;
    identity["adaptive"] = false;
    if (is_adaptive(options))
        identity["adaptive"] = name_of(*options.sampling.adaptive);
    identity["seed"] = params.seed;
    identity["replicates"] = params.replicates;
    identity["filter"] = name_of(options.film.filter);
    identity["filter_radius"] = params.filter_radius;
    identity["texture_filter"] = params.texture_filter != 0;
    identity["max_depth"] = params.max_depth;
    identity["roulette_depth"] = params.roulette_depth;
    identity["min_contribution"] = params.min_contribution;
    identity["shadow_rays"] = options.transport.shadow_rays;
    identity["gloss_rays"] = options.transport.gloss_rays;
    identity["translucent_rays"] = options.transport.translucent_rays;
    identity["background"] = background_identity(scene, options);
    identity["paths"] = options.transport.paths;
    identity["layers"] = FilmIdentity::array();
    for (const PathLayerOption& layer : summed_layers(options))
        identity["layers"].push_back({{"name", layer.name}, {"expression", layer.expression}});
    identity["quantum"] = scale.quantum;
    identity["largest"] = scale.largest;
    return identity;
}

FilmWindow film_window(const FilmIdentity& identity) {
    const auto window = whole<std::array<int, 4>>(identity.at("window"));
    const auto size = whole<std::array<int, 2>>(identity.at("size"));
    return {{window[0], window[1], window[2], window[3]}, {size[0], size[1]}};
}

std::optional<ErrorMeasure> film_measure(const FilmIdentity& identity) {
    const auto adaptive = identity.find("adaptive");
    if (adaptive == identity.end() || !adaptive->is_string())
        return std::nullopt;
    return find_named<ErrorMeasure>(adaptive->get<std::string>());
}

Integrator film_integrator(const FilmIdentity& identity) {
    const auto name = identity.find("integrator");
    const auto found = name != identity.end() && name->is_string()
                           ? find_named<Integrator>(name->get<std::string>())
                           : std::nullopt;
    return found.value_or(Integrator::PATH);
}

bool film_reuses_paths(const FilmIdentity& identity) {
    return identity.value("path_reuse", FilmIdentity(false)) == true;
}

int film_light_samples(const FilmIdentity& identity) {
    const auto samples = identity.find("light_samples");
    for (int known = 2; samples != identity.end() && known <= MOST_LIGHT_SAMPLES; known *= 2)
        if (*samples == known)
            return known;
    return 1;
}

std::vector<std::string> film_layer_names(const FilmIdentity& identity) {
    std::vector<std::string> names;
    for (const auto& layer : identity.value("layers", FilmIdentity::array()))
        names.push_back(layer.at("name"));
    return names;
}

std::optional<std::string> identity_difference(const FilmIdentity& expected, const FilmIdentity& found) {
    for (const auto& [name, value] : expected.items()) {
        const auto other = found.find(name);
        if (other != found.end() && *other != value && name == "scene")
            return "scene: it is another one, or its files, camera or lights have changed";
        if (other == found.end() || *other != value)
            return fmt::format("{}: expected {}, found {}", name, value.dump(),
                               other == found.end() ? "none" : other->dump());
    }
    for (const auto& [name, value] : found.items())
        if (!expected.contains(name))
            return fmt::format("{}: expected none, found {}", name, value.dump());
    return std::nullopt;
}

} // namespace clrt
