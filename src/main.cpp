// SPDX-License-Identifier: Apache-2.0
// clrt: command line -> scene -> effects -> tree and program -> passes -> picture and report.
#include "app/command_line.h"
#include "app/log.h"
#include "app/progress.h"
#include "app/run_program.h"
#include "app/signals.h"
#include "bvh/bvh.h"
#include "device/device.h"
#include "device/device_facts.h"
#include "effects/effects.h"
#include "effects/explain.h"
#include "effects/take_out.h"
#include "error.h"
#include "exit_code.h"
#include "output/image.h"
#include "paths/path_report.h"
#include "render/bvh_quality.h"
#include "render/checkpoint.h"
#include "render/kernels.h"
#include "render/ledger.h"
#include "render/picture.h"
#include "render/render.h"
#include "render/render_params.h"
#include "render/report.h"
#include "render/scene_buffers.h"
#include "replay/causes.h"
#include "replay/replay_pixel.h"
#include "scene/load_scene.h"

#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <future>
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
    for (const PlatformInfo& platform : platforms)
        if (!platform.note.empty())
            spdlog::debug("platform {}: {}", platform.name, platform.note);
    std::string notice;
    const DeviceInfo info = choose_device(platforms, options.device, notice);
    if (!notice.empty())
        spdlog::info("{}", notice);
    return open_device(info);
}

void write_pictures(const Picture& picture, const Options& options) {
    for (const std::string& path : options.outputs)
        write_picture(picture, path, options.exposure_ev, options.tonemap);
}

/// Writes the files at the end of a render. One that cannot be written must not cost the others.
class FinalFiles {
public:
    void write(const std::string& path, const std::function<void()>& writer) {
        try {
            writer();
            spdlog::info("wrote {}", path);
        } catch (const SceneError& error) {
            if (first_error_)
                spdlog::error("{}", error.what());
            else
                first_error_ = error;
        }
    }
    /// Throws the first error, if there was one.
    void finish() const {
        if (first_error_)
            throw SceneError(*first_error_);
    }

private:
    std::optional<SceneError> first_error_;
};

void write_outputs(const Report& report, FinalFiles& files) {
    const Options& options = report.options;
    Picture picture = make_picture(report.render, report.scene, options);
    picture.metadata = report_metadata(report);
    for (const std::string& path : options.outputs)
        files.write(path, [&] { write_picture(picture, path, options.exposure_ev, options.tonemap); });
    if (!options.stats_path.empty())
        files.write(options.stats_path, [&] { write_text_file(options.stats_path, report_json(report)); });
}

/// A save on the way must not end a render that goes on well: a full disk may have room later.
void save_on_the_way(Progress& progress, const std::function<void()>& save) {
    try {
        save();
    } catch (const SceneError& error) {
        progress.finish();
        spdlog::warn("{}; the render goes on", error.what());
    }
}

/// Film files and pictures beside a render. Refers to its arguments.
struct Saving {
    FilmIdentity identity;
    std::optional<RenderProgress> resumed;
    RenderHooks hooks;

    Saving(const Scene& scene, const Options& options, const DeviceInfo& device, Progress& progress) {
        if (!options.checkpoint_path.empty() || !options.resume_path.empty())
            identity = film_identity(scene, options, film_scale(scene));
        if (!options.resume_path.empty())
            resumed = read_resumed_film(options, identity);
        hooks.resume = resumed ? &*resumed : nullptr;
        hooks.save_picture = [&](const Render& render) {
            save_on_the_way(progress, [&] { write_pictures(make_picture(render, scene, options), options); });
        };
        hooks.save_film = [&](const Render& render) {
            save_on_the_way(progress, [&] {
                write_film_file(options.checkpoint_path, film_file(render, options, device));
            });
        };
    }
    Saving(const Saving&) = delete;
    Saving& operator=(const Saving&) = delete;

    FilmFile film_file(const Render& render, const Options& options, const DeviceInfo& device) const {
        return make_film_file(render, identity, options, device);
    }
};

/// The exit code of a finished run, and the warning that goes with it.
int finish(const Report& report) {
    const Render& render = report.render;
    if (report.options.check != Check::OFF && render.counts.bad() > 0)
        spdlog::warn("{} samples were not finite, negative or too large and count as 0; see the causes in the "
                     "report and `nonfinite` in the JSON of --stats",
                     render.counts.bad());
    if (render.stop_signal) {
        spdlog::warn("stopped by a signal after {} spp; the picture is saved", film_samples(render.film));
        return 128 + render.stop_signal;
    }
    spdlog::info("ended after {} spp: {}", film_samples(render.film), render.stop_text);
    const bool missed = report.options.error && film_samples(render.film) > 0 && !error_reached(report);
    if (missed)
        spdlog::warn("--error {:g} % is not reached", 100 * *report.options.error);
    if (report.options.check == Check::STRICT && render.counts.bad() > 0)
        return EXIT_CHECK;
    return missed ? EXIT_ERROR_NOT_REACHED : EXIT_DONE;
}

/// How the device computes, said where its pictures are its own. Not asked without a cache, where every start would pay. A
/// device that cannot answer renders all the same.
std::optional<DeviceFacts> ask_facts(const Device& device, const Options& options, Progress& progress) {
    if (options.cache == Toggle::OFF)
        return std::nullopt;
    std::optional<DeviceFacts> facts;
    try {
        facts = device_facts(device, {options.cache, options.cache_folder});
    } catch (const DeviceError& error) {
        progress.finish();
        spdlog::warn("how the device computes stays unknown: {}", error.what());
        return std::nullopt;
    }
    const bool is_odd = options.precision == Precision::SINGLE && !promises_bits(*facts);
    if (is_odd || options.verbosity > 0)
        progress.finish();
    spdlog::debug("device: {}", describe_facts(*facts));
    if (is_odd)
        spdlog::info("this device breaks rules ({}), so its pictures may differ from other devices' in their last bits",
                     fmt::join(broken_rules(*facts), ", "));
    return facts;
}

/// What tree, program and passes give.
struct Simulation {
    std::optional<DeviceFacts> facts;
    Bvh bvh;
    std::string bvh_reason; ///< why the tree has its quality
    Render render;
    double compile_seconds = 0;
    std::vector<CauseCount> causes; ///< of bad samples
};

/// Finds out why samples are bad. The render is done: what fails here is only said.
std::vector<CauseCount> explain_bad_samples(const Device& device, const Scene& scene, const Effects& effects,
                                            const Options& options, const BvhLayout layout, const SceneBuffers& buffers,
                                            const Render& render) {
    if (options.check == Check::OFF || render.counts.bad_samples.empty() || render.stop_signal)
        return {};
    try {
        return find_causes(device, scene, options, effects, layout, buffers, render.counts);
    } catch (const DeviceError& error) {
        spdlog::warn("bad samples cannot be replayed: {}", error.what());
        return {};
    }
}

Simulation simulate(const Device& device, const Scene& scene, const Effects& effects, const Options& options,
                    Progress& progress, const RenderHooks& hooks) {
    // Compile while the tree is built.
    const BvhLayout layout = choose_layout(options.bvh, device.info);
    progress.update({"compile", -1, 0, -1});
    std::future<RenderPrograms> compiling = std::async(std::launch::async, [&] {
        return build_render_programs(device, options, effects.mask, layout, effects.paths);
    });
    Simulation done;
    const BvhQualityChoice quality = choose_bvh_quality(options, scene.triangles.size());
    spdlog::debug("tree: {} ({})", quality_name(quality.quality), quality.reason);
    const bool compare = quality.quality == BvhQuality::HIGH && options.bvh_quality == QualityChoice::AUTO;
    done.bvh = compare ? build_better_bvh(scene.positions, scene.triangles, layout)
                       : build_bvh(scene.positions, scene.triangles, layout, quality.quality);
    done.bvh_reason = quality.reason;
    if (done.bvh.quality != quality.quality)
        done.bvh_reason += ", but cutting triangles gains too little here";
    const RenderPrograms programs = compiling.get();
    done.facts = ask_facts(device, options, progress);
    const SceneBuffers buffers = upload_scene(device, scene, done.bvh);
    done.render = render(device, programs, buffers, scene, options, progress, hooks);
    done.compile_seconds = programs.seconds;
    done.causes = explain_bad_samples(device, scene, effects, options, layout, buffers, done.render);
    return done;
}

/// The black picture, when no path of the scene is asked for.
Simulation simulate_nothing(const Scene& scene, const Effects& effects, const Options& options) {
    spdlog::warn("{}", path_summary(effects.paths));
    Simulation done;
    done.render = render_nothing(scene, options);
    return done;
}

/// Prints what would be rendered and why.
int run_explain(const Options& options) {
    Progress progress(options.progress, options.verbosity < 0);
    const Scene scene = load_scene(options, progress);
    progress.finish();
    fmt::print("{}", explain(scene, find_effects(scene, options), options));
    return EXIT_DONE;
}

/// Prints what every effect costs and gives.
int run_ledger(const Options& options) {
    const Device device = open_chosen_device(options);
    Progress progress(options.progress, options.verbosity < 0);
    const Scene scene = load_scene(options, progress);
    const Ledger ledger = make_ledger(device, scene, options, progress);
    progress.finish();
    fmt::print("{}", format_ledger(ledger, options, device.info));
    if (!options.stats_path.empty())
        write_text_file(options.stats_path, ledger_json(ledger, options, device.info));
    return EXIT_DONE;
}

/// Prints the path of one sample.
int run_replay(const Options& options) {
    const Device device = open_chosen_device(options);
    Progress progress(options.progress, options.verbosity < 0);
    Scene scene = load_scene(options, progress);
    progress.finish();
    if (options.given.count("--output"))
        spdlog::info("--pixel replays a sample: no picture is written");
    const PixelReplay replay = replay_pixel(device, std::move(scene), options);
    fmt::print("{}", replay.text);
    if (!options.stats_path.empty())
        write_text_file(options.stats_path, replay.json);
    return EXIT_DONE;
}

int run_render(Options options) {
    const auto start = std::chrono::steady_clock::now();
    const Device device = open_chosen_device(options);
    Progress progress(options.progress, options.verbosity < 0);
    Scene scene = load_scene(options, progress);
    const double load_seconds = seconds_since(start);
    progress.finish();
    for (const std::string& notice : scene.notices)
        spdlog::info("{}", notice);
    Effects effects = find_effects(scene, options);
    for (const std::string& line : describe_left_out(effects))
        spdlog::warn("{}", line);
    take_out_effects(effects.left_out, scene, options);
    if (effects.left_out)
        effects.paths = plan_paths(scene, options);
    const Saving saving(scene, options, device.info, progress);

    const Simulation done = effects.paths.is_empty
                                ? simulate_nothing(scene, effects, options)
                                : simulate(device, scene, effects, options, progress, saving.hooks);
    progress.finish();
    FinalFiles files;
    if (!options.checkpoint_path.empty() && film_samples(done.render.film) > 0)
        files.write(options.checkpoint_path, [&] {
            write_film_file(options.checkpoint_path, saving.film_file(done.render, options, device.info));
        });

    const Crop window = render_window(options);
    Report report{options, scene, effects, device.info, done.facts, done.bvh, done.render,
                  make_error_report(done.render, window.x0, window.y0), done.bvh_reason, done.causes, load_seconds,
                  done.compile_seconds,
                  seconds_since(start)};
    write_outputs(report, files);
    files.finish();
    if (options.verbosity >= 0)
        fmt::print("{}", format_report(report));
    return finish(report);
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
    catch_stop_signals();
    if (options.explain != Explain::NO)
        return run_explain(options);
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
