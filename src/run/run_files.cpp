// SPDX-License-Identifier: Apache-2.0
#include "run/run_files.h"

#include "device/kernel_source.h"
#include "output/file_name.h"
#include "output/image.h"
#include "output/standard_streams.h"
#include "output/written_files.h"
#include "render/kernels.h"
#include "scene/scene.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>

namespace clrt {

namespace {

/// A replay and a ledger write neither pictures nor films.
bool writes_pictures(const Options& options) {
    return !options.run.pixel && options.run.ledger == LedgerOf::NOTHING;
}

/// The names that a result gets: one, or one a frame. Where --spp does not say, the number of samples is that
/// of a render without limits.
std::vector<std::string> planned_names(const std::string& name, const Options& options) {
    const std::uint32_t spp = options.sampling.spp.value_or(DEFAULT_SPP);
    if (!options.camera.frames)
        return {expand_file_name(name, {options.sampling.seed, spp, 0})};
    std::vector<std::string> names;
    for (int frame = 1; frame <= *options.camera.frames; ++frame)
        names.push_back(expand_file_name(with_frame_number(name), {options.sampling.seed, spp, frame}));
    return names;
}

} // namespace

std::vector<NamedFile> files_to_write(const Options& options) {
    std::vector<NamedFile> files;
    if (options.run.explain != Explain::NO)
        return files;
    const bool has_picture = writes_pictures(options);
    const bool is_default = options.run.given.count("--output") == 0;
    if (has_picture)
        for (const std::string& name : options.output.files)
            for (const std::string& path : planned_names(name, options))
                files.push_back({is_default ? "--output (by default)" : "--output", path});
    if (has_picture && !options.film_file.checkpoint_path.empty())
        files.push_back({options.run.given.count("--checkpoint") ? "--checkpoint" : "--resume",
                         options.film_file.checkpoint_path});
    if (!options.output.stats_path.empty())
        for (const std::string& path : planned_names(options.output.stats_path, options))
            files.push_back({"--stats", path});
    for (const std::string& path : dumped_files(options))
        files.push_back({"--dump-kernels", path});
    return files;
}

std::vector<NamedFile> files_to_read(const Options& options) {
    const bool is_piped = is_standard_input(options.scene.path);
    std::vector<NamedFile> files = {{"the scene", is_piped ? "/dev/stdin" : options.scene.path},
                                    {"the scene at time 1", options.scene.end_path},
                                    {"the options file", options.run.sidecar_path},
                                    {"the environment map", options.light.environment_file}};
    if (!writes_pictures(options) ||
        !is_same_file(options.film_file.resume_path, options.film_file.checkpoint_path))
        files.push_back({"the film to go on from", options.film_file.resume_path});
    return files;
}

void print_report(const Options& options, const std::string& text) {
    const std::vector<NamedFile> results = files_to_write(options);
    const bool is_taken = std::any_of(results.begin(), results.end(),
                                      [](const NamedFile& file) { return is_standard_output(file.path); });
    std::fputs(text.c_str(), is_taken ? stderr : stdout);
}

void check_run_files(const Options& options, const Scene& scene) {
    std::vector<NamedFile> read = files_to_read(options);
    read.insert(read.end(), scene.files.begin(), scene.files.end());
    if (!options.device.kernels_folder.empty())
        for (const auto& [name, text] : read_kernel_files(options.device.kernels_folder))
            read.push_back(
                {"the kernel file", (std::filesystem::path(options.device.kernels_folder) / name).string()});
    const std::vector<NamedFile> written = files_to_write(options);
    check_written_files(written, read);
    for (const NamedFile& file : written)
        prepare_output(file.path); // does nothing for films and statistics
}

} // namespace clrt
