// SPDX-License-Identifier: Apache-2.0
// Options that are fine one by one and make no sense together.
#include "app/option_checks.h"

#include "app/camera_checks.h"
#include "app/option_values.h"
#include "error.h"
#include "film/adaptive.h"
#include "options/path_refusals.h"
#include "output/file_name.h"
#include "output/image.h"
#include "output/standard_streams.h"
#include "output/written_files.h"
#include "run/run_files.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

namespace clrt {

namespace {

/// Fewer give no interval.
constexpr int FEWEST_REPLICATES_WITH_ERROR = 4;
/// Two in each half, whose spread is the half's noise.
constexpr int FEWEST_ADAPTIVE_REPLICATES = 4;
/// Samples a pixel are counted in 32 bits.
constexpr std::uint64_t SAMPLE_LIMIT = std::uint64_t(1) << 32;

/// Two in each half: one half judges what is made of the other.
constexpr int FEWEST_REPLICATES_TO_DENOISE = 4;

/// The names of options in a message, each once, in their order.
std::vector<std::string> options_named(const std::string& message) {
    std::vector<std::string> names;
    size_t end = 0;
    for (size_t start = message.find("--"); start != std::string::npos; start = message.find("--", end)) {
        end = std::min(message.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", start), message.size());
        const std::string name = message.substr(start, end - start);
        if (std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
    }
    return names;
}

/// Adds where those of the named options come from that are not on the command line.
[[noreturn]] void reject(const Options& options, const std::string& message) {
    std::string origins;
    for (const std::string& name : options_named(message))
        if (const auto given = options.run.given.find(name);
            given != options.run.given.end() && !given->second.empty())
            origins += (origins.empty() ? " (" : ", ") + name + " is from " + given->second;
    throw UsageError(message + (origins.empty() ? "" : origins + ")"));
}

void check_crop(const Options& options) {
    if (!options.film.crop)
        return;
    const Crop& c = *options.film.crop;
    if (c.x1 <= options.film.size.x && c.y1 <= options.film.size.y)
        return;
    const auto text = [](int x) { return std::to_string(x); };
    reject(options, "option --crop: expected a window inside the picture of " + text(options.film.size.x) +
                        "x" + text(options.film.size.y) + " pixels (--size), found " + text(c.x0) + "," +
                        text(c.y0) + "," + text(c.x1) + "," + text(c.y1));
}

void check_output_sizes(const Options& options) {
    const glm::ivec2 window = options.film.crop ? glm::ivec2(options.film.crop->x1 - options.film.crop->x0,
                                                             options.film.crop->y1 - options.film.crop->y0)
                                                : options.film.size;
    for (const std::string& path : options.output.files) {
        const int limit = largest_output_side(path);
        if (window.x > limit || window.y > limit)
            reject(options, std::string("option ") + (options.film.crop ? "--crop" : "--size") +
                                ": expected at most " + std::to_string(limit) + " pixels a side for '" +
                                path + "', found " + std::to_string(window.x) + "x" +
                                std::to_string(window.y) + "; .png and .exr hold it");
    }
}

void check_camera(const Options& options) {
    if (const std::optional<std::string> fault = find_camera_fault(options))
        reject(options, *fault);
}

void check_samples(const Options& options) {
    const std::uint64_t end =
        std::uint64_t(options.sampling.first_sample) +
        options.sampling.spp.value_or(options.sampling.has_target() ? DEFAULT_SPP_WITH_ERROR : DEFAULT_SPP);
    if (end >= SAMPLE_LIMIT)
        reject(options, "options --first-sample and --spp: expected a sum below " +
                            std::to_string(SAMPLE_LIMIT) + ", found " + std::to_string(end));
}

void check_error_target(const Options& options) {
    if (options.sampling.error && options.sampling.replicates < FEWEST_REPLICATES_WITH_ERROR)
        reject(options, "option --error: expected --replicates " +
                            std::to_string(FEWEST_REPLICATES_WITH_ERROR) +
                            " or more, whose spread is the error, found " +
                            std::to_string(options.sampling.replicates));
}

/// Halves of the replicates decide for each other, from two samples in each replicate on.
void check_adaptive(const Options& options) {
    if (!options.sampling.adaptive)
        return;
    const IntegratorRow& integrator = integrator_row(options.transport.integrator);
    if (integrator.film == FilmAccess::SPLAT)
        reject(options, std::string("option --adaptive: expected an integrator that gathers, found ") +
                            integrator.name + ", whose light paths reach all pixels at once");
    const int replicates = options.sampling.replicates;
    if (replicates < FEWEST_ADAPTIVE_REPLICATES || replicates % 2 != 0)
        reject(options, "option --adaptive: expected an even number of --replicates from " +
                            std::to_string(FEWEST_ADAPTIVE_REPLICATES) + ", found " +
                            std::to_string(replicates));
    if (options.sampling.spp && *options.sampling.spp < pilot_samples(replicates))
        reject(options, "option --adaptive: expected --spp " + std::to_string(pilot_samples(replicates)) +
                            " or more with --replicates " + std::to_string(replicates) + ", found " +
                            std::to_string(*options.sampling.spp));
    if (options.sampling.first_sample != 0)
        reject(options, "option --adaptive: expected no --first-sample, found " +
                            std::to_string(options.sampling.first_sample) +
                            "; adaptive films do not merge, --resume goes on with them");
    if (!options.output.path_layers.empty())
        reject(options, "option --adaptive: expected no --aov NAME=EXPR, found the layer '" +
                            options.output.path_layers.front().name + "', which is not summed by halves");
    if (options.run.ledger != LedgerOf::NOTHING)
        reject(options, "option --adaptive: expected no --ledger, found both; the ledger compares pictures "
                        "of equal samples");
}

/// Halves of the replicates judge each other.
void check_denoise(const Options& options) {
    if (!options.denoise.denoiser) {
        if (options.denoise.png_from == PngFrom::DENOISED)
            reject(options, "option --png-from denoised: expected together with --denoise, found alone");
        return;
    }
    const int replicates = options.sampling.replicates;
    if (replicates < FEWEST_REPLICATES_TO_DENOISE || replicates % 2 != 0)
        reject(options, "option --denoise: expected an even number of --replicates from " +
                            std::to_string(FEWEST_REPLICATES_TO_DENOISE) + ", found " +
                            std::to_string(replicates));
    if (options.sampling.spp && *options.sampling.spp < std::uint32_t(replicates))
        reject(options, "option --denoise: expected --spp " + std::to_string(replicates) +
                            " or more with --replicates " + std::to_string(replicates) + ", found " +
                            std::to_string(*options.sampling.spp));
    if (options.run.ledger != LedgerOf::NOTHING)
        reject(options, "options --denoise and --ledger: expected one of them, found both; the ledger "
                        "writes no picture");
}

/// A step of a chain follows from all those before it.
void check_chains(const Options& options) {
    if (!walks_chains(options.transport.integrator))
        return;
    const std::string name = name_of(options.transport.integrator);
    if (options.run.pixel)
        reject(options, "options --pixel and --integrator " + name +
                            ": expected one of them, found both; a step of a chain needs all before it");
    if (options.run.ledger != LedgerOf::NOTHING)
        reject(options, "options --ledger and --integrator " + name +
                            ": expected one of them, found both; the ledger compares pictures of the same "
                            "samples, and chains of two pictures part");
}

/// What is asked for by name is done or refused.
void check_asked(const Options& options, IntegratorOption option, Toggle asked,
                 const std::optional<PathRefusal>& refusal) {
    if (!refusal || asked != Toggle::ON)
        return;
    std::string other = refusal->option;
    if (!takes_option(options.transport.integrator, option))
        other += std::string(" ") + name_of(options.transport.integrator);
    reject(options, std::string("options ") + name_of(option) + " on and " + other +
                        ": expected one of them, found both; " + refusal->reason);
}

/// Devices share samples that need none before them.
void check_devices(const Options& options) {
    const std::vector<std::string> names = device_names(options.device);
    if (names.size() < 2)
        return;
    if (std::count(names.begin(), names.end(), ""))
        reject(options, "option --device: expected a name between commas, found none");
    const std::tuple<bool, std::string, const char*> others[] = {
        {options.sampling.adaptive.has_value(), "--adaptive",
         "a round deals out samples by the noise of all before it"},
        {walks_chains(options.transport.integrator),
         std::string("--integrator ") + name_of(options.transport.integrator),
         "a step of a chain follows from all those before it"},
        {options.run.ledger != LedgerOf::NOTHING, "--ledger", "its seconds are those of one device"},
        {options.run.pixel.has_value(), "--pixel", "a sample is replayed on one device"},
        {!options.device.dump_folder.empty(), "--dump-kernels", "each device has kernels of its own"}};
    for (const auto& [is_given, name, reason] : others)
        if (is_given)
            reject(options, "option --device: expected one device with " + name + ", found " +
                                std::to_string(names.size()) + "; " + reason);
}

/// Placeholders that are known; {frame} where there are frames.
void check_name(const Options& options, const char* option, const std::string& name) {
    bool has_frame = false;
    try {
        has_frame = names_frame(name);
    } catch (const UsageError& error) {
        reject(options, std::string("option ") + option + ": " + error.what());
    }
    if (has_frame && !options.camera.frames)
        reject(options,
               std::string("option ") + option + ": expected --frames with '" + name + "', found none");
}

void check_names(const Options& options) {
    for (const std::string& path : options.output.files)
        check_name(options, "--output", path);
    check_name(options, "--stats", options.output.stats_path);
}

/// A turn is pictures, one after the other.
void check_frames(const Options& options) {
    if (!options.camera.frames)
        return;
    const std::pair<const char*, bool> others[] = {
        {"--resume", !options.film_file.resume_path.empty()},
        {"--checkpoint", !options.film_file.checkpoint_path.empty()},
        {"--pixel", options.run.pixel.has_value()},
        {"--ledger", options.run.ledger != LedgerOf::NOTHING},
        {"--explain", options.run.explain != Explain::NO}};
    for (const auto& [name, is_given] : others)
        if (is_given)
            reject(options,
                   std::string("options --frames and ") + name + ": expected one of them, found both");
    std::vector<std::string> results = options.output.files;
    results.push_back(options.output.stats_path);
    if (std::any_of(results.begin(), results.end(), is_standard_output))
        reject(options, "option --frames: expected files for its results, found the standard output");
}

/// The standard output takes one picture, at the end.
void check_save_every(const Options& options) {
    if (options.output.save_every_seconds && !options.output.files.empty() &&
        std::all_of(options.output.files.begin(), options.output.files.end(), is_standard_output))
        reject(options,
               "option --save-every: expected an --output to a file, found the standard output alone");
}

/// --pixel and --sample name a sample of the picture.
void check_replay(const Options& options) {
    if (!options.run.pixel) {
        if (options.run.given.count("--sample"))
            reject(options, "option --sample: expected together with --pixel, found alone");
        return;
    }
    const Crop window = options.film.crop.value_or(Crop{0, 0, options.film.size.x, options.film.size.y});
    const glm::ivec2 p = *options.run.pixel;
    if (p.x < window.x0 || p.x >= window.x1 || p.y < window.y0 || p.y >= window.y1)
        reject(options, "option --pixel: expected a pixel of the picture, from " + std::to_string(window.x0) +
                            "," + std::to_string(window.y0) + " to " + std::to_string(window.x1 - 1) + "," +
                            std::to_string(window.y1 - 1) + ", found " + std::to_string(p.x) + "," +
                            std::to_string(p.y));
    if (!options.sampling.spp) // no known end
        return;
    const std::uint64_t end = std::uint64_t(options.sampling.first_sample) + *options.sampling.spp;
    if (options.run.sample < options.sampling.first_sample || options.run.sample >= end)
        reject(options, "option --sample: expected a sample of the picture, from " +
                            std::to_string(options.sampling.first_sample) + " to " + std::to_string(end - 1) +
                            ", found " + std::to_string(options.run.sample));
}

/// What is seen is a render.
void check_view(const Options& options) {
    if (!is_viewed(options.view))
        return;
    const std::string view = options.view.serve_port ? "--serve" : "--display-server";
    const std::pair<const char*, bool> others[] = {{"--pixel", options.run.pixel.has_value()},
                                                   {"--ledger", options.run.ledger != LedgerOf::NOTHING},
                                                   {"--explain", options.run.explain != Explain::NO}};
    for (const auto& [name, is_given] : others)
        if (is_given)
            reject(options, "options " + view + " and " + name +
                                ": expected one of them, found both; there is no picture to be seen");
}

bool has_layered_output(const Options& options) {
    return std::any_of(options.output.files.begin(), options.output.files.end(), is_layered_output);
}

/// Not every integrator can tell paths apart.
void check_paths(const Options& options) {
    const IntegratorRow& integrator = integrator_row(options.transport.integrator);
    const bool has_paths = !options.transport.paths.empty();
    if ((has_paths || !options.output.path_layers.empty()) && !(integrator.takes & TAKES_PATHS))
        reject(options, std::string(has_paths ? "option --paths" : "option --aov NAME=EXPR") +
                            ": expected --integrator " + alternatives(integrators_with(TAKES_PATHS)) +
                            ", found " + integrator.name +
                            (integrator.film == FilmAccess::SPLAT
                                 ? ", whose light paths are not told apart"
                                 : std::string(", which simulates '") + integrator.paths.all + "' alone"));
    if (!options.output.path_layers.empty() && !has_layered_output(options) &&
        options.run.explain == Explain::NO && !options.run.pixel)
        reject(options, "option --aov: expected an output that ends in .exr for the layer '" +
                            options.output.path_layers.front().name + "', found none; add -o FILE.exr");
}

/// Strategies are those of paths from both ends.
void check_strategies(const Options& options) {
    if (!options.output.strategies)
        return;
    const std::string found =
        options.transport.choose == Toggle::OFF ? name_of(options.transport.integrator) : CHOSEN_INTEGRATOR;
    if (options.transport.integrator != Integrator::BDPT)
        reject(options, std::string("option --aov strategies: expected --integrator ") +
                            name_of(Integrator::BDPT) + ", found " + found +
                            (walks_chains(options.transport.integrator)
                                 ? ", whose chains choose among strategies by their light"
                                 : ", which has no strategies of vertices from both ends"));
    if (!has_layered_output(options) && options.run.explain == Explain::NO && !options.run.pixel)
        reject(options, "option --aov strategies: expected an output that ends in .exr, found none; add "
                        "-o FILE.exr");
}

void check_depth(const Options& options) {
    const IntegratorRow& integrator = integrator_row(options.transport.integrator);
    const int depth = effective_max_depth(options.transport);
    if (depth > integrator.depth.longest)
        reject(options, "option --max-depth: expected at most " + std::to_string(integrator.depth.longest) +
                            " with --integrator " + integrator.name + ", found " + std::to_string(depth));
}

} // namespace

void check_combinations(const Options& options) {
    check_crop(options);
    check_output_sizes(options);
    check_camera(options);
    check_samples(options);
    check_error_target(options);
    check_adaptive(options);
    check_denoise(options);
    check_chains(options);
    check_asked(options, TAKES_PATH_REUSE, options.transport.path_reuse, reuse_refusal(options));
    check_asked(options, TAKES_GUIDE, options.transport.guide, guide_refusal(options));
    check_devices(options);
    check_names(options);
    check_frames(options);
    check_written_files(files_to_write(options), files_to_read(options));
    check_save_every(options);
    check_view(options);
    check_paths(options);
    check_strategies(options);
    check_replay(options);
    check_depth(options);
}

} // namespace clrt
