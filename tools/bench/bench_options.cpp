// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_options.h"

#include "app/command_line.h"
#include "app/nearest_name.h"
#include "app/option_table.h"
#include "error.h"
#include "kernels/shared/render_types.h"
#include "output/image.h"

#include <algorithm>
#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

constexpr std::int64_t LARGEST_ROUNDS = 10000;
/// Rays of a kind: 32 bytes each, three arrays of them at a time.
constexpr std::int64_t LARGEST_RAYS = std::int64_t(1) << 26;
/// Aimed rays; a year on a fast machine.
constexpr std::int64_t LARGEST_AIMED_RAYS = std::int64_t(1) << 50;

/// One option; a flag has no value name.
struct BenchOption {
    const char* name;
    const char* value_name;
    const char* help;
    void (*apply)(BenchOptions&, const OptionValue&);
};

/// For options that mean what they mean to clrt.
void apply_as_clrt(BenchOptions& options, const OptionValue& value) {
    find_option(value.option)->apply(options.clrt, value);
}

void no_effect(BenchOptions&, const OptionValue&) {}

void choose_mode(BenchOptions& options, BenchMode mode) {
    if (options.mode != BenchMode::SPEED && options.mode != mode)
        throw UsageError("options --trees, --watertight and --robustness: expected one of them, found two");
    options.mode = mode;
}

std::string parse_isa(const OptionValue& value) {
    if (std::find(std::begin(EMBREE_ISAS), std::end(EMBREE_ISAS), value.text) == std::end(EMBREE_ISAS))
        reject_value(value, fmt::format("one of {}", fmt::join(EMBREE_ISAS, ", ")));
    return value.text;
}

void parse_aimed_rays(BenchOptions& options, const OptionValue& value) {
    if (!value.text.empty())
        options.aimed_rays = std::uint64_t(parse_whole(value, 1, LARGEST_AIMED_RAYS));
}

/// Every option once, in the order of --help.
const std::vector<BenchOption>& table() {
    static const std::vector<BenchOption> options = {
        {"--device", "NAME",
         "OpenCL device, as for clrt (default: CLRT_DEVICE, else the first GPU, else the CPU)",
         apply_as_clrt},
        {"--bvh", "NAME", "clrt's tree, as for clrt; auto is the fast one (default auto)", apply_as_clrt},
        {"--rounds", "N", "measurements of each side, taken in turns (default 9)",
         [](BenchOptions& o, const OptionValue& v) {
             o.rounds = std::uint32_t(parse_whole(v, 1, LARGEST_ROUNDS));
         }},
        {"--rays", "N", "rays of each kind (default 1048576)",
         [](BenchOptions& o, const OptionValue& v) {
             o.rays = std::uint32_t(parse_whole(v, 1, LARGEST_RAYS));
         }},
        {"--threads", "N", "CPU threads of both sides, 0 for all (default 0)", apply_as_clrt},
        {"--isa", "NAME",
         "Embree's instruction set: sse2, sse4.2, avx, avx2, avx512 (default: the best here)",
         [](BenchOptions& o, const OptionValue& v) { o.isa = parse_isa(v); }},
        {"--cpu-time", "",
         "take ratios of CPU seconds, not of wall seconds: for a machine that does other work too",
         [](BenchOptions& o, const OptionValue&) { o.cpu_time = true; }},
        {"--kernels", "DIR", "take clrt's kernels from here (default: those inside clrt-bench)",
         apply_as_clrt},
        {"--stats", "FILE", "write all figures as JSON, in SI units",
         [](BenchOptions& o, const OptionValue& v) { o.stats_path = parse_path(v); }},
        {"--no-sidecar", "", "leave the options file SCENE.clrt unread",
         [](BenchOptions& o, const OptionValue&) { o.no_sidecar = true; }},
        {"--trees", "", "compare the building of trees, in all qualities, and trace nothing",
         [](BenchOptions& o, const OptionValue&) { choose_mode(o, BenchMode::TREES); }},
        {"--watertight", "[=N]",
         "count the rays that leave closed meshes, of N aimed at edges (default 100000000)",
         [](BenchOptions& o, const OptionValue& v) {
             choose_mode(o, BenchMode::WATERTIGHT);
             parse_aimed_rays(o, v);
         }},
        {"--robustness", "[=N]",
         "compare the watertight kernels with plain ones, with N aimed rays (default 4000000)",
         [](BenchOptions& o, const OptionValue& v) {
             choose_mode(o, BenchMode::ROBUSTNESS);
             parse_aimed_rays(o, v);
         }},
        {"--help", "", "print this page and exit", no_effect},
        {"--version", "", "print the version and exit", no_effect},
    };
    return options;
}

/// Whether the option takes no value, or one only after '='.
bool is_flag(const BenchOption& option) {
    return option.value_name[0] == '\0' || option.value_name[0] == '[';
}

std::string help_page() {
    std::string page = "Usage: clrt-bench [options] scene.obj...\n"
                       "       clrt-bench [options] --trees scene.obj...\n"
                       "       clrt-bench [options] --watertight[=N]\n"
                       "       clrt-bench [options] --robustness[=N] [scene.obj...]\n\n"
                       "Traces the same rays through the same triangles by clrt's kernels and by Embree, in "
                       "turns, and prints how\n"
                       "fast each was: rays from the camera (primary), and from where they hit to lights "
                       "(shadow), in directions\n"
                       "of the first diffuse bounce (diffuse) and of reflection (mirror). A ratio above 1: "
                       "clrt is faster. Hits that\n"
                       "differ are judged by all triangles in double precision.\n\n"
                       "The SAH cost of a tree is the number of nodes and leaves that a random ray is "
                       "expected to test. For\n"
                       "Embree it is that of a tree by its builder (rtcBuildBVH) of the same children a "
                       "node and triangles a leaf:\n"
                       "what is inside its scenes cannot be seen. --trees compares all qualities of both "
                       "builders.\n\n"
                       "--watertight and --robustness aim rays exactly at vertices and edges of closed "
                       "meshes. The latter tells what\n"
                       "clrt's watertight triangle test and padded boxes cost against plain ones, and what "
                       "those lose.\n\nOptions:\n";
    for (const BenchOption& option : table())
        page += fmt::format("  {:<18} {}\n",
                            std::string(option.name) + (is_flag(option) ? "" : " ") + option.value_name,
                            option.help);
    page += "\nExit codes:\n"
            "  0    done\n"
            "  1    scene, input or output file, or host memory\n"
            "  2    wrong command line or options file\n"
            "  3    no such device, its compiler failed, or it lacks memory\n"
            "  4    a check failed: a ray of clrt was wrong or lost\n";
    return page;
}

[[noreturn]] void reject_unknown(const std::string& given) {
    std::vector<std::string> names;
    for (const BenchOption& option : table())
        names.emplace_back(option.name);
    const std::string name = given.substr(0, given.find('='));
    const std::string nearest = nearest_name(name, names);
    const std::string hint = is_misspelling(name, nearest) ? "the nearest is " + nearest + ", and " : "";
    throw UsageError(fmt::format("unknown option {}; {}`clrt-bench --help` lists all", name, hint));
}

/// Collects the texts of every option by CLI11; gives what is no option.
std::vector<std::string> split(int argc, const char* const* argv,
                               std::vector<std::vector<std::string>>& texts) {
    CLI::App app;
    app.set_help_flag();
    app.allow_extras();
    std::vector<std::string> scenes;
    for (size_t i = 0; i < table().size(); ++i)
        if (is_flag(table()[i]))
            app.add_flag(table()[i].name, texts[i]);
        else
            app.add_option(table()[i].name, texts[i])
                ->expected(1)
                ->allow_extra_args(false)
                ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("scene", scenes);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError&) { // the only one left: the last option lacks its value
        throw UsageError(
            fmt::format("option {}: expected a value, found the end of the command line", argv[argc - 1]));
    }
    for (const std::string& rest : app.remaining())
        if (rest != "--")
            reject_unknown(rest);
    return scenes;
}

/// CLI11 hands a flag "true" when it stands alone and its text after '=' otherwise.
void apply_option(BenchOptions& options, const BenchOption& option, const std::string& text) {
    const bool stands_alone = is_flag(option) && text == "true";
    if (option.value_name[0] == '\0' && !stands_alone)
        throw UsageError(fmt::format("option {} takes no value, found '{}'", option.name, text));
    option.apply(options, {option.name, stands_alone ? "" : text, "", ""});
}

/// Sides of a picture with about so many pixels and whole tiles.
glm::ivec2 size_for_rays(std::uint32_t rays, double aspect) {
    const double height = std::sqrt(double(rays) / aspect);
    const auto whole_tiles = [](double side) {
        return std::max(1, int(std::lround(side / TILE_SIZE))) * TILE_SIZE;
    };
    const int tiles_high = whole_tiles(height);
    return {whole_tiles(double(rays) / tiles_high), tiles_high};
}

} // namespace

BenchOptions parse_bench_options(int argc, const char* const* argv) {
    std::vector<std::vector<std::string>> texts(table().size());
    BenchOptions options;
    options.command.assign(argv, argv + argc);
    options.scenes = split(argc, argv, texts);
    for (size_t i = 0; i < table().size(); ++i) {
        const std::string name = table()[i].name;
        if (!texts[i].empty() && name == "--help")
            options.print = help_page();
        if (!texts[i].empty() && name == "--version")
            options.print = "clrt-bench " CLRT_VERSION "\n";
    }
    if (options.print)
        return options;
    for (size_t i = 0; i < table().size(); ++i)
        for (const std::string& text : texts[i])
            apply_option(options, table()[i], text);
    if (options.mode == BenchMode::WATERTIGHT && !options.scenes.empty())
        throw UsageError("--watertight makes its own meshes: expected no scene, found '" + options.scenes[0] +
                         "'");
    if (options.mode == BenchMode::TREES && options.clrt.bvh.quality)
        throw UsageError(
            fmt::format("--trees builds every quality: expected only a layout after --bvh, found '{}'",
                        name_of(*options.clrt.bvh.quality)));
    if ((options.mode == BenchMode::SPEED || options.mode == BenchMode::TREES) && options.scenes.empty())
        throw UsageError(
            "expected a scene: clrt-bench [options] scene.obj...; `clrt-bench --help` lists the options");
    if (!options.stats_path.empty())
        check_output_folder(options.stats_path);
    return options;
}

Options scene_options(const BenchOptions& bench, const std::string& scene) {
    Options options;
    if (!scene.empty()) {
        // --explain: nothing will be written, so no output folder is needed.
        std::vector<const char*> arguments{"clrt-bench", "--explain"};
        if (bench.no_sidecar)
            arguments.push_back("--no-sidecar");
        arguments.insert(arguments.end(), {"--", scene.c_str()});
        options = parse_command_line(int(arguments.size()), arguments.data()).options;
    }
    options.light.studio = false;          // its ground is not of the scene
    options.scene.instances = Toggle::OFF; // one tree, as the others have it
    options.device.name = bench.clrt.device.name;
    options.bvh.layout = bench.clrt.bvh.layout;
    // The fast tree, as clrt builds it for most renders, unless the other is asked for.
    options.bvh.quality = bench.clrt.bvh.quality.value_or(BvhQuality::FAST);
    options.device.threads = bench.clrt.device.threads;
    options.device.kernels_folder = bench.clrt.device.kernels_folder;
    options.device.precision = Precision::SINGLE;
    options.film.crop.reset();
    options.film.size = size_for_rays(bench.rays, double(options.film.size.x) / double(options.film.size.y));
    return options;
}

} // namespace clrt
