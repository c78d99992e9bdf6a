// SPDX-License-Identifier: Apache-2.0
// --display-server: pictures so far for tev, from a thread of its own.
#pragma once

#include "options/view_options.h"
#include "view/snapshot.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace clrt {

/// A socket that is closed with its owner.
class Socket {
public:
    explicit Socket(int descriptor) : descriptor_(descriptor) {}
    ~Socket();
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    int get() const { return descriptor_; }

private:
    int descriptor_;
};

/// How long a viewer is waited for.
struct TevPatience {
    std::chrono::milliseconds connect{3000}; ///< until it answers
    std::chrono::milliseconds still{5000};   ///< while it takes nothing
    std::chrono::milliseconds finish{10000}; ///< until it has the finished picture
};

/// Sends pictures one after the other. While one is on its way others are not taken, so nobody ever waits for
/// a slow viewer; one that takes no byte for a while is given up.
class TevViewer {
public:
    /// Connects. Throws UsageError where nobody listens there.
    explicit TevViewer(const DisplayServer& server, const TevPatience& patience = {});
    ~TevViewer();
    TevViewer(const TevViewer&) = delete;
    TevViewer& operator=(const TevViewer&) = delete;

    /// Whether it would take a picture now.
    bool is_free();
    /// Sends a picture under this name, once the one before is sent.
    void show(SnapshotPointer snapshot, const std::string& name);
    /// Waits until everything is sent; a viewer that takes long is given up.
    void finish();
    /// Why it was given up; empty: it was not.
    std::string loss();

private:
    void run();
    void send_picture(const Snapshot& snapshot, const std::string& name);
    void send_bytes(const std::string& bytes);

    const TevPatience patience_;
    Socket socket_;
    std::mutex mutex_;
    std::condition_variable changed_;
    SnapshotPointer next_; ///< to be sent
    std::string next_name_;
    bool is_sending_ = false, ends_ = false;
    std::string loss_;
    std::string created_; ///< the image that the viewer has; of the thread alone
    std::thread thread_;  ///< the last member: it uses the others
};

} // namespace clrt
