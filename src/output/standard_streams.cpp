// SPDX-License-Identifier: Apache-2.0
#include "output/standard_streams.h"

#include "error.h"
#include "output/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <unistd.h>

namespace clrt {

bool is_standard_input(const std::string& path) {
    return path == "-";
}

std::string input_name(const std::string& path) {
    return is_standard_input(path) ? "stdin" : path;
}

bool is_standard_output(const std::string& path) {
    const std::string ending = ":-";
    const bool has_ending = path.size() > ending.size() && path.find('/') == path.npos &&
                            path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
    return path == "-" || has_ending;
}

void StandardOutput::write_at(const void* bytes, size_t size, std::int64_t position) {
    bytes_.resize(std::max(bytes_.size(), size_t(position) + size));
    std::memcpy(&bytes_[size_t(position)], bytes, size);
}

size_t StandardOutput::read_at(void* bytes, size_t size, std::int64_t position) const {
    if (position < 0 || size_t(position) >= bytes_.size())
        return 0;
    return bytes_.copy(static_cast<char*>(bytes), size, size_t(position));
}

void StandardOutput::commit() {
    for (size_t done = 0; done < bytes_.size();) {
        const ssize_t count = write(STDOUT_FILENO, bytes_.data() + done, bytes_.size() - done);
        if (count > 0) {
            done += size_t(count);
        } else if (errno == EAGAIN) { // somebody made the pipe a non-blocking one
            pollfd wait{STDOUT_FILENO, POLLOUT, 0};
            poll(&wait, 1, -1);
        } else if (errno != EINTR) {
            throw SceneError(path_, 0,
                             std::string("cannot write to the standard output: ") + std::strerror(errno));
        }
    }
}

std::unique_ptr<OutputFile> open_output(const std::string& path) {
    if (is_standard_output(path))
        return std::make_unique<StandardOutput>(path);
    return std::make_unique<AtomicFile>(path);
}

} // namespace clrt
