// SPDX-License-Identifier: Apache-2.0
// --checkpoint and --resume: film files at work.
#pragma once

#include "render/film_file.h"

namespace clrt {

/// The film file of a render so far.
FilmFile make_film_file(const RenderProgress& render, const BiasSources& bias, const FilmIdentity& identity,
                        const Options& options, const DeviceInfo& device);

/// What --resume goes on from. Throws SceneError for a file that cannot be read, UsageError that names the
/// field in which the film differs from what scene and options would make.
RenderProgress read_resumed_film(const Options& options, const FilmIdentity& identity);

} // namespace clrt
