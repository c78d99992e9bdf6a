// SPDX-License-Identifier: Apache-2.0
#include "stability/shipped_scenes.h"

#include "app/command_line.h"
#include "console/progress.h"
#include "error.h"
#include "scene/load_scene.h"
#include "scene/sky_table.h"

#include <algorithm>
#include <filesystem>

namespace clrt {

namespace {

namespace fs = std::filesystem;

fs::path scenes_folder() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path installed = program.parent_path().parent_path() / "share/clrt/scenes";
    for (const fs::path& folder : {installed, fs::path(CLRT_SCENES_FOLDER)})
        if (fs::is_directory(folder, error))
            return folder;
    throw SceneError(installed.string(), 0, "expected the scenes that clrt ships, found no such folder");
}

} // namespace

std::vector<std::string> shipped_scenes() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(scenes_folder()))
        if (fs::exists(entry.path() / (entry.path().filename().string() + ".obj")))
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

ShippedScene::ShippedScene(const std::string& name) {
    const std::string path = (scenes_folder() / name / (name + ".obj")).string();
    const char* const arguments[] = {"clrt", path.c_str()};
    options = parse_command_line(2, arguments).options;
    options.device.cache = Toggle::OFF; // a case is of what is compiled now
}

Scene ShippedScene::load() const {
    Progress progress(Toggle::OFF, true);
    Scene scene = load_scene(options, progress);
    tabulate_sky(scene.environment, integrator_row(options.transport.integrator).sky);
    return scene;
}

} // namespace clrt
