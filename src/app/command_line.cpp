// SPDX-License-Identifier: Apache-2.0
// argv and the options file -> Options.
#include "app/command_line.h"

#include "app/arguments.h"
#include "app/help_text.h"
#include "app/option_checks.h"
#include "app/options_file.h"
#include "console/terminal.h"
#include "error.h"
#include "film/film_file.h"
#include "output/file_name.h"
#include "output/image.h"
#include "output/standard_streams.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <unistd.h>

namespace clrt {

namespace {

/// As wide as the terminal, within what reads well.
size_t help_columns() {
    return std::clamp<size_t>(terminal_columns(STDOUT_FILENO, 80), 80, 100);
}

bool is_given(const std::vector<GivenOption>& options, const std::string& long_name) {
    return std::any_of(options.begin(), options.end(),
                       [&](const GivenOption& given) { return given.value.option == long_name; });
}

std::string only_scene(const std::vector<std::string>& scenes, bool list_devices) {
    if (scenes.empty() && list_devices)
        return "";
    if (scenes.empty())
        throw UsageError("expected a scene: clrt [options] scene.obj; `clrt --help` lists the options");
    if (scenes.size() > 1)
        throw UsageError("expected one scene, found " + std::to_string(scenes.size()) + ": '" + scenes[0] +
                         "' and '" + scenes[1] + "'" + (scenes.size() > 2 ? " and more" : ""));
    if (std::filesystem::path(scenes[0]).extension() == ".clrt")
        throw UsageError("expected a scene such as STEM.obj, found the options file '" + scenes[0] +
                         "'; it is read by itself beside its scene");
    return scenes[0];
}

void reject_exclusive(const std::vector<GivenOption>& options) {
    for (const auto& [a, b] : exclusive_options())
        if (is_given(options, a) && is_given(options, b)) {
            const auto last =
                std::find_if(options.rbegin(), options.rend(), [&, a = a, b = b](const auto& given) {
                    return given.value.option == a || given.value.option == b;
                });
            throw UsageError(last->value.origin + "options " + a + " and " + b +
                             ": expected one of them, found both");
        }
}

/// Whether the command line says something about what the file's option says.
bool overruled(const GivenOption& from_file, const std::vector<GivenOption>& command_line) {
    const std::string& name = from_file.value.option;
    for (const auto& [a, b] : exclusive_options())
        if ((name == a && is_given(command_line, b)) || (name == b && is_given(command_line, a)))
            return true;
    return is_given(command_line, name);
}

/// Whether it is one of the options that end a render.
bool is_budget(const std::string& name) {
    return name == "--spp" || name == "--time" || name == "--error" || name == "--denoised-error";
}

/// Whether any of the options that end a render is given.
bool has_budget(const std::vector<GivenOption>& options) {
    return std::any_of(options.begin(), options.end(),
                       [](const GivenOption& option) { return is_budget(option.value.option); });
}

/// Whether an option is about one run alone: how it talks, who sees it, what it may replace and where it
/// started.
bool is_of_one_run(const std::string& name) {
    constexpr const char* NAMES[] = {"--resume",   "--force", "--quiet",         "--verbose",
                                     "--progress", "--serve", "--display-server"};
    return std::find(std::begin(NAMES), std::end(NAMES), name) != std::end(NAMES);
}

/// `clrt --resume FILM` and further options: the command that the film was rendered with, overruled by them.
/// A new budget replaces the old one as a whole. Films of earlier versions hold options of one run as well.
Arguments continue_command(const Arguments& given) {
    const auto resume =
        std::find_if(given.options.begin(), given.options.end(),
                     [](const GivenOption& option) { return option.value.option == "--resume"; });
    const FilmOrigin origin = read_film_origin(resume->value.text);
    const std::string here = std::filesystem::current_path().string();
    if (origin.folder != here)
        throw UsageError(
            "option --resume: expected the whole command, or to run in the folder of the film's command, " +
            origin.folder + "; found " + here);
    std::vector<const char*> words;
    for (const std::string& word : origin.command)
        words.push_back(word.c_str());
    Arguments earlier = split_arguments(int(words.size()), words.data());
    Arguments all{{}, earlier.scenes};
    for (const GivenOption& option : earlier.options)
        if (!is_of_one_run(option.value.option) && !overruled(option, given.options) &&
            !(is_budget(option.value.option) && has_budget(given.options)))
            all.options.push_back(option);
    all.options.insert(all.options.end(), given.options.begin(), given.options.end());
    return all;
}

/// The words of a command line without what is about one run alone.
std::vector<std::string> resumable_command(const Arguments& arguments) {
    std::vector<std::string> words{"clrt"};
    for (const GivenOption& option : arguments.options)
        if (!is_of_one_run(option.value.option))
            words.push_back(option.value.option + (option.value.text.empty() ? "" : "=" + option.value.text));
    words.emplace_back("--"); // scenes may start with a dash
    words.insert(words.end(), arguments.scenes.begin(), arguments.scenes.end());
    return words;
}

/// The name of --checkpoint. A film is one file that grows, so of the placeholders only {seed} has one value.
std::string film_name(const Options& options) {
    const std::string& name = options.film_file.checkpoint_path;
    try {
        const std::string film = expand_file_name(name, {options.sampling.seed, 0, 1});
        if (film != expand_file_name(name, {options.sampling.seed, 1, 2}))
            throw UsageError("expected no placeholder but {seed}, found '" + name + "'");
        return film;
    } catch (const UsageError& error) {
        throw UsageError(std::string("option --checkpoint: ") + error.what());
    }
}

/// A render of minutes must not end in "no such folder".
void check_folders(const Options& options) {
    const auto check = [&](const std::string& name) {
        if (!name.empty())
            check_output_folder(expand_file_name(name, {options.sampling.seed, 0, 1}));
    };
    check(options.output.stats_path);
    if (options.run.pixel) // writes nothing else
        return;
    for (const std::string& path : options.output.files)
        check(path);
    if (!options.film_file.checkpoint_path.empty())
        check_output_folder(options.film_file.checkpoint_path);
}

/// True for a picture of one sample a pixel that no film file keeps: there is nothing to compare it with and
/// nothing to merge it with, and sums of replicates without samples would take longer to empty and to read
/// than many a picture to render. The random numbers of sample 0 are the same for any number of replicates.
bool needs_one_replicate(const Options& options) {
    const SamplingOptions& sampling = options.sampling;
    return sampling.spp == 1u && sampling.first_sample == 0 && !sampling.error && !sampling.adaptive &&
           options.film_file.checkpoint_path.empty() && !options.run.pixel &&
           options.run.ledger == LedgerOf::NOTHING && !options.run.given.count("--replicates");
}

/// Every picture of a turn gets a name of its own.
void number_names(Options& options) {
    for (std::string& path : options.output.files)
        path = with_frame_number(path);
    if (!options.output.stats_path.empty())
        options.output.stats_path = with_frame_number(options.output.stats_path);
}

} // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
    // Split the command line; help and version need nothing else.
    Arguments arguments = split_arguments(argc, argv);
    CommandLine result;
    if (is_given(arguments.options, "--help"))
        result.print = help_text(help_columns());
    else if (is_given(arguments.options, "--version"))
        result.print = version_text();
    if (result.print)
        return result;
    reject_exclusive(arguments.options);

    // A film without a scene brings its own command, but not the place of its film: it may be a copy.
    const bool names_checkpoint = is_given(arguments.options, "--checkpoint");
    if (arguments.scenes.empty() && is_given(arguments.options, "--resume"))
        arguments = continue_command(arguments);

    // Read the options file beside the scene, less what the command line overrules.
    Options& options = result.options;
    options.run.command.assign(argv, argv + argc);
    options.run.resumable_command = resumable_command(arguments);
    const bool list_devices = is_given(arguments.options, "--list-devices");
    options.scene.path = only_scene(arguments.scenes, list_devices);
    if (!list_devices && !is_given(arguments.options, "--no-sidecar") &&
        !is_standard_input(options.scene.path))
        options.run.sidecar_path = find_options_file(options.scene.path);
    std::vector<GivenOption> given;
    if (!options.run.sidecar_path.empty()) {
        given = read_options_file(options.run.sidecar_path);
        reject_exclusive(given);
        given.erase(
            std::remove_if(given.begin(), given.end(),
                           [&](const GivenOption& line) { return overruled(line, arguments.options); }),
            given.end());
    }
    given.insert(given.end(), arguments.options.begin(), arguments.options.end());

    // Understand the values (the last one counts unless they make a list), fill in the picture's name, and
    // see whether all of it fits together and can be written.
    options.transport.choose = Toggle::AUTO; // unless --integrator says
    for (const GivenOption& option : given) {
        option.spec->apply(options, option.value);
        const std::string& origin = option.value.origin; // "file:line: "
        options.run.given[option.value.option] = origin.substr(0, origin.find_last_not_of(": ") + 1);
    }
    if (options.output.files.empty() && !options.scene.path.empty())
        options.output.files.push_back(literal_file_name(
            std::filesystem::path(input_name(options.scene.path)).stem().string() + ".png"));
    options.film_file.checkpoint_path = options.film_file.resume_path.empty() || names_checkpoint
                                            ? film_name(options)
                                            : options.film_file.resume_path;
    // A ledger's compile seconds are those of a first start; its samples are its own unless the command line
    // says how many.
    if (options.run.ledger != LedgerOf::NOTHING && options.device.cache == Toggle::AUTO)
        options.device.cache = Toggle::OFF;
    if (options.run.ledger != LedgerOf::NOTHING && !is_given(arguments.options, "--spp"))
        options.sampling.spp.reset();
    if (options.run.ledger != LedgerOf::NOTHING && !is_given(arguments.options, "--time"))
        options.sampling.time_seconds.reset();
    check_combinations(options);
    if (needs_one_replicate(options))
        options.sampling.replicates = 1;
    if (options.camera.frames)
        number_names(options);
    if (!options.scene.path.empty() && !list_devices && options.run.explain == Explain::NO)
        check_folders(options);
    return result;
}

} // namespace clrt
