// SPDX-License-Identifier: Apache-2.0
#include "run/start.h"

#include "device/program_cache.h"
#include "run/run_files.h"
#include "scene/load_scene.h"

#include <spdlog/spdlog.h>
#include <string>
#include <vector>

namespace clrt {

Device open_chosen_device(const Options& options) {
    const std::vector<PlatformInfo> platforms = list_platforms();
    std::string notice;
    const DeviceInfo info = choose_device(platforms, options.device.name, notice);
    for (const PlatformInfo& platform : platforms)
        if (!platform.note.empty())
            spdlog::log(platform.index == info.platform_index ? spdlog::level::warn : spdlog::level::debug,
                        "platform {}: {}", platform.name, platform.note);
    if (!notice.empty())
        spdlog::info("{}", notice);
    const ProgramCache cache{options.device.cache, options.device.cache_folder};
    if (const std::string obstacle = program_cache_obstacle(cache); !obstacle.empty())
        spdlog::warn(
            "The program cache's folder {} cannot be written ({}): what is compiled and measured is not "
            "kept for the next run; --cache-dir names another",
            program_cache_folder(cache), obstacle);
    return open_device(info);
}

Scene load_for_run(Options& options, Progress& progress) {
    Scene scene = load_scene(options, progress);
    options.film.size = scene.picture_size.value_or(options.film.size);
    progress.finish();
    check_run_files(options, scene);
    return scene;
}

} // namespace clrt
