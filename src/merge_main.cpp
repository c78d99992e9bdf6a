// SPDX-License-Identifier: Apache-2.0
// clrt-merge: film files of disjoint sample ranges -> one picture or film, with the bits of a single run.
#include "app/log.h"
#include "app/look_option.h"
#include "app/run_program.h"
#include "console/signals.h"
#include "error.h"
#include "exit_code.h"
#include "film/checkpoint.h"
#include "film/merge_films.h"
#include "output/exposure.h"
#include "output/image.h"
#include "output/standard_streams.h"
#include "output/written_files.h"
#include "render/error_text.h"
#include "render/film_picture.h"
#include "run/saving.h"

#include <algorithm>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <new>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// What the command line asks for.
struct MergeOptions {
    std::vector<std::string> films, outputs;
    std::string stats;
    std::string exposure = "0", tonemap = "none";
    bool quiet = false, force = false, help = false, version = false;
};

bool is_film_path(const std::string& path) {
    return path.size() > 5 && path.compare(path.size() - 5, 5, ".film") == 0;
}

/// What the command line says about 8-bit pictures.
Options look_of(const MergeOptions& merge) {
    Options options;
    apply_exposure(options, {"--exposure", merge.exposure, "", ""});
    apply_tonemap(options, {"--tonemap", merge.tonemap, "", ""});
    return options;
}

/// In the layout of clrt's own, from which the man page is made.
std::string help_text() {
    return fmt::format(R"(Usage: clrt-merge a.film b.film ... -o out.exr

Merges film files of one scene, rendered by `clrt --checkpoint` with the same options and disjoint
ranges of samples (--first-sample), in any order: the picture has the bits of a single run.

It knows no scene, and so cannot denoise; `clrt --resume sum.film --denoise -o a.exr hall.obj` can.

Example:
  clrt -s 32 --first-sample 0 --checkpoint a.film hall.obj
  clrt -s 32 --first-sample 32 --checkpoint b.film hall.obj
  clrt-merge a.film b.film -o hall.exr

Options:
  -o, --output FILE            picture ({})
                               or .film; png:-, exr:- and so on for the standard output; repeatable
      --exposure auto|EV       {}
      --tonemap NAME           {}
      --force                  let a .film replace what is there, be it a film of more samples, one
                               of another scene, or no film
      --stats FILE             write samples, their ranges and the error as JSON, in SI units
  -q, --quiet                  errors only
  -h, --help                   print this page and exit
      --version                print the version and exit

Exit codes:
  0    every output is written
  1    a film cannot be read, or films do not belong together
  2    wrong command line, or an output that would replace a film
)",
                       OUTPUT_EXTENSIONS, EXPOSURE_HELP, TONEMAP_HELP);
}

void declare(CLI::App& app, MergeOptions& options) {
    app.set_help_flag();
    app.add_flag("-h,--help", options.help);
    app.add_option("films", options.films);
    app.add_option("-o,--output", options.outputs)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--exposure", options.exposure);
    app.add_option("--tonemap", options.tonemap);
    app.add_flag("--force", options.force);
    app.add_option("--stats", options.stats);
    app.add_flag("-q,--quiet", options.quiet);
    app.add_flag("--version", options.version);
}

void check(const MergeOptions& options) {
    if (options.films.empty() || (options.outputs.empty() && options.stats.empty()))
        throw UsageError("expected clrt-merge a.film b.film ... -o out.exr; `clrt-merge --help` says more");
    for (const std::string& path : options.outputs) {
        if (!is_film_path(path))
            check_output_path(path);
        check_output_folder(path);
    }
    std::vector<NamedFile> read, written;
    for (const std::string& path : options.films)
        read.push_back({"the film", path});
    for (const std::string& path : options.outputs)
        written.push_back({"--output", path});
    if (!options.stats.empty()) {
        check_output_folder(options.stats);
        written.push_back({"--stats", options.stats});
    }
    check_written_files(written, read);
    for (const std::string& path : options.outputs)
        prepare_output(path);
}

/// Throws UsageError where an output is a film that holds what the merged one lacks.
void check_replaced_films(const MergeOptions& options, const FilmFile& film) {
    for (const std::string& path : options.outputs)
        if (const auto obstacle = is_film_path(path) && !options.force
                                      ? replacement_obstacle(path, {film.identity, film.render.film.ranges})
                                      : std::nullopt)
            throw UsageError(fmt::format("option --output: '{}' cannot be replaced: {}; --force replaces it",
                                         path, *obstacle));
}

/// What --stats writes.
std::string merge_json(const FilmFile& sum, const ErrorReport& error, size_t films) {
    nlohmann::ordered_json json;
    json["version"] = CLRT_VERSION;
    json["films"] = films;
    json["spp"] = film_samples(sum.render.film);
    json["ranges"] = nlohmann::ordered_json::array();
    for (const SampleRange& range : sum.render.film.ranges)
        json["ranges"].push_back({range.first, range.end});
    json["seconds"] = sum.render.seconds;
    json["error"] = error_report_json(error);
    json["unmet"] = unmet_json(error.unmet);
    return json.dump(2) + "\n";
}

/// Returns the exit code.
int merge(const MergeOptions& options, const Options& look) {
    // One film after the other: two are in memory at a time.
    FilmFile sum = read_film_file(options.films.front());
    std::string names = options.films.front();
    for (size_t i = 1; i < options.films.size(); ++i) {
        merge_film(sum, names, read_film_file(options.films[i]), options.films[i]);
        names = i == 1 ? names + " and " + options.films[i]
                       : fmt::format("{} and {} more", options.films.front(), i);
    }
    const Film& film = sum.render.film;
    for (size_t i = 1; i < film.ranges.size(); ++i)
        spdlog::warn("samples {} to {} are in no film", film.ranges[i - 1].end, film.ranges[i].first - 1);

    check_replaced_films(options, sum);
    const Picture picture = film_picture(sum);
    const double exposure_ev = chosen_exposure_ev(look.output, picture.layers[0].values);
    if (look.output.auto_exposure)
        spdlog::info("{}", exposure_notice(exposure_ev));
    warn_of_lost_alpha(picture, options.outputs);
    FinalFiles files;
    for (const std::string& path : options.outputs)
        files.write(path, [&] {
            if (is_film_path(path))
                write_film_file(path, sum);
            else
                write_picture(picture, path, exposure_ev, look.output.tonemap);
        });
    const ErrorReport error = make_error_report(sum.render, sum.bias, picture.x0, picture.y0);
    if (!options.stats.empty())
        files.write(options.stats,
                    [&] { write_text_file(options.stats, merge_json(sum, error, options.films.size())); });
    const int exit_code = files.complete() ? EXIT_DONE : EXIT_SCENE;
    if (options.quiet)
        return exit_code;
    const bool is_piped = std::any_of(options.outputs.begin(), options.outputs.end(), is_standard_output);
    fmt::print(is_piped ? stderr : stdout, "{} x {}, {} spp of {} films, {:.1f} s of rendering\n{}",
               film.width, film.height, film_samples(film), options.films.size(), sum.render.seconds,
               format_error_report(error));
    return exit_code;
}

int run(int argc, const char* const* argv) {
    MergeOptions options;
    CLI::App app;
    declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        throw UsageError(std::string(error.what()) + "; `clrt-merge --help` lists all options");
    }
    if (options.help) {
        fmt::print("{}", help_text());
        return EXIT_DONE;
    }
    if (options.version) {
        fmt::print("clrt-merge {}\n", CLRT_VERSION);
        return EXIT_DONE;
    }
    start_log(options.quiet ? -1 : 0, "clrt-merge");
    report_failed_writes();
    check(options);
    return merge(options, look_of(options));
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    return run_program("clrt-merge", [&] { return run(argc, argv); });
}
