// SPDX-License-Identifier: Apache-2.0
#include "run/start.h"

#include "device/program_cache.h"
#include "run/run_files.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <spdlog/spdlog.h>
#include <string>
#include <vector>

namespace clrt {

std::vector<Device> open_chosen_devices(const Options& options) {
    const std::vector<PlatformInfo> platforms = list_platforms();
    std::vector<DeviceInfo> chosen;
    for (const std::string& name : device_names(options.device)) {
        std::string notice;
        chosen.push_back(choose_device(platforms, name, notice));
        if (!notice.empty())
            spdlog::info("{}", notice);
    }
    for (const PlatformInfo& platform : platforms) {
        const bool is_chosen = std::any_of(chosen.begin(), chosen.end(), [&](const DeviceInfo& info) {
            return info.platform_index == platform.index;
        });
        if (!platform.note.empty())
            spdlog::log(is_chosen ? spdlog::level::warn : spdlog::level::debug, "platform {}: {}",
                        platform.name, platform.note);
    }
    const ProgramCache cache{options.device.cache, options.device.cache_folder};
    if (const std::string obstacle = program_cache_obstacle(cache); !obstacle.empty())
        spdlog::warn(
            "The program cache's folder {} cannot be written ({}): what is compiled and measured is not "
            "kept for the next run; --cache-dir names another",
            program_cache_folder(cache), obstacle);
    std::vector<Device> devices;
    for (const DeviceInfo& info : chosen)
        devices.push_back(open_device(info));
    return devices;
}

Device open_chosen_device(const Options& options) {
    return open_chosen_devices(options).front();
}

Scene load_for_run(Options& options, Progress& progress) {
    Scene scene = load_scene(options, progress);
    options.film.size = scene.picture_size.value_or(options.film.size);
    progress.finish();
    check_run_files(options, scene);
    return scene;
}

} // namespace clrt
