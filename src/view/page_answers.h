// SPDX-License-Identifier: Apache-2.0
// What the page's requests are answered with.
#pragma once

#include "http/http_server.h"
#include "options/output_options.h"
#include "view/page_board.h"

#include <map>
#include <optional>
#include <string>

namespace clrt {

/// What does not change while the page is served.
struct PageFacts {
    Tonemap tonemap = Tonemap::NONE; ///< of the PNG
    std::optional<double> error;     ///< that is asked for
    bool can_save = true;            ///< pictures or films go to files
    bool stays = false;              ///< served on after the end
    std::string no_paths;            ///< why no path can be shown; empty: it can
};

/// The state as JSON; what is not known is null.
std::string state_json(const PageState& state, const PageFacts& facts);

/// The answer to a request that may be answered (page_guard.h), by the name of what it asks for:
///
///     GET  ""            the page
///     GET  state         ?page=NAME: the state; NAME is looking on; away=1: out of sight
///     GET  picture.bmp   ?exposure=EV&tonemap=NAME: the picture so far
///     GET  error.bmp     its error map
///     GET  path          ?x=X&y=Y&sample=N: the path of that sample
///     POST stop, save    as Ctrl-C and --save-every do
///     POST goodbye       ?page=NAME: NAME has all that it wants
HttpResponse page_answer(PageBoard& board, const PageFacts& facts, const HttpRequest& request,
                         const std::string& name);

/// Adds what keeps browsers from loading, running, keeping or framing anything else. `nonce`: of the page's
/// own script and style.
void add_page_headers(const std::string& nonce, HttpResponse& response);

/// The files that were embedded when the program was built: "page.html", in which "@NONCE@" stands for the
/// nonce.
const std::map<std::string, std::string>& page_files();

} // namespace clrt
