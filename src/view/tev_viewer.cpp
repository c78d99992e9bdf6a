// SPDX-License-Identifier: Apache-2.0
#include "view/tev_viewer.h"

#include "error.h"
#include "view/tev_packets.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <memory>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace clrt {

namespace {

/// A packet has about so many floats: tev's lengths end at 4 GB.
constexpr size_t PACKET_FLOATS = size_t(1) << 21;

const std::vector<std::string> COLOUR{"R", "G", "B"};
const std::vector<std::string> COLOUR_AND_ERROR{"R", "G", "B", "error.Y"};

/// Waits until the socket can be written to; returns 0 or an error number.
int wait_for_room(int socket, std::chrono::milliseconds time) {
    pollfd wait{socket, POLLOUT, 0};
    int result = 0;
    do
        result = poll(&wait, 1, int(time.count()));
    while (result < 0 && errno == EINTR);
    return result > 0 ? 0 : result == 0 ? ETIMEDOUT : errno;
}

/// Connects to one address; a descriptor, or minus an error number.
int connect_to(const addrinfo& address, std::chrono::milliseconds time) {
    const int descriptor =
        socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol);
    if (descriptor < 0)
        return -errno;
    int error = connect(descriptor, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) {
        error = wait_for_room(descriptor, time);
        socklen_t size = sizeof error;
        if (error == 0 && getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size) != 0)
            error = errno;
    }
    if (error == 0)
        return descriptor;
    close(descriptor);
    return -error;
}

/// Connects to the first of the host's addresses that answers.
int connect_to(const DisplayServer& server, std::chrono::milliseconds time) {
    const auto refuse = [&](const std::string& why) -> int {
        throw UsageError(
            fmt::format("option --display-server: expected tev to listen on port {} of '{}', found: {}; "
                        "start tev first, it prints where it listens",
                        server.port, server.host, why));
    };
    addrinfo wanted{}, *found = nullptr;
    wanted.ai_socktype = SOCK_STREAM;
    const int fault = getaddrinfo(server.host.c_str(), std::to_string(server.port).c_str(), &wanted, &found);
    if (fault != 0)
        return refuse(fault == EAI_SYSTEM ? std::strerror(errno) : gai_strerror(fault));
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
    int result = -EHOSTUNREACH;
    for (const addrinfo* address = found; address && result < 0; address = address->ai_next)
        result = connect_to(*address, time);
    return result >= 0 ? result : refuse(std::strerror(-result));
}

/// Channels of a snapshot's rows side by side.
std::vector<float> interleaved(const Snapshot& snapshot, int y, int rows) {
    const bool has_errors = !snapshot.errors.empty();
    std::vector<float> values;
    values.reserve(size_t(rows) * size_t(snapshot.width) * (has_errors ? 4 : 3));
    const size_t begin = size_t(y) * size_t(snapshot.width),
                 end = begin + size_t(rows) * size_t(snapshot.width);
    for (size_t pixel = begin; pixel < end; ++pixel) {
        values.insert(values.end(), &snapshot.rgb[3 * pixel], &snapshot.rgb[3 * pixel] + 3);
        if (has_errors)
            values.push_back(snapshot.errors[pixel]);
    }
    return values;
}

} // namespace

Socket::~Socket() {
    close(descriptor_);
}

TevViewer::TevViewer(const DisplayServer& server, const TevPatience& patience)
    : patience_(patience), socket_(connect_to(server, patience.connect)), thread_([this] { run(); }) {}

TevViewer::~TevViewer() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        shutdown(socket_.get(), SHUT_RDWR); // a picture on its way is not waited for: finish() would have
    }
    changed_.notify_all();
    thread_.join();
}

bool TevViewer::is_free() {
    const std::lock_guard lock(mutex_);
    return loss_.empty() && !is_sending_ && !next_;
}

void TevViewer::show(SnapshotPointer snapshot, const std::string& name) {
    const std::lock_guard lock(mutex_);
    next_ = std::move(snapshot);
    next_name_ = name;
    changed_.notify_all();
}

void TevViewer::finish() {
    std::unique_lock lock(mutex_);
    const auto is_done = [&] { return !loss_.empty() || (!is_sending_ && !next_); };
    if (!changed_.wait_for(lock, patience_.finish, is_done))
        loss_ = "it has not taken the finished picture in time";
}

std::string TevViewer::loss() {
    const std::lock_guard lock(mutex_);
    return loss_;
}

/// Sends what is to be sent until the end or a loss.
void TevViewer::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return ends_ || next_; });
        if (ends_)
            return;
        const SnapshotPointer snapshot = std::exchange(next_, nullptr);
        const std::string name = next_name_;
        is_sending_ = true;
        lock.unlock();
        std::string loss;
        try {
            send_picture(*snapshot, name);
        } catch (const std::exception& error) {
            loss = error.what();
        }
        lock.lock();
        is_sending_ = false;
        if (loss_.empty())
            loss_ = loss;
        changed_.notify_all();
        if (!loss_.empty())
            return;
    }
}

void TevViewer::send_picture(const Snapshot& snapshot, const std::string& name) {
    const TevImage image{name, snapshot.width, snapshot.height,
                         snapshot.errors.empty() ? COLOUR : COLOUR_AND_ERROR};
    const std::string create = tev_create(image);
    if (created_ != create)
        send_bytes(create);
    created_ = create;
    const int rows = int(std::clamp<size_t>(PACKET_FLOATS / (size_t(image.width) * image.channels.size()), 1,
                                            size_t(image.height)));
    for (int y = 0; y < image.height; y += rows) {
        const int count = std::min(rows, image.height - y);
        send_bytes(tev_update(image, y, count, interleaved(snapshot, y, count)));
    }
}

/// Throws std::runtime_error where the viewer is gone or takes nothing.
void TevViewer::send_bytes(const std::string& bytes) {
    for (size_t sent = 0; sent < bytes.size();) {
        const ssize_t count = send(socket_.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (count > 0)
            sent += size_t(count);
        else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            if (const int error = wait_for_room(socket_.get(), patience_.still))
                throw std::runtime_error(error == ETIMEDOUT ? "it takes no data any more"
                                                            : std::strerror(error));
        } else if (errno != EINTR)
            throw std::runtime_error(errno == EPIPE || errno == ECONNRESET ? "it has closed the connection"
                                                                           : std::strerror(errno));
    }
}

} // namespace clrt
