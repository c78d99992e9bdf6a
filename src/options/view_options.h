// SPDX-License-Identifier: Apache-2.0
// Who sees the picture while it is rendered.
#pragma once

#include <optional>
#include <string>

namespace clrt {

/// Where tev listens.
struct DisplayServer {
    std::string host; ///< name or address, without brackets
    int port = 0;     ///< 1 to 65535
};

struct ViewOptions {
    std::optional<DisplayServer> display_server;
    std::optional<int> serve_port; ///< of the page on this machine; 0: any that is free
    bool serve_stays = false;      ///< the page is served on when the render is done
};

inline bool is_viewed(const ViewOptions& options) {
    return options.display_server || options.serve_port;
}

} // namespace clrt
