// SPDX-License-Identifier: Apache-2.0
// clrt: command line -> scene -> effects -> tree and program -> passes -> picture and report.
#include "app/command_line.h"
#include "app/log.h"
#include "app/run_program.h"
#include "console/progress.h"
#include "console/signals.h"
#include "device/device.h"
#include "device/device_facts.h"
#include "device/driver_cache_folder.h"
#include "effects/explain.h"
#include "effects/planned_scene.h"
#include "exit_code.h"
#include "output/file_name.h"
#include "output/image.h"
#include "render/integrator_choice.h"
#include "render/ledger.h"
#include "render/portal_choice.h"
#include "render/prepared_scene.h"
#include "render/sky_choice.h"
#include "replay/replay_pixel.h"
#include "run/render_command.h"
#include "run/run_files.h"
#include "run/start.h"
#include "scene/load_scene.h"

#include <fmt/format.h>
#include <memory>
#include <spdlog/spdlog.h>
#include <utility>

namespace clrt {

namespace {

/// Prints what would be rendered and why: materials as they are, paths as they would be rendered.
int run_explain(Options options) {
    Progress progress(options.run.progress, options.run.verbosity < 0);
    const Scene scene = load_scene(options, progress);
    options.film.size = scene.picture_size.value_or(options.film.size);
    progress.finish();
    fmt::print("{}", explain(scene, plan_scene(scene, options)->effects, options));
    return EXIT_DONE;
}

/// Writes --stats of a run without a picture, which has no samples to be named by.
void write_statistics(const Options& options, const std::string& json) {
    if (!options.output.stats_path.empty())
        write_text_file(expand_file_name(options.output.stats_path, {options.sampling.seed, 0, 0}), json);
}

/// Prints what every effect costs and gives.
int run_ledger(Options options) {
    const Device device = open_chosen_device(options);
    Progress progress(options.run.progress, options.run.verbosity < 0);
    const Scene scene = load_for_run(options, progress);
    const Ledger ledger = make_ledger(device, scene, options, progress);
    progress.finish();
    print_report(options, format_ledger(ledger, options, device.info));
    write_statistics(options, ledger_json(ledger, options, device.info));
    return EXIT_DONE;
}

/// Prints the path of one sample.
int run_replay(Options options) {
    const Device device = open_chosen_device(options);
    Progress progress(options.run.progress, options.run.verbosity < 0);
    Scene scene = load_for_run(options, progress);
    if (options.run.given.count("--output"))
        spdlog::info("--pixel replays a sample: no picture is written");
    const auto planned = plan_scene(std::move(scene), options);
    PreparedParts parts;
    choose_portals(device, planned, parts, progress);
    choose_integrator(device, planned, parts, progress);
    choose_sky_table(device, planned, parts, progress);
    const PreparedScene prepared = prepare_scene(device, planned, {parts.tree, nullptr});
    const PixelReplay replay = replay_pixel(prepared);
    print_report(options, replay.text);
    write_statistics(options, replay.json);
    return EXIT_DONE;
}

int run(int argc, const char* const* argv) {
    const CommandLine command = parse_command_line(argc, argv);
    if (command.print) {
        fmt::print("{}", *command.print);
        return EXIT_DONE;
    }
    const Options& options = command.options;
    set_driver_environment(options.device);
    const auto cache_of_run =
        options.device.cache == Toggle::OFF ? DriverCacheFolder::make_for_uncached_run() : nullptr;
    start_log(options.run.verbosity);
    if (options.run.list_devices) {
        const std::vector<PlatformInfo> platforms = list_platforms();
        fmt::print("{}", format_device_table(platforms));
        if (options.run.verbosity > 0)
            fmt::print("{}", format_facts(platforms, {options.device.cache, options.device.cache_folder}));
        return EXIT_DONE;
    }
    if (!options.run.sidecar_path.empty())
        spdlog::info("options file: {}", options.run.sidecar_path);
    if (options.run.explain != Explain::NO) // has nothing to save
        return run_explain(options);
    catch_stop_signals(options.run.verbosity < 0);
    report_failed_writes();
    if (options.run.pixel)
        return run_replay(options);
    return options.run.ledger != LedgerOf::NOTHING ? run_ledger(options) : run_render(options);
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    return run_program("clrt", [&] { return run(argc, argv); });
}
