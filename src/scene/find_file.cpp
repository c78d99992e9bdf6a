// SPDX-License-Identifier: Apache-2.0
#include "scene/find_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace clrt {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error) && !fs::is_directory(path, error);
}

std::string in_lower_case(std::string text) {
    for (char& c : text)
        c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return text;
}

/// The first entry of the folder, by name, that differs from `name` in case alone; nothing if there is none.
std::optional<fs::path> entry_in_any_case(const fs::path& folder, const std::string& name) {
    std::optional<fs::path> first;
    std::error_code error;
    const fs::path listed = folder.empty() ? fs::path(".") : folder;
    for (fs::directory_iterator it(listed, error), end; !error && it != end; it.increment(error)) {
        const fs::path entry = it->path().filename();
        if (in_lower_case(entry.string()) == in_lower_case(name) && (!first || entry < *first))
            first = entry;
    }
    return first ? std::optional<fs::path>(folder / *first) : std::nullopt;
}

/// A file below the folder by names whose case may differ, as on systems that do not tell case apart.
std::optional<fs::path> find_in_any_case(const fs::path& folder, const fs::path& relative) {
    fs::path path = folder;
    for (const fs::path& part : relative) {
        std::error_code error;
        if (fs::exists(path / part, error)) {
            path /= part;
            continue;
        }
        const std::optional<fs::path> entry = entry_in_any_case(path, part.string());
        if (!entry)
            return std::nullopt;
        path = *entry;
    }
    return is_file(path) ? std::optional<fs::path>(path) : std::nullopt;
}

} // namespace

std::optional<std::string> find_file(std::string_view name, const std::string& referrer, bool by_base_name) {
    if (name.empty() || name.find('\0') != std::string_view::npos)
        return std::nullopt;
    const fs::path folder = fs::path(referrer).parent_path();
    std::string slashed(name);
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    const fs::path with_slashes = fs::path(slashed).lexically_normal();
    for (const fs::path& path : {folder / fs::path(name).lexically_normal(), folder / with_slashes})
        if (is_file(path))
            return path.string();
    const bool has_base_name = by_base_name && with_slashes.has_filename();
    const fs::path beside = folder / with_slashes.filename();
    if (has_base_name && is_file(beside))
        return beside.string();
    if (with_slashes.is_relative())
        if (const std::optional<fs::path> path = find_in_any_case(folder, with_slashes))
            return path->string();
    if (has_base_name)
        if (const std::optional<fs::path> path = find_in_any_case(folder, with_slashes.filename()))
            return path->string();
    return std::nullopt;
}

} // namespace clrt
