// SPDX-License-Identifier: Apache-2.0
#include "run/render_command.h"

#include "console/progress.h"
#include "device/compile_ahead.h"
#include "exit_code.h"
#include "options/unread_options.h"
#include "render/dark_picture.h"
#include "render/guide_choice.h"
#include "render/light_samples_choice.h"
#include "render/portal_choice.h"
#include "render/render_params.h"
#include "render/reuse_choice.h"
#include "render/sky_choice.h"
#include "run/denoising.h"
#include "run/report.h"
#include "run/run_files.h"
#include "run/saving.h"
#include "run/simulate.h"
#include "run/start.h"
#include "run/turntable.h"
#include "seconds.h"
#include "view/viewers.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <spdlog/spdlog.h>
#include <string>
#include <utility>
#include <vector>

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
        spdlog::warn("stopped by a signal after {} spp{}", film_samples(render.film),
                     report.lost_files.empty() ? "; the picture is saved" : "");
        return 128 + render.stop_signal;
    }
    if (!render.hits_error.empty()) {
        spdlog::error("the picture was written without the layers of hits: {}", render.hits_error);
        return EXIT_DEVICE;
    }
    if (!render.denoise_error.empty()) {
        spdlog::error("the picture was written without a denoised one: {}", render.denoise_error);
        return EXIT_DEVICE;
    }
    spdlog::info("ended after {} spp: {}", film_samples(render.film), render.stop_text);
    const std::optional<ErrorTarget> target = error_target(report);
    const bool missed = target && film_samples(render.film) > 0 && !target->reached;
    if (missed)
        spdlog::warn("{}", missed_text(*target));
    if (report.options.run.check == Check::STRICT && render.counts.bad() > 0)
        return EXIT_CHECK;
    return missed ? EXIT_ERROR_NOT_REACHED : EXIT_DONE;
}

/// A scene to be rendered, once or turning.
struct Job {
    std::chrono::steady_clock::time_point start;
    const std::vector<Device>& devices;
    std::shared_ptr<PlannedScene> planned;
    IntegratorChoice choice;
    PreparedParts parts; ///< that are there before the render
    double load_seconds;
    double
        pilots_seconds; ///< with the programs that no picture needs, without the picture's program and tree
};

/// The report of a render, to which writing the pictures adds the exposure.
Report make_report(const Job& job, const Simulation& done, const SceneTree& tree) {
    const auto& [scene, options, effects] = *job.planned;
    const Crop window = render_window(options.film);
    const BiasSources bias = bias_sources(scene, effects.paths, done.render, options.transport.integrator);
    return {options,
            scene,
            effects,
            job.devices.front().info,
            done.facts,
            tree.bvh,
            done.render,
            make_error_report(done.render, bias, window.x0, window.y0, options.sampling.error),
            tree.reason,
            done.causes,
            job.load_seconds,
            job.pilots_seconds,
            done.prepared ? done.prepared->programs->seconds : 0,
            seconds_since(job.start),
            0,
            job.choice,
            explain_empty_picture(scene, options, done.render)};
}

/// One picture with its files and its report; prepares the scene for the first.
int render_picture(const Job& job, Progress& progress, Viewers& viewers, std::optional<Simulation>& done) {
    const Options& options = job.planned->options;
    const Saving saving(job.planned->scene, job.planned->effects.paths, options, job.devices.front().info,
                        progress);
    RenderHooks hooks = saving.hooks;
    hooks.observer = viewers.observer();
    if (!done)
        done.emplace(simulate(job.devices, job.planned, progress, hooks, job.parts));
    else
        simulate_again(progress, hooks, *done);
    progress.finish();
    const Render& render = done->render;
    if (render.stop_signal && film_samples(render.film) == 0) {
        spdlog::warn("stopped by a signal before the first pass was complete: there is no picture");
        return 128 + render.stop_signal;
    }
    viewers.show_finished(render, options);
    FinalFiles files;
    if (saving.needs_film(render))
        files.write(options.film_file.checkpoint_path, [&] { saving.write_film(render); });

    const std::vector<const PreparedScene*> scenes = working_scenes(*done);
    denoise_render(scenes.empty() ? job.devices.front() : scenes.front()->device, options, progress,
                   done->render);
    const SceneTree no_tree;
    Report report = make_report(job, *done, done->prepared ? *done->prepared->tree : no_tree);
    write_outputs(report, files);
    const bool is_frame = options.camera.frame > 0 && options.run.verbosity == 0;
    if (options.run.verbosity >= 0)
        print_report(options, is_frame ? format_frame(report) : format_report(report));
    if (report.empty_picture)
        spdlog::warn("{}", *report.empty_picture);
    const int exit_code = finish(report);
    return files.complete() ? exit_code : EXIT_SCENE;
}

/// The pictures of --frames, or the one of them that is asked for. The scene is loaded and prepared once.
int render_turn(const Job& job, Progress& progress, Viewers& viewers, std::optional<Simulation>& done) {
    const Camera camera = job.planned->scene.camera;
    CameraOptions& options = job.planned->options.camera;
    int exit_code = EXIT_DONE;
    const int first = std::max(options.frame, 1), last = options.frame > 0 ? options.frame : *options.frames;
    for (options.frame = first; options.frame <= last; ++options.frame) {
        job.planned->scene.camera = turned_camera(camera, options.frame, *options.frames);
        exit_code = graver_exit(exit_code, render_picture(job, progress, viewers, done));
        if (done->render.stop_signal)
            break;
    }
    return exit_code;
}

/// How a run ended, for those who see it.
std::string end_text(const Render& render) {
    const std::uint64_t samples = film_samples(render.film);
    if (samples == 0)
        return "stopped before the first pass was complete: there is no picture";
    return render.stop_signal
               ? fmt::format("stopped after {} samples a pixel; what there is is saved", samples)
               : fmt::format("done: {}", render.stop_text);
}

/// Says what the user should know before it is rendered.
void announce(const PlannedScene& planned) {
    for (const std::string& notice : planned.scene.notices)
        spdlog::info("{}", notice);
    for (const std::string& line : unread_options(planned.options))
        spdlog::info("{}", line);
    for (const std::string& line : describe_left_out(planned.effects))
        spdlog::warn("{}", line);
    for (const BlindSpot& spot : planned.effects.paths.blind_spots)
        spdlog::warn("{} does not see {} ({}){}", name_of(planned.options.transport.integrator), spot.paths,
                     spot.cause, spot.seen.empty() ? "" : "; it sees " + spot.seen);
}

/// The pilot, if there was one, of samples as the picture takes them without a guide. `reuse`: those that
/// decided path reuse; `is_other_sky`: the sky's table was chosen after the integrator.
std::optional<PathPilot> unguided_pilot(const Job& job, const std::optional<ReusePilots>& reuse,
                                        bool is_other_sky) {
    const TransportOptions& chosen = job.planned->options.transport;
    if (chosen.light_samples > 1)
        return std::nullopt;
    if (chosen.path_reuse == Toggle::ON)
        return reuse ? std::optional(reuse->reusing) : std::nullopt;
    return is_other_sky ? std::nullopt : job.choice.unguided;
}

/// Decides by pilots whatever the options leave open, and notes the seconds that they took.
void choose_by_pilots(Job& job, Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const Device& device = job.devices.front();
    expect_programs(device, job.planned);
    choose_portals(device, job.planned, job.parts, progress);
    job.choice = choose_integrator(device, job.planned, job.parts, progress);
    const bool is_other_sky = choose_sky_table(device, job.planned, job.parts, progress);
    const auto reuse = choose_path_reuse(device, job.planned, job.parts, progress);
    expect_no_other(device, *job.planned);
    choose_light_samples(device, job.planned, job.parts, reuse, progress);
    choose_guide(device, job.planned, job.parts, unguided_pilot(job, reuse, is_other_sky), progress);
    const auto& [tree, programs, guide, reusing] = job.parts;
    job.pilots_seconds =
        seconds_since(start) - (tree ? tree->bvh.seconds : 0) - (programs ? programs->seconds : 0);
}

} // namespace

int run_render(Options options) {
    const auto start = std::chrono::steady_clock::now();
    check_checkpoint(options);
    check_denoiser(options);
    Progress progress(options.run.progress, options.run.verbosity < 0);
    Viewers viewers(options, progress);
    std::vector<Device> devices = open_chosen_devices(options);
    Scene scene = load_for_run(options, progress);
    const double load_seconds = seconds_since(start);
    devices.front().ahead =
        compile_ahead(devices.front().info, {options.device.cache, options.device.cache_folder},
                      unsigned(options.device.threads));
    Job job{start, devices, plan_scene(std::move(scene), options), {}, {}, load_seconds, 0};
    choose_by_pilots(job, progress);
    announce(*job.planned);
    std::optional<Simulation> done;
    const int exit_code = options.camera.frames ? render_turn(job, progress, viewers, done)
                                                : render_picture(job, progress, viewers, done);
    viewers.end(end_text(done->render));
    return exit_code;
}

} // namespace clrt
