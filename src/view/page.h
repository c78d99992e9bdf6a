// SPDX-License-Identifier: Apache-2.0
// --serve: the page of a run.
#pragma once

#include "view/page_answers.h"
#include "view/page_guard.h"

#include <atomic>
#include <memory>
#include <string>

namespace clrt {

/// Serves the page from its construction to its destruction.
class Page {
public:
    /// Throws UsageError where the port is taken or no server can be loaded.
    Page(int port, PageFacts facts);
    ~Page();
    Page(const Page&) = delete;
    Page& operator=(const Page&) = delete;

    std::string url() const { return page_url({token_, port_}); }
    PageBoard& board() { return board_; }
    const PageFacts& facts() const { return facts_; }

private:
    HttpResponse answer(const HttpRequest& request);

    const PageFacts facts_;
    const std::string token_;
    PageBoard board_;
    std::atomic<int> port_{0}; ///< 0: it is not known yet, and nobody is answered
    std::unique_ptr<HttpServer> server_;
};

} // namespace clrt
