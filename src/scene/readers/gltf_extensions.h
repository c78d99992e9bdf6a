// SPDX-License-Identifier: Apache-2.0
// The extensions of glTF that are read.
#pragma once

#include "scene/notices.h"
#include "scene/readers/gltf_json.h"

#include <string>
#include <vector>

namespace clrt {

/// Their names, in alphabetical order.
const std::vector<std::string>& gltf_extensions();

/// Throws SceneError for a required extension that is not read; those that are only used are one notice.
void check_gltf_extensions(const JsonDocument& json, NoticeList& notices);

} // namespace clrt
