// SPDX-License-Identifier: Apache-2.0
// The scene and how it is read.
#pragma once

#include "options/names.h"
#include "options/toggle.h"

#include <cstddef>
#include <optional>
#include <string>

namespace clrt {

enum class MtlReading { AUTO, PLAIN };

template <>
inline constexpr Named<MtlReading> NAMES<MtlReading>[] = {{MtlReading::AUTO, "auto"},
                                                          {MtlReading::PLAIN, "plain"}};

/// CLAY: matte grey in the place of every material (scene/material_override.h).
enum class MaterialOverride { NONE, CLAY };

template <>
inline constexpr Named<MaterialOverride> NAMES<MaterialOverride>[] = {{MaterialOverride::NONE, "none"},
                                                                      {MaterialOverride::CLAY, "clay"}};

/// What the numbers of lights in a glTF file mean.
enum class GltfLights {
    BLENDER, ///< as Blender writes and reads them: candela and lux, divided by 683 lm/W
    RAW      ///< radiometric as they are
};

template <>
inline constexpr Named<GltfLights> NAMES<GltfLights>[] = {{GltfLights::BLENDER, "blender"},
                                                          {GltfLights::RAW, "raw"}};

/// Over what a ray's lookup of a texture is averaged.
enum class TextureFilter {
    NONE,     ///< one point: exact in the limit of many samples
    FOOTPRINT ///< what the ray's cone covers (kernels/geometry/ray_cone.h)
};

template <>
inline constexpr Named<TextureFilter> NAMES<TextureFilter>[] = {{TextureFilter::NONE, "none"},
                                                                {TextureFilter::FOOTPRINT, "footprint"}};

/// Where copies of a mesh are at least so many triangles, one copy and a second tree take less memory and are
/// built sooner; and the ray's way through two trees is no longer than through one that fills no cache.
constexpr size_t LEAST_COPIED_TRIANGLES = 1000000;

struct GltfReading {
    GltfLights lights = GltfLights::BLENDER;
    bool solid_glass = false; ///< transmission without volume refracts, where the standard has a thin wall
    std::optional<double> time{}; ///< seconds, of animations; absent: they are not played
    std::string animation{};      ///< name or number (from 1) of the one to play; empty: all
};

struct SceneOptions {
    std::string path;                  ///< a file; "-": the standard input
    std::string end_path;              ///< the same scene at time 1; empty: see end_time
    MtlReading mtl = MtlReading::AUTO; ///< auto: as the writers of libraries mean them
    MaterialOverride material_override = MaterialOverride::NONE;
    Toggle instances = Toggle::AUTO; ///< meshes that are used several times are shared, not copied
    GltfReading gltf{};
    std::optional<double> end_time{}; ///< seconds: the scene's own animations show it at time 1
    TextureFilter texture_filter = TextureFilter::NONE;
};

/// The option that tells where things are at time 1; null: nothing moves.
inline const char* end_option(const SceneOptions& scene) {
    return !scene.end_path.empty() ? "--end" : scene.end_time ? "--animation-time" : nullptr;
}

} // namespace clrt
