// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_request.h"

#include <algorithm>

namespace clrt {

namespace {

bool is_exr(const std::string& path) {
    return path.size() > 4 && path.compare(path.size() - 4, 4, ".exr") == 0;
}

} // namespace

SceneRequest::SceneRequest(const Options& options)
    : scene(options.scene), camera(options.camera), light(options.light), size(options.film.size),
      is_size_given(options.run.given.count("--size") != 0 || options.film.crop.has_value()),
      writes_layers(std::any_of(options.output.files.begin(), options.output.files.end(), is_exr)) {}

} // namespace clrt
