// SPDX-License-Identifier: Apache-2.0
// The picture so far, as it is shown.
#pragma once

#include "render/render.h"

#include <memory>
#include <optional>
#include <vector>

namespace clrt {

/// What a render has come to. Never changed once it is made, so threads may share it.
struct Snapshot {
    int width = 0, height = 0;                ///< of the window that is rendered
    int x0 = 0, y0 = 0;                       ///< its place in the whole picture
    std::vector<float> rgb;                   ///< linear radiance, rows from the top
    std::vector<float> errors;                ///< error_map(), or empty
    std::optional<FilmError> error;           ///< of the picture
    std::uint64_t samples = 0;                ///< a pixel
    double seconds = 0;                       ///< of rendering
    std::optional<std::uint64_t> guided_from; ///< the first sample that was guided
};

using SnapshotPointer = std::shared_ptr<const Snapshot>;

/// Of a film that has been read back.
SnapshotPointer make_snapshot(const Render& render, const Options& options);

} // namespace clrt
