// SPDX-License-Identifier: Apache-2.0
#include "scene/find_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace clrt {

std::optional<std::string> find_file(std::string_view name, const std::string& referrer, bool by_base_name) {
    namespace fs = std::filesystem;
    if (name.empty() || name.find('\0') != std::string_view::npos)
        return std::nullopt;
    const fs::path folder = fs::path(referrer).parent_path();
    const auto exists = [](const fs::path& path) {
        std::error_code error;
        return fs::exists(path, error) && !fs::is_directory(path, error);
    };

    std::string slashed(name);
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    for (const fs::path& path :
         {folder / fs::path(name).lexically_normal(), folder / fs::path(slashed).lexically_normal()})
        if (exists(path))
            return path.string();
    const fs::path beside = folder / fs::path(slashed).filename();
    if (by_base_name && fs::path(slashed).has_filename() && exists(beside))
        return beside.string();
    return std::nullopt;
}

} // namespace clrt
