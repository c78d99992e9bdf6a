// SPDX-License-Identifier: Apache-2.0
// A picture and how a material looks it up.
#pragma once

#include "kernels/shared/types.h"
#include "scene/scene.h"

#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>

namespace clrt {

/// What a map is for: it decides how its numbers are stored and which channel is read.
enum class TextureRole {
    COLOUR,   ///< sRGB where the file holds integers
    NORMAL,   ///< three linear channels
    LEVEL,    ///< three linear channels that multiply a reflectance
    COVERAGE, ///< the alpha channel where there is one, else luminance
    SCALAR    ///< the only channel, else luminance
};

/// What is beside a picture along one axis; as WRAP_* of the kernels.
enum class TextureWrap : u32 {
    REPEAT = WRAP_REPEAT,
    BLACK = WRAP_BLACK,
    EDGE = WRAP_EDGE,
    MIRROR = WRAP_MIRROR
};

/// What a picture's alpha does where the picture is of a reflectance.
enum class TextureAlpha { IGNORED, MULTIPLIES, ALONE /**< the colours are taken as white */ };

/// The lookup of uv is at scale uv + shear vu + offset, its value base + gain times the texel.
struct TextureUse {
    std::string file;  ///< as written; relative to the file in `place` (find_file.h)
    SourcePlace place; ///< of the statement that names it
    glm::dvec2 scale{1}, offset{0}, shear{0};
    double base = 0, gain = 1;
    TextureWrap wrap_u = TextureWrap::REPEAT, wrap_v = TextureWrap::REPEAT;
    std::optional<u32> channel; ///< of a scalar: 0..3 = r, g, b, a; 4 = luminance; absent: by role and file
    TextureAlpha alpha = TextureAlpha::IGNORED;
    bool by_second_uvs = false; ///< looked up at Mesh::second_uvs in the place of Mesh::uvs
    bool by_vertex = false;     ///< no picture but Mesh::colours
    bool times_vertex = false;  ///< Mesh::colours multiply the picture, where it is of a reflectance
    /// The picture's file itself, where it lies within another file; `file` only names it then.
    std::shared_ptr<const std::string> bytes = nullptr;
};

/// Whether two uses read the same texel of the same picture at every point.
inline bool is_same_lookup(const TextureUse& a, const TextureUse& b) {
    return a.file == b.file && a.place.file == b.place.file && a.scale == b.scale && a.offset == b.offset &&
           a.shear == b.shear && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v &&
           a.by_second_uvs == b.by_second_uvs;
}

/// What readers may ask about pictures; false for one that cannot be read, which is said when it is used.
struct PictureFacts {
    std::function<bool(const TextureUse&, TextureRole)> is_readable;
    std::function<bool(const TextureUse&)> is_normal_map; ///< its texels are unit vectors
    std::function<bool(const TextureUse&)> has_alpha{};   ///< some texel of a COLOUR is not opaque
};

} // namespace clrt
