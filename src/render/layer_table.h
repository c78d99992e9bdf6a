// SPDX-License-Identifier: Apache-2.0
// The layers that a picture may have beside the light of paths, a row each: --aov, its help and the pictures
// read them.
#pragma once

#include "options/output_options.h"
#include "output/image.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

struct Options;
struct Render;

/// What layers are made of.
struct LayerSources {
    const Render& render;
    const Scene& scene;
    const Options& options;
};

/// What becomes of a layer that is not asked for while --aov is absent.
enum class LayerDefault {
    SHOWN,
    HIDDEN,
    SHOWN_WHERE_BAD, ///< where the render has bad samples
};

/// What a layer's values come from.
enum class LayerSource {
    FILM,
    HITS,   ///< sums over the primary hits (film/hit_sums.h)
    MATTES, ///< counts of samples by object and material (film/matte_sums.h)
};

/// How a layer's channels are called in EXR files: "layer.channel", or "channel" where the layer is "".
struct LayerChannels {
    std::string layer;
    std::vector<std::string> channels;
};

/// One layer.
struct LayerRow {
    std::string name;      ///< in --aov
    LayerChannels clrt;    ///< by our names
    LayerChannels blender; ///< by those of Blender 5.0's passes, where it has one of the kind
    LayerDefault by_default;
    LayerSource source;
    bool is_id; ///< written as uint
    /// The values, channel by channel of each pixel; none where the render has no such layer.
    std::vector<float> (*make)(const LayerSources&);
    /// What files say of it besides; null: nothing.
    Metadata (*attributes)(const Scene&) = nullptr;
};

/// The layer that a transparent picture always has: the share of the samples that hit something.
inline const std::string ALPHA_LAYER = "alpha";

/// The layer of the denoised picture, and the one that holds its error by tiles in a channel of that name.
inline const std::string DENOISED_LAYER = "denoised", ERROR_LAYER = "error";

/// All rows, in the order of --help.
const std::vector<LayerRow>& layer_table();

/// The row of a name, or null.
const LayerRow* find_layer(const std::string& name);

/// Whether channels of some row lie in a layer of this name, by whosever names.
bool is_layer_taken(const std::string& layer);

/// The layer of a row with these values.
Layer make_layer(const LayerRow& row, std::vector<float> values, ExrNames names = ExrNames::CLRT);

/// The layer of the picture's radiance.
Layer make_radiance_layer(std::vector<float> values, ExrNames names = ExrNames::CLRT);

/// The coverage that Blender expects in a picture whose samples count wherever they go: 1.
Layer make_opaque_layer(size_t pixels);

/// All names, with this between them.
std::string layer_names(const char* separator);

} // namespace clrt
