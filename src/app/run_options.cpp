// SPDX-License-Identifier: Apache-2.0
// The options of the group "Runs".
#include "app/option_rows.h"
#include "app/view_option.h"
#include "output/standard_streams.h"

#include <cctype>

namespace clrt {

namespace {

void no_effect(Options&, const OptionValue&) {}

/// FILE or FILE,DURATION: a comma in the name counts where no digit follows it.
void apply_checkpoint(Options& o, const OptionValue& v) {
    const size_t comma = v.text.rfind(',');
    const bool has_interval = comma != std::string::npos && comma + 1 < v.text.size() &&
                              std::isdigit(static_cast<unsigned char>(v.text[comma + 1]));
    OptionValue path = v, interval = v;
    path.text = has_interval ? v.text.substr(0, comma) : v.text;
    o.film_file.checkpoint_path = parse_path(path);
    if (is_standard_output(path.text))
        reject_value(v, "a file: films are read again, the standard output is not");
    o.film_file.checkpoint_seconds = DEFAULT_CHECKPOINT_SECONDS;
    if (!has_interval)
        return;
    interval.text = v.text.substr(comma + 1);
    o.film_file.checkpoint_seconds = parse_duration(interval);
}

} // namespace

std::vector<OptionSpec> run_options() {
    const char* const group = "Runs";
    return {
        {group, "", "--checkpoint", "FILE[,TIME]",
         "write a film file, from which --resume goes on and which clrt-merge merges, at the end and so "
         "often; what is there already asks for --resume or --force (default: none, or the film of --resume; "
         "every 5m)",
         apply_checkpoint},
        {group, "", "--resume", "FILE",
         "go on from a film file and write it anew: with the same command, or alone with another --spp, "
         "--time or --error, and then without the -q, -v, --progress and --checkpoint of its command",
         [](Options& o, const OptionValue& v) { o.film_file.resume_path = parse_path(v); }, Repeat::NO,
         COMMAND_LINE_ONLY},
        {group, "", "--force", "",
         "let --checkpoint replace what is there, be it a film of more samples, one of another scene, or "
         "no film",
         [](Options& o, const OptionValue&) { o.film_file.force = true; }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "", "--save-every", "DURATION",
         "write the pictures so far so often (default: at the end only)",
         [](Options& o, const OptionValue& v) { o.output.save_every_seconds = parse_duration(v); }},
        {group, "", "--serve", "PORT[,stay]", SERVE_HELP, apply_serve, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "", "--display-server", "HOST:PORT", DISPLAY_SERVER_HELP, apply_display_server, Repeat::NO,
         COMMAND_LINE_ONLY},
        {group, "", "--kernels", "DIR", "take the kernels from here (default: those inside clrt)",
         [](Options& o, const OptionValue& v) { o.device.kernels_folder = parse_path(v); }},
        {group, "", "--dump-kernels", "DIR", "write here exactly what is compiled",
         [](Options& o, const OptionValue& v) { o.device.dump_folder = parse_path(v); }},
        {group, "", "--cache", "MODE",
         "keep compiled kernels: on; auto: unless the driver does; off: neither (default auto)",
         [](Options& o, const OptionValue& v) { o.device.cache = parse_choice<Toggle>(v); }},
        {group, "", "--no-cache", "", "same as --cache off",
         [](Options& o, const OptionValue&) { o.device.cache = Toggle::OFF; }},
        {group, "", "--cache-dir", "DIR", "where to keep them (default: clrt in the user's cache folder)",
         [](Options& o, const OptionValue& v) { o.device.cache_folder = parse_path(v); }},
        {group, "", "--progress", "MODE",
         "auto (a line on a terminal, else one now and then), on, off (default auto)",
         [](Options& o, const OptionValue& v) { o.run.progress = parse_choice<Toggle>(v); }},
        {group, "q", "--quiet", "", "errors only, no progress",
         [](Options& o, const OptionValue&) { o.run.verbosity = -1; }},
        {group, "v", "--verbose", "", "say everything: the report too",
         [](Options& o, const OptionValue&) { o.run.verbosity = 1; }},
        {group, "", "--no-sidecar", "", "leave the options file SCENE.clrt unread",
         [](Options& o, const OptionValue&) { o.run.no_sidecar = true; }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "h", "--help", "", "print this page and exit", no_effect, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "", "--version", "", "print the version and exit", no_effect, Repeat::NO, COMMAND_LINE_ONLY},
    };
}

} // namespace clrt
