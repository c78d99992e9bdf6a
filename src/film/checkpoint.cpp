// SPDX-License-Identifier: Apache-2.0
#include "film/checkpoint.h"

#include "error.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace clrt {

namespace {

/// What a film holds; nothing for a file that cannot be read as one.
std::optional<FilmContent> content_if_film(const std::string& path) {
    try {
        return read_film_content(path);
    } catch (const SceneError&) {
        return std::nullopt;
    }
}

/// "32 spp", and which they are where they are not the first.
std::string samples_text(const std::vector<SampleRange>& ranges) {
    std::uint64_t count = 0;
    std::string places;
    for (const SampleRange& range : ranges) {
        count += range.end - range.first;
        places += fmt::format("{}{} to {}", places.empty() ? "" : ", ", range.first, range.end - 1);
    }
    const bool are_first = ranges.size() == 1 && ranges[0].first == 0;
    return fmt::format("{} spp", count) + (are_first ? "" : " (samples " + places + ")");
}

} // namespace

FilmFile make_film_file(const RenderProgress& render, const BiasSources& bias, const FilmIdentity& identity,
                        const Options& options, const DeviceInfo& device) {
    const FilmOrigin origin{options.run.resumable_command, std::filesystem::current_path().string(),
                            device.platform + ": " + device.name};
    return {identity, origin, render, bias};
}

void check_checkpoint(const Options& options) {
    const std::string& path = options.film_file.checkpoint_path;
    std::error_code error; // what cannot be looked at is refused when it is written
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (path.empty() || !std::filesystem::exists(status))
        return;
    if (!std::filesystem::is_regular_file(status))
        throw UsageError(
            fmt::format("option --checkpoint: expected a file, found '{}', a folder or device", path));
    if (!options.film_file.resume_path.empty() || options.film_file.force)
        return;
    const std::optional<FilmContent> film = content_if_film(path);
    throw UsageError(
        film ? fmt::format("option --checkpoint: expected a new file, found '{0}', a film of {1}: "
                           "--resume {0} goes on with it, --force replaces it",
                           path, samples_text(film->ranges))
             : fmt::format("option --checkpoint: expected a new file, found '{}', which is no film "
                           "that can be read; --force replaces it",
                           path));
}

std::optional<std::string> replacement_obstacle(const std::string& path, const FilmContent& film) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        return std::nullopt;
    const std::optional<FilmContent> there = content_if_film(path);
    if (!there)
        return "what is there is no film that can be read";
    if (const auto difference = identity_difference(there->identity, film.identity))
        return fmt::format("the film that is there is of another scene or other options ({})", *difference);
    const auto is_inside = [&](const SampleRange& range) {
        return std::any_of(film.ranges.begin(), film.ranges.end(), [&](const SampleRange& other) {
            return other.first <= range.first && range.end <= other.end;
        });
    };
    if (std::all_of(there->ranges.begin(), there->ranges.end(), is_inside))
        return std::nullopt;
    return fmt::format("the film that is there has {}, and this one {}", samples_text(there->ranges),
                       samples_text(film.ranges));
}

RenderProgress read_resumed_film(const Options& options, const FilmIdentity& identity) {
    FilmFile film = read_film_file(options.film_file.resume_path);
    std::optional<std::string> difference = identity_difference(film.identity, identity);
    const std::uint64_t first = film.render.film.ranges.front().first;
    if (!difference && first != options.sampling.first_sample)
        difference = fmt::format("first_sample: expected {}, found {}", first, options.sampling.first_sample);
    if (difference)
        throw UsageError(
            fmt::format("option --resume: scene and options must be those of '{}', but they differ in {}",
                        options.film_file.resume_path, *difference));
    return std::move(film.render);
}

} // namespace clrt
