// SPDX-License-Identifier: Apache-2.0
#include "render/checkpoint.h"

#include "error.h"

#include <filesystem>
#include <fmt/format.h>

namespace clrt {

FilmFile make_film_file(const RenderProgress& render, const BiasSources& bias, const FilmIdentity& identity,
                        const Options& options, const DeviceInfo& device) {
    const FilmOrigin origin{options.resumable_command, std::filesystem::current_path().string(),
                            device.platform + ": " + device.name};
    return {identity, origin, render, bias};
}

RenderProgress read_resumed_film(const Options& options, const FilmIdentity& identity) {
    FilmFile film = read_film_file(options.resume_path);
    std::optional<std::string> difference = identity_difference(film.identity, identity);
    const std::uint64_t first = film.render.film.ranges.front().first;
    if (!difference && first != options.first_sample)
        difference = fmt::format("first_sample: expected {}, found {}", first, options.first_sample);
    if (difference)
        throw UsageError(
            fmt::format("option --resume: scene and options must be those of '{}', but they differ in {}",
                        options.resume_path, *difference));
    return std::move(film.render);
}

} // namespace clrt
