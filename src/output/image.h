// SPDX-License-Identifier: Apache-2.0
// Pictures in memory and on disk. Files are written under a temporary name and renamed.
#pragma once

#include "options/output_options.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// One metadata entry; numbers are written as their text.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// A layer of a picture: `channels` values a pixel, rows from the top.
struct Layer {
    std::string name; ///< "" for the picture itself
    std::vector<std::string>
        channel_names;         ///< such as {"R","G","B"}; in the file "name.R", or "R" if name is empty
    std::vector<float> values; ///< width * height * channels
    bool is_id = false;        ///< written as uint; values are exact integers below 2^24
    bool is_coverage = false;  ///< the share of each pixel's samples that hit something
    Metadata attributes = {};  ///< what an EXR file says of the layer, under these very names
};

/// A rendered picture: linear radiance in layers[0], then the other layers.
struct Picture {
    int width = 0, height = 0; ///< of the window
    int x0 = 0, y0 = 0;        ///< the window's place in the whole picture
    int full_width = 0, full_height = 0;
    std::vector<Layer> layers;
    size_t displayed = 0;        ///< the layer that 8-bit files show
    bool is_transparent = false; ///< a layer is the coverage by which layers[0] is multiplied
    Metadata metadata;
};

/// The extensions of pictures, in any case, as words for messages.
inline constexpr const char* OUTPUT_EXTENSIONS =
    ".png, .jpg, .jpeg, .bmp, .tga, .ppm, .exr, .tif, .tiff, .hdr or .pfm";

/// What a picture's name must be, for messages.
std::string expected_output();

/// The format that a picture's name asks for, in lower case: "png" of "a.PNG" and of "png:-", the standard
/// output.
std::string output_format(const std::string& path);

/// Whether a picture can be written under this name: one of the extensions, or a format of them and ":-".
bool is_output_path(const std::string& path);

/// Throws UsageError when it cannot, before any work is done.
void check_output_path(const std::string& path);

/// Whether such a picture holds layers beside the picture itself.
bool is_layered_output(const std::string& path);

/// Whether such a picture has 8 bits, with exposure and tone map.
bool is_display_output(const std::string& path);

/// Whether such a picture holds the coverage of --background transparent: unassociated alpha, but for EXR.
bool can_hold_alpha(const std::string& path);

/// Pixels that a side of such a picture can have at most; libjpeg ends the process beyond its limit.
int largest_output_side(const std::string& path);

/// Throws SceneError when the file's folder is not there or cannot be written, before any work is done. The
/// standard output has none.
void check_output_folder(const std::string& path);

/// Loads what writes such a picture, before any work is done: image_library() for all but .png and .pfm.
/// Throws std::runtime_error where it cannot be loaded.
void prepare_output(const std::string& path);

/// The coverage of a transparent picture, a value a pixel; none of an opaque one.
const std::vector<float>* picture_coverage(const Picture& picture);

/// Writes the picture. 8-bit formats get exposure, tone map and the sRGB curve and only the displayed
/// layer; .hdr, .pfm and float TIFF get linear layer 0; .exr gets every layer as float and the metadata.
/// Those that hold alpha get the coverage of a transparent picture. The file appears whole or not at all:
/// temporary name in the same folder, flush, rename; on the standard output likewise, all at once. Throws
/// SceneError with the reason (no such folder, disk full, ...).
void write_picture(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap);

/// Writes text under a temporary name and renames it, or to the standard output. Throws SceneError.
void write_text_file(const std::string& path, const std::string& text);

} // namespace clrt
