// SPDX-License-Identifier: Apache-2.0
// The value of a map_* statement: options and a file name that may hold spaces.
#pragma once

#include "scene/readers/mtl_reader.h"

#include <optional>
#include <string_view>

namespace clrt {

/// Parses "-s 2 2 -clamp on my picture.png"; options may also follow the name, and a comment may end the
/// line. Accepted and ignored, with a notice where they would change something: -blendu -blendv -boost -cc
/// -texres -type -colorspace and the turbulence of -t. Nothing, with a notice, if there is no file name.
/// Words of the form of an option that are none are left out with a notice, unless a file has such a name.
/// Throws SceneError (file:line) for an option without its numbers.
std::optional<MtlTexture> parse_mtl_texture(std::string_view key, std::string_view value,
                                            const SourcePlace& place, NoticeList& notices);

} // namespace clrt
