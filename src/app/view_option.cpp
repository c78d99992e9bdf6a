// SPDX-License-Identifier: Apache-2.0
#include "app/view_option.h"

namespace clrt {

namespace {

constexpr std::int64_t LARGEST_PORT = 65535;

} // namespace

const char* const DISPLAY_SERVER_HELP = "show the picture while it grows, and its error, in the viewer tev, "
                                        "which listens on localhost:14158; one "
                                        "that falls behind gets fewer pictures, one that vanishes is left";
const char* const SERVE_HELP =
    "show it on a page in the browser of this machine, at the address that is printed: picture, error map, "
    "report, the path of a clicked pixel, stop and save; port 0 is any that is free; with ,stay also after "
    "the end, until Ctrl-C";

void apply_display_server(Options& options, const OptionValue& value) {
    const std::string expected = "HOST:PORT such as localhost:14158, where tev listens";
    const size_t colon = value.text.rfind(':');
    if (colon == std::string::npos || colon == 0)
        reject_value(value, expected);
    DisplayServer server;
    server.host = value.text.substr(0, colon);
    const bool is_bracketed =
        server.host.size() > 2 && server.host.front() == '[' && server.host.back() == ']';
    if (is_bracketed)
        server.host = server.host.substr(1, server.host.size() - 2);
    else if (server.host.find_first_of(":[]/ ") != std::string::npos)
        reject_value(value, expected);
    OptionValue port = value;
    port.text = value.text.substr(colon + 1);
    server.port = int(parse_whole(port, 1, LARGEST_PORT));
    options.view.display_server = server;
}

void apply_serve(Options& options, const OptionValue& value) {
    const std::string stay = ",stay";
    OptionValue port = value;
    options.view.serve_stays = value.text.size() > stay.size() &&
                               value.text.compare(value.text.size() - stay.size(), stay.size(), stay) == 0;
    if (options.view.serve_stays)
        port.text.resize(value.text.size() - stay.size());
    options.view.serve_port = int(parse_whole(port, 0, LARGEST_PORT));
}

} // namespace clrt
