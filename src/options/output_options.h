// SPDX-License-Identifier: Apache-2.0
// Files that are written, and how a picture is shown.
#pragma once

#include "options/names.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

enum class Tonemap { NONE, REINHARD, ACES, FILMIC, AGX };

template <>
inline constexpr Named<Tonemap> NAMES<Tonemap>[] = {{Tonemap::NONE, "none"},
                                                    {Tonemap::REINHARD, "reinhard"},
                                                    {Tonemap::ACES, "aces"},
                                                    {Tonemap::FILMIC, "filmic"},
                                                    {Tonemap::AGX, "agx"}};

/// Whose names the layers of EXR files have.
enum class ExrNames { CLRT, BLENDER };

template <>
inline constexpr Named<ExrNames> NAMES<ExrNames>[] = {{ExrNames::CLRT, "clrt"},
                                                      {ExrNames::BLENDER, "blender"}};

/// An EXR layer with the light of some paths.
struct PathLayerOption {
    std::string name;
    std::string expression; ///< path notation (paths/path_expression.h)
};

struct OutputOptions {
    std::vector<std::string> files; ///< default STEM.png in the current folder; may hold {seed} and others
    double exposure_ev = 0;         ///< stops, PNG and other 8-bit files only
    bool auto_exposure = false;     ///< exposure_ev is added to what the picture asks for
    Tonemap tonemap = Tonemap::NONE;
    std::optional<std::vector<std::string>> aovs; ///< EXR layers; absent: all, empty: none
    std::vector<PathLayerOption> path_layers;     ///< further EXR layers, made from the picture's light
    std::optional<int> strategies; ///< further EXR layers by how paths of up to so many segments are found
    ExrNames exr_names = ExrNames::CLRT;
    std::string stats_path;                   ///< JSON; empty: none
    std::optional<double> save_every_seconds; ///< between two pictures so far
};

} // namespace clrt
