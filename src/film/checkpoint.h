// SPDX-License-Identifier: Apache-2.0
// --checkpoint and --resume: film files at work.
#pragma once

#include "device/device.h"
#include "film/film_file.h"
#include "options/options.h"

namespace clrt {

/// The film file of a render so far.
FilmFile make_film_file(const RenderProgress& render, const BiasSources& bias, const FilmIdentity& identity,
                        const Options& options, const DeviceInfo& device);

/// Before a render: throws UsageError where --checkpoint names what is there already and neither --resume nor
/// --force says what to do with it, or what is no file at all.
void check_checkpoint(const Options& options);

/// Why a film must not replace what is there under its name without --force: no film that can be read, one of
/// another identity, or one with samples that this one lacks. Nothing where no file is there.
std::optional<std::string> replacement_obstacle(const std::string& path, const FilmContent& film);

/// What --resume goes on from. Throws SceneError for a file that cannot be read, UsageError that names the
/// field in which the film differs from what scene and options would make.
RenderProgress read_resumed_film(const Options& options, const FilmIdentity& identity);

} // namespace clrt
