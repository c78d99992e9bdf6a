// SPDX-License-Identifier: Apache-2.0
// What decides the bits of a film, field by field: films can be continued and merged where all fields are the
// same.
#pragma once

#include "film/film.h"
#include "kernels/shared/render_types.h"
#include "options/options.h"
#include "scene/scene.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace clrt {

/// Names and values. Sample range, device, tree and effects mask are not among them: they change no bit.
using FilmIdentity = nlohmann::ordered_json;

/// XXH3 (128 bits, hexadecimal) of everything in the scene that kernels see: geometry, materials, textures,
/// lights, environment, camera. The same for the same files, wherever they lie.
std::string scene_hash(const Scene& scene);

/// The identity of what these options, and the parameters that they give (make_render_params), make of this
/// scene.
FilmIdentity film_identity(const Scene& scene, const Options& options, const RenderParams& params,
                           const FilmScale& scale);

/// The window of the picture that an identity's film shows, and the whole picture's size.
struct FilmWindow {
    Crop window;
    glm::ivec2 size{0};
};
FilmWindow film_window(const FilmIdentity& identity);

/// The background of films whose pictures want an alpha channel, which the film does not hold.
inline constexpr const char* TRANSPARENT_BACKGROUND = "transparent";

/// The error that an adaptive identity's film makes least; none of one that is not adaptive.
std::optional<ErrorMeasure> film_measure(const FilmIdentity& identity);

/// The integrator of an identity's film; path where none is known by its name.
Integrator film_integrator(const FilmIdentity& identity);

/// Whether a film's paths were reused.
bool film_reuses_paths(const FilmIdentity& identity);

/// How many light samples a film's paths took at their first vertex; one where it says what cannot be.
int film_light_samples(const FilmIdentity& identity);

/// Names of the layers of paths of an identity's film.
std::vector<std::string> film_layer_names(const FilmIdentity& identity);

/// The first field in which two identities differ, with both values, as "seed: expected 0, found 1"; none
/// when they are the same.
std::optional<std::string> identity_difference(const FilmIdentity& expected, const FilmIdentity& found);

} // namespace clrt
