// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "images/image_library.h"

namespace clrt {

/// Reads a file's first picture by OpenImageIO; `bytes`: the file itself, a PNG, JPEG or WebP, or null.
/// Throws SceneError.
StoredImage read_by_oiio(const std::string& path, const std::string* bytes);

} // namespace clrt
