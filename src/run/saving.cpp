// SPDX-License-Identifier: Apache-2.0
#include "run/saving.h"

#include "output/image.h"
#include "render/picture.h"

#include <algorithm>
#include <new>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

void write_pictures(const Picture& picture, const Options& options) {
    for (const std::string& path : options.outputs)
        write_picture(picture, path, options.exposure_ev, options.tonemap);
}

/// Saves while the render goes on, whatever happens to the file.
void save_on_the_way(Progress& progress, const std::function<void()>& save) {
    try {
        save();
    } catch (const SceneError& error) {
        progress.finish();
        spdlog::warn("{}; the render goes on", error.what());
    } catch (const std::bad_alloc&) {
        progress.finish();
        spdlog::warn("not enough memory to save on the way; the render goes on");
    }
}

/// The picture with its layers, or without where they do not fit the memory.
Picture picture_within_memory(const Report& report, FinalFiles& files) {
    try {
        return make_picture(report.render, report.scene, report.options);
    } catch (const std::bad_alloc&) {
        files.fail(SceneError(report.options.outputs.front(), 0,
                              "not enough memory for the layers: the picture is written without them"));
        return make_plain_picture(report.render, report.options);
    }
}

} // namespace

void FinalFiles::write(const std::string& path, const std::function<void()>& writer) {
    try {
        writer();
        spdlog::info("wrote {}", path);
    } catch (const SceneError& error) {
        fail(error);
    } catch (const std::bad_alloc&) {
        fail(SceneError(path, 0, "not enough memory to write the file"));
    }
}

void FinalFiles::fail(const SceneError& error) {
    if (first_error_)
        spdlog::error("{}", error.what());
    else
        first_error_ = error;
}

void FinalFiles::finish() const {
    if (first_error_)
        throw SceneError(*first_error_);
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

void write_outputs(const Report& report, FinalFiles& files) {
    const Options& options = report.options;
    Picture picture = picture_within_memory(report, files);
    picture.metadata = report_metadata(report);
    warn_of_lost_alpha(picture, options.outputs);
    for (const std::string& path : options.outputs)
        files.write(path, [&] { write_picture(picture, path, options.exposure_ev, options.tonemap); });
    if (!options.stats_path.empty())
        files.write(options.stats_path, [&] { write_text_file(options.stats_path, report_json(report)); });
}

Saving::Saving(const Scene& scene, const PathPlan& paths, const Options& options, const DeviceInfo& device,
               Progress& progress)
    : scene_(scene), paths_(paths) {
    if (!options.checkpoint_path.empty() || !options.resume_path.empty())
        identity = film_identity(scene, options, film_scale(scene));
    if (!options.resume_path.empty())
        resumed = read_resumed_film(options, identity);
    hooks.resume = resumed ? &*resumed : nullptr;
    hooks.save_picture = [&](const Render& render) {
        save_on_the_way(progress, [&] { write_pictures(make_picture(render, scene, options), options); });
    };
    hooks.save_film = [&](const Render& render) {
        save_on_the_way(
            progress, [&] { write_film_file(options.checkpoint_path, film_file(render, options, device)); });
    };
}

FilmFile Saving::film_file(const Render& render, const Options& options, const DeviceInfo& device) const {
    return make_film_file(render, bias_sources(scene_, paths_, render), identity, options, device);
}

} // namespace clrt
