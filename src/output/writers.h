// SPDX-License-Identifier: Apache-2.0
// The kinds of image files, one function each; write_picture (image.h) chooses. All throw SceneError; all but
// write_png and write_pfm use image_library().
#pragma once

#include "output/image.h"

#include <string>

namespace clrt {

/// Every layer as float or uint, ZIP-compressed; the window's place in the whole picture; metadata as text
/// attributes "clrt.NAME".
void write_exr(const Picture& picture, const std::string& path);

/// Layer 0 as 8-bit sRGB after exposure and tone map, with unassociated alpha where the picture has it.
void write_png(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap);

/// The same where the format has alpha, too: JPEG, BMP, TGA, PPM.
void write_display(const Picture& picture, const std::string& path, double exposure_ev, Tonemap tonemap);

/// Layer 0 as linear numbers: float TIFF, with alpha as write_display, or Radiance HDR, which holds no
/// negative and no non-finite numbers.
void write_linear(const Picture& picture, const std::string& path);

/// Layer 0 as linear floats: Portable Float Map.
void write_pfm(const Picture& picture, const std::string& path);

} // namespace clrt
