// SPDX-License-Identifier: Apache-2.0
#include "view/page.h"

#include "error.h"

#include <exception>
#include <fmt/format.h>
#include <new>
#include <utility>

namespace clrt {

Page::Page(int port, PageFacts facts) : facts_(std::move(facts)), token_(random_token()) {
    try {
        server_ = http_library().listen(port, [this](const HttpRequest& request) { return answer(request); });
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw UsageError(std::string("option --serve: ") + error.what());
    }
    if (!server_)
        throw UsageError(
            fmt::format("option --serve: expected a port of this machine that is free and that a user "
                        "may take, found {}; 0 takes any that is free",
                        port));
    port_ = server_->port();
}

Page::~Page() {
    board_.set_answering(false); // else the server would wait for answers
}

HttpResponse Page::answer(const HttpRequest& request) {
    const PageAddress address{token_, port_};
    HttpResponse response;
    try {
        const std::optional<HttpResponse> refusal = page_refusal(address, request);
        response = refusal ? *refusal : page_answer(board_, facts_, request, asked_name(address, request));
    } catch (const std::exception& error) {
        response = text_response(500, error.what());
    }
    if (response.headers.empty() || response.type != "text/html; charset=utf-8")
        add_page_headers("", response);
    return response;
}

} // namespace clrt
