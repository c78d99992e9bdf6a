// SPDX-License-Identifier: Apache-2.0
// clrt: command line -> scene -> effects -> tree and program -> passes -> picture and report.
#include "app/command_line.h"
#include "app/log.h"
#include "app/progress.h"
#include "app/signals.h"
#include "bvh/bvh.h"
#include "device/device.h"
#include "effects/effects.h"
#include "effects/explain.h"
#include "error.h"
#include "exit_code.h"
#include "output/image.h"
#include "render/bvh_quality.h"
#include "render/kernels.h"
#include "render/picture.h"
#include "render/render.h"
#include "render/report.h"
#include "render/scene_buffers.h"
#include "scene/load_scene.h"

#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <future>
#include <new>
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

void write_outputs(const Report& report) {
    Picture picture = make_picture(report.render, report.scene, report.options);
    picture.metadata = report_metadata(report);
    for (const std::string& path : report.options.outputs) {
        write_picture(picture, path, report.options.exposure_ev, report.options.tonemap);
        spdlog::info("wrote {}", path);
    }
    if (!report.options.stats_path.empty())
        write_text_file(report.options.stats_path, report_json(report));
}

/// The exit code of a finished run, and the warning that goes with it.
int finish(const Report& report) {
    const Render& render = report.render;
    if (report.options.check != Check::OFF && render.counts.bad() > 0)
        spdlog::warn("{} samples were not finite, negative or too large and count as 0 (the JSON of --stats lists them)",
                     render.counts.bad());
    if (render.stop_signal) {
        spdlog::warn("stopped by a signal after {} spp; the picture is saved", render.passes);
        return 128 + render.stop_signal;
    }
    return report.options.check == Check::STRICT && render.counts.bad() > 0 ? EXIT_CHECK : EXIT_DONE;
}

/// Prints what would be rendered and why.
int run_explain(const Options& options) {
    Progress progress(options.progress, options.verbosity < 0);
    const Scene scene = load_scene(options, progress);
    progress.finish();
    fmt::print("{}", explain(scene, find_effects(scene, options), options));
    return EXIT_DONE;
}

int run_render(const Options& options) {
    const auto start = std::chrono::steady_clock::now();
    const Device device = open_chosen_device(options);
    Progress progress(options.progress, options.verbosity < 0);
    const Scene scene = load_scene(options, progress);
    const double load_seconds = seconds_since(start);
    progress.finish();
    for (const std::string& notice : scene.notices)
        spdlog::info("{}", notice);
    const Effects effects = find_effects(scene, options);

    // Compile while the tree is built.
    const BvhLayout layout = choose_layout(options.bvh, device.info);
    progress.update({"compile", -1, 0, -1});
    std::future<RenderPrograms> compiling = std::async(
        std::launch::async, [&] { return build_render_programs(device, options, effects.mask, layout); });
    const BvhQualityChoice quality = choose_bvh_quality(options, scene.triangles.size());
    spdlog::debug("tree: {} ({})", quality.quality == BvhQuality::HIGH ? "high" : "fast", quality.reason);
    const Bvh bvh = build_bvh(scene.positions, scene.triangles, layout, quality.quality);
    const RenderPrograms programs = compiling.get();
    const SceneBuffers buffers = upload_scene(device, scene, bvh);

    const Render rendered = render(device, programs, buffers, scene, options, progress);
    progress.finish();

    Report report{options, scene, effects, device.info, bvh, rendered, film_error(rendered.film),
                  quality.reason, load_seconds,
                  programs.seconds, seconds_since(start)};
    write_outputs(report);
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
        fmt::print("{}", format_device_table(list_platforms()));
        return EXIT_DONE;
    }
    if (!options.sidecar_path.empty())
        spdlog::info("options file: {}", options.sidecar_path);
    catch_stop_signals();
    return options.explain == Explain::NO ? run_render(options) : run_explain(options);
}

int report_error(int code, const char* what) {
    std::fprintf(stderr, "clrt: error: %s\n", what);
    return code;
}

} // namespace

} // namespace clrt

int main(int argc, char** argv) {
    using namespace clrt;
    try {
        return run(argc, argv);
    } catch (const UsageError& error) {
        return report_error(EXIT_USAGE, error.what());
    } catch (const SceneError& error) {
        return report_error(EXIT_SCENE, error.what());
    } catch (const DeviceError& error) {
        return report_error(EXIT_DEVICE, error.what());
    } catch (const std::bad_alloc&) {
        return report_error(EXIT_SCENE, "not enough memory");
    } catch (const std::exception& error) {
        return report_error(EXIT_SCENE, error.what());
    }
}
