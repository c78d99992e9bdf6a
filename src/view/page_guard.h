// SPDX-License-Identifier: Apache-2.0
// Who may see the page: whoever has its address, in a browser of this machine, and no page of anybody else
// that guesses or has its name lead here.
#pragma once

#include "http/http_server.h"

#include <optional>
#include <string>

namespace clrt {

/// 128 random bits of the system as 32 hexadecimal digits. Throws std::runtime_error where it has none.
std::string random_token();

/// Where the page is.
struct PageAddress {
    std::string token;
    int port = 0;
};

/// "http://127.0.0.1:PORT/TOKEN/".
std::string page_url(const PageAddress& address);

/// A short text as an answer.
HttpResponse text_response(int status, const std::string& text);

/// Why a request is not answered, in the order of the checks: 403 unless it has one header Host and that
/// names this machine and port, so that no foreign name can be made to lead here; 403 for an Origin that is
/// not the page's own; 404 without the token, whatever else it asks for. None: it may be answered.
std::optional<HttpResponse> page_refusal(const PageAddress& address, const HttpRequest& request);

/// What a request that may be answered asks for: what stands behind the token and its slash, "" for the page.
std::string asked_name(const PageAddress& address, const HttpRequest& request);

} // namespace clrt
