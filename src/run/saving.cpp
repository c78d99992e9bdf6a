// SPDX-License-Identifier: Apache-2.0
#include "run/saving.h"

#include "output/exposure.h"
#include "output/file_name.h"
#include "output/image.h"
#include "output/standard_streams.h"
#include "output/written_files.h"
#include "render/picture.h"
#include "render/render_params.h"

#include <algorithm>
#include <fmt/format.h>
#include <new>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// Auto exposure is that of the samples so far.
void write_pictures(const Picture& picture, const Options& options, const Film& film) {
    const double exposure_ev = chosen_exposure_ev(options.output, picture.layers[picture.displayed].values);
    for (const std::string& name : options.output.files)
        if (!is_standard_output(name)) // which takes one picture, at the end
            write_picture(picture, output_name(name, options, film), exposure_ev, options.output.tonemap);
}

/// Saves while the render goes on, whatever happens to the file; returns whether it is there.
bool save_on_the_way(Progress& progress, const std::function<void()>& save) {
    try {
        save();
        return true;
    } catch (const SceneError& error) {
        progress.finish();
        spdlog::warn("{}; the render goes on", error.what());
    } catch (const std::bad_alloc&) {
        progress.finish();
        spdlog::warn("not enough memory to save on the way; the render goes on");
    }
    return false;
}

/// The picture with its layers, or without where they do not fit the memory.
Picture picture_within_memory(const Report& report, FinalFiles& files) {
    try {
        return make_picture(report.render, report.scene, report.options);
    } catch (const std::bad_alloc&) {
        files.fail(
            SceneError(output_name(report.options.output.files.front(), report.options, report.render.film),
                       0, "not enough memory for the layers: the picture is written without them"));
        return make_plain_picture(report.render, report.options);
    }
}

/// Says which stops were chosen, or which would show a picture of which as it is little is seen.
void tell_exposure(const Report& report, const std::vector<float>& rgb) {
    const Options& options = report.options;
    const std::vector<std::string>& files = options.output.files;
    if (options.output.auto_exposure)
        spdlog::info("{}", exposure_notice(report.exposure_ev));
    else if (options.run.given.count("--exposure") == 0 &&
             std::any_of(files.begin(), files.end(), is_display_output))
        try {
            if (const std::string hint = exposure_hint(options.output, rgb); !hint.empty())
                spdlog::info("{}", hint);
        } catch (const std::bad_alloc&) {
            // a hint is not worth the picture
        }
}

} // namespace

std::string output_name(const std::string& name, const Options& options, const Film& film) {
    return expand_file_name(name, {options.sampling.seed, film_samples(film), options.camera.frame});
}

void FinalFiles::write(const std::string& path, const std::function<void()>& writer) {
    try {
        writer();
        spdlog::info("wrote {}", path);
        return;
    } catch (const SceneError& error) {
        fail(error);
    } catch (const std::bad_alloc&) {
        fail(SceneError(path, 0, "not enough memory to write the file"));
    }
    lost_.push_back(path);
}

void FinalFiles::fail(const SceneError& error) {
    spdlog::error("{}", error.what());
    complete_ = false;
}

void warn_of_lost_alpha(const Picture& picture, const std::vector<std::string>& paths) {
    for (const std::string& path : paths)
        if (picture.is_transparent && is_output_path(path) && !can_hold_alpha(path))
            spdlog::warn("{}: the format holds no alpha, so the transparent background is black", path);
    if (picture.is_transparent && !picture_coverage(picture) &&
        std::any_of(paths.begin(), paths.end(), can_hold_alpha))
        spdlog::warn(
            "the coverage of the pixels is not known here, so the transparent background is black and "
            "pictures have no alpha");
}

void write_outputs(Report& report, FinalFiles& files) {
    const Options& options = report.options;
    Picture picture = picture_within_memory(report, files);
    report.exposure_ev = chosen_exposure_ev(options.output, picture.layers[picture.displayed].values);
    picture.metadata = report_metadata(report);
    tell_exposure(report, picture.layers[picture.displayed].values);
    warn_of_lost_alpha(picture, options.output.files);
    const Film& film = report.render.film;
    for (const std::string& name : options.output.files) {
        const std::string path = output_name(name, options, film);
        files.write(path, [&] { write_picture(picture, path, report.exposure_ev, options.output.tonemap); });
    }
    report.lost_files = files.lost();
    if (options.output.stats_path.empty())
        return;
    const std::string stats = output_name(options.output.stats_path, options, film);
    files.write(stats, [&] { write_text_file(stats, report_json(report)); });
    report.lost_files = files.lost();
}

Saving::Saving(const Scene& scene, const PathPlan& paths, const Options& options, const DeviceInfo& device,
               Progress& progress)
    : scene_(scene), paths_(paths), options_(options), device_(device) {
    if (!options.film_file.checkpoint_path.empty()) {
        const FilmScale scale = film_scale(scene);
        identity = film_identity(scene, options, make_render_params(scene, options, scale), scale);
    }
    if (!options.film_file.resume_path.empty())
        resume();
    hooks.resume = resumed ? &*resumed : nullptr;
    hooks.save_picture = [&](const Render& render) {
        return save_on_the_way(
            progress, [&] { write_pictures(make_picture(render, scene, options), options, render.film); });
    };
    hooks.save_film = [&](const Render& render) {
        return save_on_the_way(progress, [&] { write_film(render); });
    };
}

/// Takes up the film of --resume. Whatever it is to replace must be part of it.
void Saving::resume() {
    resumed = read_resumed_film(options_, identity);
    spdlog::info("resumed at {} spp: {}", film_samples(resumed->film), options_.film_file.resume_path);
    if (options_.film_file.force)
        return;
    if (const auto obstacle =
            replacement_obstacle(options_.film_file.checkpoint_path, {identity, resumed->film.ranges}))
        throw UsageError(fmt::format("option --checkpoint: '{}' cannot be replaced: {}; --force replaces it",
                                     options_.film_file.checkpoint_path, *obstacle));
}

bool Saving::needs_film(const Render& render) const {
    const bool is_whole = resumed && render.passes == 0 &&
                          is_same_file(options_.film_file.checkpoint_path, options_.film_file.resume_path);
    return !options_.film_file.checkpoint_path.empty() && film_samples(render.film) > 0 && !is_whole;
}

void Saving::write_film(const Render& render) const {
    const std::string& path = options_.film_file.checkpoint_path;
    if (!options_.film_file.force)
        if (const auto obstacle = replacement_obstacle(path, {identity, render.film.ranges}))
            throw SceneError(
                path, 0,
                fmt::format("the film of this run is not written: {}; --force replaces it", *obstacle));
    const BiasSources bias = bias_sources(scene_, paths_, render, options_.transport.integrator);
    write_film_file(path, make_film_file(render, bias, identity, options_, device_));
}

} // namespace clrt
