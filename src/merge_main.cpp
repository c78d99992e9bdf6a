// SPDX-License-Identifier: Apache-2.0
// clrt-merge: film files of disjoint sample ranges -> one picture or film, with the bits of a single run.
#include "app/log.h"
#include "app/run_program.h"
#include "error.h"
#include "exit_code.h"
#include "output/image.h"
#include "render/error_text.h"
#include "render/merge_films.h"
#include "run/saving.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <new>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// What the command line asks for.
struct MergeOptions {
    std::vector<std::string> films, outputs;
    double exposure_ev = 0;
    std::string tonemap = "none";
    bool quiet = false, help = false, version = false;
};

bool is_film_path(const std::string& path) {
    return path.size() > 5 && path.compare(path.size() - 5, 5, ".film") == 0;
}

Tonemap tonemap_named(const std::string& name) {
    return name == "reinhard" ? Tonemap::REINHARD : name == "aces" ? Tonemap::ACES : Tonemap::NONE;
}

/// In the layout of clrt's own, from which the man page is made.
std::string help_text() {
    return fmt::format(R"(Usage: clrt-merge a.film b.film ... -o out.exr

Merges film files of one scene, rendered by `clrt --checkpoint` with the same options and disjoint
ranges of samples (--first-sample), in any order: the picture has the bits of a single run.

Example:
  clrt -s 32 --checkpoint a.film hall.obj
  clrt -s 32 --first-sample 32 --checkpoint b.film hall.obj
  clrt-merge a.film b.film -o hall.exr

Options:
  -o, --output FILE            picture ({})
                               or .film; repeatable
      --exposure EV            brighten 8-bit pictures by 2^EV (default 0)
      --tonemap NAME           curve of 8-bit pictures: none, reinhard or aces (default none)
  -q, --quiet                  errors only
  -h, --help                   print this page and exit
      --version                print the version and exit

Exit codes:
  0    every output is written
  1    a film cannot be read, or films do not belong together
  2    wrong command line
)",
                       OUTPUT_EXTENSIONS);
}

void declare(CLI::App& app, MergeOptions& options) {
    app.set_help_flag();
    app.add_flag("-h,--help", options.help);
    app.add_option("films", options.films);
    app.add_option("-o,--output", options.outputs)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--exposure", options.exposure_ev)->check(CLI::Range(-100.0, 100.0));
    app.add_option("--tonemap", options.tonemap)->check(CLI::IsMember({"none", "reinhard", "aces"}));
    app.add_flag("-q,--quiet", options.quiet);
    app.add_flag("--version", options.version);
}

void check(const MergeOptions& options) {
    if (options.films.empty() || options.outputs.empty())
        throw UsageError("expected clrt-merge a.film b.film ... -o out.exr; `clrt-merge --help` says more");
    for (const std::string& path : options.outputs) {
        if (!is_film_path(path))
            check_output_path(path);
        check_output_folder(path);
    }
}

void merge(const MergeOptions& options) {
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

    const Picture picture = film_picture(sum);
    FinalFiles files;
    for (const std::string& path : options.outputs)
        files.write(path, [&] {
            if (is_film_path(path))
                write_film_file(path, sum);
            else
                write_picture(picture, path, options.exposure_ev, tonemap_named(options.tonemap));
        });
    files.finish();
    if (options.quiet)
        return;
    fmt::print("{} x {}, {} spp of {} films, {} s of rendering\n", film.width, film.height,
               film_samples(film), options.films.size(), fmt::format("{:.1f}", sum.render.seconds));
    fmt::print("{}", format_error_report(make_error_report(sum.render, sum.bias, picture.x0, picture.y0)));
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
    start_log(options.quiet ? -1 : 0);
    check(options);
    merge(options);
    return EXIT_DONE;
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    return run_program("clrt-merge", [&] { return run(argc, argv); });
}
