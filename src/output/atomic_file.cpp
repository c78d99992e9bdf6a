// SPDX-License-Identifier: Apache-2.0
// Temporary name, flush, rename (POSIX).
#include "output/atomic_file.h"

#include "error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace clrt {

namespace {

namespace fs = std::filesystem;

/// Files of other machines on a shared disk may have our process number; this many names are tried.
constexpr int LARGEST_ATTEMPT = 100;
const char* const PARTIAL_MARK = ".partial-";

/// The file behind symbolic links, so that renaming replaces the file and not the link.
fs::path link_target(const fs::path& path) {
    std::error_code error;
    const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
    return target.empty() ? path : target;
}

/// Removes what killed runs left of the same file. A run holds a lock on the file it writes; a lock that can
/// be had has no owner any more. Where the system knows no locks, nothing is removed.
void remove_leftovers(const fs::path& target) {
    const std::string start = target.filename().string() + PARTIAL_MARK;
    std::error_code error;
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
        const std::string name = file->path().filename().string();
        if (name.compare(0, start.size(), start) != 0 ||
            name.find_first_not_of("0123456789-", start.size()) != name.npos)
            continue;
        const int descriptor = open(file->path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (descriptor < 0)
            continue;
        if (flock(descriptor, LOCK_EX | LOCK_NB) == 0)
            unlink(file->path().c_str());
        close(descriptor);
    }
}

/// Creates a file that is not there yet and locks it; negative, and errno says why, if that is not possible.
int create_locked(const std::string& path) {
    // O_EXCL: never write through somebody else's file or link.
    const int descriptor = open(path.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return descriptor;
    flock(descriptor, LOCK_EX);
    // Another run may have taken it for a leftover before it was locked.
    struct stat status {};
    if (fstat(descriptor, &status) == 0 && status.st_nlink > 0)
        return descriptor;
    close(descriptor);
    errno = EEXIST;
    return -1;
}

/// Makes the rename itself last. Not every file system can do that; the picture is whole either way.
void flush_folder(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return;
    fsync(descriptor);
    close(descriptor);
}

} // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_path_(link_target(path).string()) {
    std::error_code error;
    const fs::file_status status = fs::status(target_path_, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw SceneError(path_, 0, "expected a file to write, found a folder or device; choose another name");

    remove_leftovers(target_path_);
    for (int attempt = 0; attempt < LARGEST_ATTEMPT && descriptor_ < 0; ++attempt) {
        partial_path_ = target_path_ + PARTIAL_MARK + std::to_string(getpid()) +
                        (attempt ? "-" + std::to_string(attempt) : "");
        descriptor_ = create_locked(partial_path_);
        if (descriptor_ < 0 && errno != EEXIST)
            break;
    }
    if (descriptor_ < 0)
        reject("create", errno);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0)
        close(descriptor_);
    if (!committed_)
        unlink(partial_path_.c_str());
}

void AtomicFile::write_at(const void* bytes, size_t size, std::int64_t position) {
    const char* next = static_cast<const char*>(bytes);
    while (size > 0 && !failed()) {
        const ssize_t written = pwrite(descriptor_, next, size, position);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            write_error_ = written < 0 ? errno : EIO;
            return;
        }
        next += written;
        position += written;
        size -= static_cast<size_t>(written);
    }
}

size_t AtomicFile::read_at(void* bytes, size_t size, std::int64_t position) const {
    const ssize_t count = pread(descriptor_, bytes, size, position);
    return count < 0 ? 0 : static_cast<size_t>(count);
}

std::int64_t AtomicFile::size() const {
    struct stat status {};
    return fstat(descriptor_, &status) == 0 ? status.st_size : 0;
}

void AtomicFile::commit() {
    if (failed())
        reject("write", write_error_);
    if (fsync(descriptor_) != 0)
        reject("write", errno);
    // The lock is held until the file has its name: nobody may take it for a leftover.
    if (std::rename(partial_path_.c_str(), target_path_.c_str()) != 0)
        reject("rename to", errno);
    committed_ = true;
    close(descriptor_);
    descriptor_ = -1;
    flush_folder(target_path_);
}

void AtomicFile::reject(const std::string& attempt, int error) const {
    const std::string hint = error == ENOSPC || error == EDQUOT ? "free some space or choose another folder"
                             : error == ENOENT                  ? "make its folder first"
                                               : "choose another name or folder";
    throw SceneError(path_, 0, "cannot " + attempt + " the file: " + std::strerror(error) + "; " + hint);
}

} // namespace clrt
