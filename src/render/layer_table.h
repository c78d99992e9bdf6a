// SPDX-License-Identifier: Apache-2.0
// The layers that a picture may have beside the light of paths, a row each: --aov, its help and the pictures
// read them.
#pragma once

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

/// One layer.
struct LayerRow {
    std::string name; ///< in --aov
    /// In the file "name.R", or a single one by itself.
    std::vector<std::string> channels;
    LayerDefault by_default;
    bool is_from_hits; ///< needs the sums over the primary hits (film/hit_sums.h)
    bool is_id;        ///< written as uint
    /// The values, channel by channel of each pixel; none where the render has no such layer.
    std::vector<float> (*make)(const LayerSources&);
};

/// The layer that a transparent picture always has: the share of the samples that hit something.
inline const std::string ALPHA_LAYER = "alpha";

/// All rows, in the order of --help.
const std::vector<LayerRow>& layer_table();

/// The row of a name, or null.
const LayerRow* find_layer(const std::string& name);

/// The layer of a row with these values.
Layer make_layer(const LayerRow& row, std::vector<float> values);

/// All names, with this between them.
std::string layer_names(const char* separator);

} // namespace clrt
