// SPDX-License-Identifier: Apache-2.0
// Reads kernel files and expands their includes.
#include "device/kernel_source.h"

#include "error.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace clrt {

namespace {

/// The file that `#include "file"` names; nothing if the line is no such directive.
std::optional<std::string> included_file(const std::string& line) {
    std::istringstream words(line);
    char hash = 0;
    std::string directive, name;
    if (!(words >> hash) || hash != '#' || !(words >> directive) || directive != "include")
        return std::nullopt;
    std::getline(words >> std::ws, name);
    const size_t end = name.find('"', 1);
    if (name.empty() || name.front() != '"' || end == std::string::npos)
        return std::nullopt;
    return name.substr(1, end - 1);
}

/// Expands one file after the other into one text.
class Expansion {
public:
    explicit Expansion(const KernelFiles& files) : files_(files) {}

    /// Appends `file`. A nested include ends with the line number at which its includer goes on.
    void append(const std::string& file) {
        expanded_.insert(file);
        text_ += fmt::format("#line 1 \"{}\"\n", file);
        std::istringstream lines(files_.at(file));
        std::string line;
        for (size_t number = 1; std::getline(lines, line); ++number) {
            const auto name = included_file(line);
            if (!name) {
                text_ += line + '\n';
                continue;
            }
            const std::string target = resolve(*name, file, number);
            if (expanded_.count(target)) {
                text_ += '\n';
                continue;
            }
            append(target);
            text_ += fmt::format("#line {} \"{}\"\n", number + 1, file);
        }
    }

    std::string text() && { return std::move(text_); }

private:
    /// The key of an included file: relative to the including file, else to kernels/.
    std::string resolve(const std::string& name, const std::string& includer, size_t line) const {
        const std::string beside =
            (fs::path(includer).parent_path() / name).lexically_normal().generic_string();
        const std::string below_root = fs::path(name).lexically_normal().generic_string();
        for (const std::string& candidate : {beside, below_root})
            if (files_.count(candidate))
                return candidate;
        throw SceneError(
            includer, line,
            fmt::format("the kernel file \"{}\" does not exist. Looked for {} and {} in the kernels "
                        "folder; correct the #include or add the file.",
                        name, beside, below_root));
    }

    const KernelFiles& files_;
    std::set<std::string> expanded_;
    std::string text_;
};

bool is_kernel_file(const fs::path& path) {
    return path.extension() == ".h" || path.extension() == ".cl";
}

} // namespace

KernelFiles read_kernel_files(const std::string& folder) {
    KernelFiles files;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (!entry->is_regular_file() || !is_kernel_file(entry->path()))
            continue;
        std::ifstream stream(entry->path(), std::ios::binary);
        std::ostringstream text;
        text << stream.rdbuf();
        if (!stream.is_open() || stream.bad())
            throw SceneError(entry->path().string(), 0,
                             "the kernel file cannot be read. Check its permissions.");
        files[entry->path().lexically_relative(folder).generic_string()] = text.str();
    }
    if (error)
        throw SceneError(folder, 0, "the kernels folder cannot be read: " + error.message() + ".");
    if (files.empty())
        throw SceneError(
            folder, 0,
            "expected a folder of kernel files (*.h and *.cl), found none. Give the folder that holds "
            "integrators/ and shared/.");
    return files;
}

KernelFiles kernel_files(const std::string& folder) {
    return folder.empty() ? embedded_kernel_files() : read_kernel_files(folder);
}

std::string expand_kernel_source(const KernelFiles& files, const std::string& entry) {
    if (!files.count(entry))
        throw SceneError(entry, 0, "there is no kernel file of this name in the kernels folder.");
    Expansion expansion(files);
    expansion.append(entry);
    return std::move(expansion).text();
}

} // namespace clrt
