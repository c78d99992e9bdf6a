// SPDX-License-Identifier: Apache-2.0
#include "output/written_files.h"

#include "error.h"

#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <sys/stat.h>
#include <tuple>
#include <utility>

namespace clrt {

namespace {

namespace fs = std::filesystem;

/// What tells a file from others: device and inode of one that is there, else its place.
struct FileKey {
    std::optional<std::pair<dev_t, ino_t>> inode;
    fs::path place; ///< empty where there is an inode

    bool operator<(const FileKey& other) const {
        return std::tie(inode, place) < std::tie(other.inode, other.place);
    }
};

FileKey key_of(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) == 0)
        return {std::pair(status.st_dev, status.st_ino), {}};
    std::error_code error; // a place that cannot be followed is that of its name
    const fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
    return {std::nullopt, error ? fs::path(path) : place};
}

} // namespace

bool is_same_file(const std::string& a, const std::string& b) {
    const FileKey one = key_of(a), other = key_of(b);
    return !(one < other) && !(other < one);
}

void check_written_files(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
    std::map<FileKey, const NamedFile*> inputs, results;
    for (const NamedFile& file : read)
        if (const FileKey key = key_of(file.path); key.inode)
            inputs.emplace(key, &file);
    for (const NamedFile& file : written) {
        const FileKey key = key_of(file.path);
        if (const auto input = inputs.find(key); input != inputs.end())
            throw UsageError(fmt::format("option {}: expected a file of its own, found '{}', which would "
                                         "replace {} '{}'",
                                         file.name, file.path, input->second->name, input->second->path));
        if (const auto [other, is_new] = results.emplace(key, &file); !is_new)
            throw UsageError(
                fmt::format("option {}: expected a file of its own, found '{}', which is '{}' of "
                            "option {} too",
                            file.name, file.path, other->second->path, other->second->name));
    }
}

} // namespace clrt
