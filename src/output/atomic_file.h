// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all: written under a temporary name in the same folder, flushed to the
// disk, renamed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace clrt {

/// Write, then commit; without commit() nothing is left behind and a file of that name keeps its content.
/// Errors of writing are kept until commit(), so that image encoders need not cope with them.
class AtomicFile {
public:
    /// Creates NAME.partial-PID beside the file and removes those that killed runs left there; a symbolic
    /// link is followed to its file. Throws SceneError with the system's reason, and for names of folders and
    /// devices.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Writes at a position; may be called from several threads.
    void write_at(const void* bytes, size_t size, std::int64_t position);
    /// Reads back what was written; returns the number of bytes that are there.
    size_t read_at(void* bytes, size_t size, std::int64_t position) const;
    /// The file's size so far, bytes.
    std::int64_t size() const;
    /// Whether a write failed already, so that going on is in vain.
    bool failed() const { return write_error_ != 0; }

    /// Flushes to the disk and renames. Throws SceneError that names the file and the system's reason.
    void commit();

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
