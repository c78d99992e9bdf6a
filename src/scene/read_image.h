// SPDX-License-Identifier: Apache-2.0
// Pictures from files, expanded to RGBA: grey becomes r = g = b, absent alpha 1.
#pragma once

#include "kernels/shared/types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace clrt {

/// What the numbers of an integer file mean. Float files are linear either way; alpha always is.
enum class ImageEncoding {
    COLOUR, ///< sRGB
    DATA    ///< linear
};

/// Rows from the top. Alpha is not multiplied into the colours.
struct FloatImage {
    int width = 0, height = 0;
    std::vector<vec4> rgba; ///< linear
};

/// A picture as a texture wants it: bytes where the file holds 8 bits a channel, else linear floats.
struct Image {
    int width = 0, height = 0;
    bool has_alpha = false, is_grey = false; ///< of the file, before the expansion
    std::vector<std::uint8_t> bytes;         ///< r, g, b, a; as in the file; empty: see `floats`
    std::vector<vec4> floats;                ///< linear
};

/// Reads a file's first picture; `bytes`: the file itself, which `path` only names then. Throws SceneError
/// (file: reason) if that is not possible.
Image read_image(const std::string& path, ImageEncoding encoding, const std::string* bytes = nullptr);

/// The same as linear floats whatever the file holds. Throws SceneError.
FloatImage read_float_image(const std::string& path, ImageEncoding encoding);

} // namespace clrt
