// SPDX-License-Identifier: Apache-2.0
#include "device/driver_cache_folder.h"

#include <cstdlib>
#include <filesystem>
#include <utility>

namespace clrt {

namespace {

/// PoCL's; it comes before those of the user's home.
const char* const VARIABLE = "POCL_CACHE_DIR";
constexpr int OVERWRITE = 1;

} // namespace

std::shared_ptr<const DriverCacheFolder> DriverCacheFolder::make() {
    std::error_code error;
    std::string path = (std::filesystem::temp_directory_path(error) / "clrt-cache-XXXXXX").string();
    if (error || !mkdtemp(path.data()))
        return nullptr;
    return std::shared_ptr<const DriverCacheFolder>(new DriverCacheFolder(std::move(path)));
}

std::shared_ptr<const DriverCacheFolder> DriverCacheFolder::make_for_uncached_run() {
    return std::getenv(VARIABLE) ? nullptr : make();
}

DriverCacheFolder::DriverCacheFolder(std::string path) : path_(std::move(path)) {
    const char* value = std::getenv(VARIABLE);
    was_set_ = value != nullptr;
    earlier_ = value ? value : "";
    setenv(VARIABLE, path_.c_str(), OVERWRITE);
}

DriverCacheFolder::~DriverCacheFolder() {
    if (was_set_)
        setenv(VARIABLE, earlier_.c_str(), OVERWRITE);
    else
        unsetenv(VARIABLE);
    std::error_code error; // a leftover in the temporary folder harms no run
    std::filesystem::remove_all(path_, error);
}

} // namespace clrt
