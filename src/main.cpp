// SPDX-License-Identifier: Apache-2.0
// clrt: command line -> scene -> effects -> tree and program -> passes -> picture and report.
#include "app/command_line.h"
#include "app/log.h"
#include "app/progress.h"
#include "app/run_program.h"
#include "app/signals.h"
#include "device/device.h"
#include "device/program_cache.h"
#include "effects/effects.h"
#include "effects/explain.h"
#include "effects/take_out.h"
#include "exit_code.h"
#include "output/image.h"
#include "render/dark_picture.h"
#include "render/ledger.h"
#include "render/render.h"
#include "render/render_params.h"
#include "render/report.h"
#include "replay/replay_pixel.h"
#include "run/run_files.h"
#include "run/saving.h"
#include "run/simulate.h"
#include "run/turntable.h"
#include "scene/load_scene.h"

#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The device that the options name, open.
Device open_chosen_device(const Options& options) {
    const std::vector<PlatformInfo> platforms = list_platforms();
    std::string notice;
    const DeviceInfo info = choose_device(platforms, options.device, notice);
    for (const PlatformInfo& platform : platforms)
        if (!platform.note.empty())
            spdlog::log(platform.index == info.platform_index ? spdlog::level::warn : spdlog::level::debug,
                        "platform {}: {}", platform.name, platform.note);
    if (!notice.empty())
        spdlog::info("{}", notice);
    const ProgramCache cache{options.cache, options.cache_folder};
    if (const std::string obstacle = program_cache_obstacle(cache); !obstacle.empty())
        spdlog::warn(
            "The program cache's folder {} cannot be written ({}): what is compiled and measured is not "
            "kept for the next run; --cache-dir names another",
            program_cache_folder(cache), obstacle);
    return open_device(info);
}

/// The exit code of a finished run, and the warning that goes with it.
int finish(const Report& report) {
    const Render& render = report.render;
    if (report.options.check != Check::OFF && render.counts.bad() > 0)
        spdlog::warn(
            "{} samples were not finite, negative or too large and count as 0; see the causes in the "
            "report and `nonfinite` in the JSON of --stats",
            render.counts.bad());
    if (render.stop_signal) {
        spdlog::warn("stopped by a signal after {} spp; the picture is saved", film_samples(render.film));
        return 128 + render.stop_signal;
    }
    if (!render.hits_error.empty()) {
        spdlog::error("the picture was written without the layers of hits: {}", render.hits_error);
        return EXIT_DEVICE;
    }
    spdlog::info("ended after {} spp: {}", film_samples(render.film), render.stop_text);
    const bool missed = report.options.error && film_samples(render.film) > 0 && !error_reached(report);
    if (missed)
        spdlog::warn("--error {:g} % is not reached", 100 * *report.options.error);
    if (report.options.check == Check::STRICT && render.counts.bad() > 0)
        return EXIT_CHECK;
    return missed ? EXIT_ERROR_NOT_REACHED : EXIT_DONE;
}

/// The scene of a run, whose results are known not to replace what it was loaded from.
Scene load_for_run(const Options& options, Progress& progress) {
    Scene scene = load_scene(options, progress);
    progress.finish();
    check_run_files(options, scene);
    return scene;
}

/// Prints what would be rendered and why.
int run_explain(const Options& options) {
    Progress progress(options.progress, options.verbosity < 0);
    const Scene scene = load_scene(options, progress);
    progress.finish();
    Effects effects = find_effects(scene, options);
    if (effects.left_out) { // materials and effects as they are, paths as they would be rendered
        Scene reduced = scene;
        Options reduced_options = options;
        take_out_effects(effects.left_out, reduced, reduced_options);
        effects.paths = plan_paths(reduced, reduced_options);
    }
    fmt::print("{}", explain(scene, effects, options));
    return EXIT_DONE;
}

/// Prints what every effect costs and gives.
int run_ledger(const Options& options) {
    const Device device = open_chosen_device(options);
    Progress progress(options.progress, options.verbosity < 0);
    const Scene scene = load_for_run(options, progress);
    const Ledger ledger = make_ledger(device, scene, options, progress);
    progress.finish();
    print_report(options, format_ledger(ledger, options, device.info));
    if (!options.stats_path.empty())
        write_text_file(options.stats_path, ledger_json(ledger, options, device.info));
    return EXIT_DONE;
}

/// Prints the path of one sample.
int run_replay(const Options& options) {
    const Device device = open_chosen_device(options);
    Progress progress(options.progress, options.verbosity < 0);
    Scene scene = load_for_run(options, progress);
    if (options.given.count("--output"))
        spdlog::info("--pixel replays a sample: no picture is written");
    const PixelReplay replay = replay_pixel(device, std::move(scene), options);
    print_report(options, replay.text);
    if (!options.stats_path.empty())
        write_text_file(options.stats_path, replay.json);
    return EXIT_DONE;
}

/// What a picture needs, loaded and proved.
struct Job {
    std::chrono::steady_clock::time_point start;
    const Device& device;
    Scene scene;
    Effects effects;
    double load_seconds;
};

/// Renders, or renders again with the tree and the program that are there.
void simulate_job(const Job& job, const Options& options, Progress& progress, const RenderHooks& hooks,
                  std::optional<Simulation>& done) {
    if (job.effects.paths.is_empty)
        done = simulate_nothing(job.scene, job.effects, options);
    else if (!done)
        done = simulate(job.device, job.scene, job.effects, options, progress, hooks);
    else
        simulate_again(job.device, job.scene, job.effects, options, progress, hooks, *done);
}

/// One picture with its files and its report.
int render_picture(const Job& job, const Options& options, Progress& progress,
                   std::optional<Simulation>& done) {
    const DeviceInfo& device = job.device.info;
    const Saving saving(job.scene, job.effects.paths, options, device, progress);
    simulate_job(job, options, progress, saving.hooks, done);
    progress.finish();
    const Render& render = done->render;
    if (render.stop_signal && film_samples(render.film) == 0) {
        spdlog::warn("stopped by a signal before the first pass was complete: there is no picture");
        return 128 + render.stop_signal;
    }
    FinalFiles files;
    if (saving.needs_film(render))
        files.write(options.checkpoint_path, [&] { saving.write_film(render); });

    const Crop window = render_window(options);
    Report report{
        options,
        job.scene,
        job.effects,
        device,
        done->facts,
        done->bvh,
        render,
        make_error_report(render, bias_sources(job.scene, job.effects.paths, render), window.x0, window.y0),
        done->bvh_reason,
        done->causes,
        job.load_seconds,
        done->compile_seconds,
        seconds_since(job.start),
        0,
        explain_empty_picture(job.scene, options, render)};
    write_outputs(report, files);
    files.finish();
    const bool is_frame = options.frame > 0 && options.verbosity == 0;
    if (options.verbosity >= 0)
        print_report(options, is_frame ? format_frame(report) : format_report(report));
    if (report.empty_picture)
        spdlog::warn("{}", *report.empty_picture);
    return finish(report);
}

/// The pictures of --frames. The scene is loaded once, tree and program are made once.
int render_turn(Job& job, Options options, Progress& progress) {
    const Camera camera = job.scene.camera;
    std::optional<Simulation> done;
    int exit_code = EXIT_DONE;
    for (options.frame = 1; options.frame <= *options.frames; ++options.frame) {
        job.scene.camera = turned_camera(camera, options.frame, *options.frames);
        exit_code = graver_exit(exit_code, render_picture(job, options, progress, done));
        if (done->render.stop_signal)
            break;
    }
    return exit_code;
}

int run_render(Options options) {
    const auto start = std::chrono::steady_clock::now();
    check_checkpoint(options);
    const Device device = open_chosen_device(options);
    Progress progress(options.progress, options.verbosity < 0);
    Scene scene = load_for_run(options, progress);
    const double load_seconds = seconds_since(start);
    for (const std::string& notice : scene.notices)
        spdlog::info("{}", notice);
    Effects effects = find_effects(scene, options);
    for (const std::string& line : describe_left_out(effects))
        spdlog::warn("{}", line);
    take_out_effects(effects.left_out, scene, options);
    if (effects.left_out)
        effects.paths = plan_paths(scene, options);
    for (const BlindSpot& spot : effects.paths.blind_spots)
        spdlog::warn("{} does not see {} ({}); it sees lights that have an extent: emissive triangles, a sun "
                     "with a diameter",
                     integrator_name(options.integrator), spot.paths, spot.cause);
    Job job{start, device, std::move(scene), std::move(effects), load_seconds};
    if (options.frames)
        return render_turn(job, options, progress);
    std::optional<Simulation> done;
    return render_picture(job, options, progress, done);
}

int run(int argc, const char* const* argv) {
    const CommandLine command = parse_command_line(argc, argv);
    if (command.print) {
        fmt::print("{}", *command.print);
        return EXIT_DONE;
    }
    const Options& options = command.options;
    set_driver_environment(options);
    start_log(options.verbosity);
    if (options.list_devices) {
        const std::vector<PlatformInfo> platforms = list_platforms();
        fmt::print("{}", format_device_table(platforms));
        if (options.verbosity > 0)
            fmt::print("{}", format_facts(platforms, {options.cache, options.cache_folder}));
        return EXIT_DONE;
    }
    if (!options.sidecar_path.empty())
        spdlog::info("options file: {}", options.sidecar_path);
    if (options.explain != Explain::NO) // has nothing to save
        return run_explain(options);
    catch_stop_signals();
    report_broken_pipes();
    if (options.pixel)
        return run_replay(options);
    return options.ledger ? run_ledger(options) : run_render(options);
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    return run_program("clrt", [&] { return run(argc, argv); });
}
