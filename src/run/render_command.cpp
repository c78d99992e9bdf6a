// SPDX-License-Identifier: Apache-2.0
#include "run/render_command.h"

#include "console/progress.h"
#include "effects/effects.h"
#include "effects/take_out.h"
#include "exit_code.h"
#include "render/dark_picture.h"
#include "render/render_params.h"
#include "run/report.h"
#include "run/run_files.h"
#include "run/saving.h"
#include "run/simulate.h"
#include "run/start.h"
#include "run/turntable.h"
#include "seconds.h"

#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// The exit code of a finished run, and the warning that goes with it.
int finish(const Report& report) {
    const Render& render = report.render;
    if (report.options.run.check != Check::OFF && render.counts.bad() > 0)
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
    const bool missed =
        report.options.sampling.error && film_samples(render.film) > 0 && !error_reached(report);
    if (missed)
        spdlog::warn("--error {:g} % is not reached", 100 * *report.options.sampling.error);
    if (report.options.run.check == Check::STRICT && render.counts.bad() > 0)
        return EXIT_CHECK;
    return missed ? EXIT_ERROR_NOT_REACHED : EXIT_DONE;
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
        files.write(options.film_file.checkpoint_path, [&] { saving.write_film(render); });

    const Crop window = render_window(options.film);
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
    const bool is_frame = options.camera.frame > 0 && options.run.verbosity == 0;
    if (options.run.verbosity >= 0)
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
    for (options.camera.frame = 1; options.camera.frame <= *options.camera.frames; ++options.camera.frame) {
        job.scene.camera = turned_camera(camera, options.camera.frame, *options.camera.frames);
        exit_code = graver_exit(exit_code, render_picture(job, options, progress, done));
        if (done->render.stop_signal)
            break;
    }
    return exit_code;
}

} // namespace

int run_render(Options options) {
    const auto start = std::chrono::steady_clock::now();
    check_checkpoint(options);
    const Device device = open_chosen_device(options);
    Progress progress(options.run.progress, options.run.verbosity < 0);
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
                     name_of(options.transport.integrator), spot.paths, spot.cause);
    Job job{start, device, std::move(scene), std::move(effects), load_seconds};
    if (options.camera.frames)
        return render_turn(job, options, progress);
    std::optional<Simulation> done;
    return render_picture(job, options, progress, done);
}

} // namespace clrt
