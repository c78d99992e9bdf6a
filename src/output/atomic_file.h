// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all: written under a temporary name in the same folder, flushed to the
// disk, renamed.
#pragma once

#include "images/output_file.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace clrt {

/// Without commit() nothing is left behind and a file of that name keeps its content.
class AtomicFile : public OutputFile {
public:
    /// Creates NAME.partial-PID beside the file and removes those that killed runs left there; a symbolic
    /// link is followed to its file. Throws SceneError with the system's reason, and for names of folders and
    /// devices.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile() override;

    /// May be called from several threads.
    void write_at(const void* bytes, size_t size, std::int64_t position) override;
    size_t read_at(void* bytes, size_t size, std::int64_t position) const override;
    std::int64_t size() const override;
    /// Whether a write failed already, so that going on is in vain.
    bool failed() const { return write_error_ != 0; }

    /// Flushes to the disk and renames.
    void commit() override;

private:
    [[noreturn]] void reject(const std::string& attempt, int error) const;

    std::string path_;        ///< as the user named it
    std::string target_path_; ///< path_ with symbolic links followed
    std::string partial_path_;
    int descriptor_ = -1;
    std::atomic<int> write_error_{0}; ///< errno of the first write that failed
    bool committed_ = false;
};

} // namespace clrt
