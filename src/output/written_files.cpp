// SPDX-License-Identifier: Apache-2.0
#include "output/written_files.h"

#include "error.h"
#include "output/standard_streams.h"

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

/// Streams and devices are none of them.
FileKey key_of(const std::string& name) {
    const std::string path = is_standard_output(name) ? "/dev/stdout" : name;
    struct stat status {};
    if (stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode))
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
        const auto [other, is_new] = results.emplace(key, &file);
        if (!is_new && is_standard_output(file.path) && is_standard_output(other->second->path))
            throw UsageError(
                fmt::format("options {} and {}: expected one result for the standard output, found "
                            "'{}' and '{}'",
                            other->second->name, file.name, other->second->path, file.path));
        if (!is_new)
            throw UsageError(
                fmt::format("option {}: expected a file of its own, found '{}', which is '{}' of "
                            "option {} too",
                            file.name, file.path, other->second->path, other->second->name));
    }
}

} // namespace clrt
