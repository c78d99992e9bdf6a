// SPDX-License-Identifier: Apache-2.0
// A place for the cache of a driver that has none, where a home cannot be written for example, or none of its
// own.
#pragma once

#include <memory>
#include <string>

namespace clrt {

/// An empty folder in the system's temporary folder, to which the environment sends the drivers that need
/// one. It vanishes with its files, and the environment is as before, at the end of the scope.
class DriverCacheFolder {
public:
    /// Null where no folder can be made.
    static std::shared_ptr<const DriverCacheFolder> make();
    /// For a run whose programs are not kept: PoCL compiles them in one folder for all such runs, from which
    /// each takes its programs away when it ends, whoever else compiles them. Null where the user names a
    /// folder, too.
    static std::shared_ptr<const DriverCacheFolder> make_for_uncached_run();
    ~DriverCacheFolder();
    DriverCacheFolder(const DriverCacheFolder&) = delete;
    DriverCacheFolder& operator=(const DriverCacheFolder&) = delete;

private:
    explicit DriverCacheFolder(std::string path);
    std::string path_;
    std::string earlier_; ///< the variable before, and
    bool was_set_;        ///< whether there was one
};

} // namespace clrt
