// SPDX-License-Identifier: Apache-2.0
// What is loaded: cpp-httplib behind HttpServer, and the function that http_library() looks up.
#include "http/http_server.h"

#include <httplib.h>
#include <sys/socket.h>
#include <thread>

namespace clrt {

namespace {

constexpr const char* LOOPBACK = "127.0.0.1";
/// Requests that are answered at once: a browser opens six connections, and one may wait for a path.
constexpr size_t THREADS = 8;
/// A client that says nothing for so long is left, seconds. The end of a run may wait for it.
constexpr time_t LONGEST_SILENCE = 1;
/// A client that takes nothing for so long is left, seconds.
constexpr time_t LONGEST_WRITE = 3;

std::vector<std::string> header_values(const httplib::Request& request, const char* name) {
    std::vector<std::string> values;
    const auto [first, end] = request.headers.equal_range(name);
    for (auto header = first; header != end; ++header)
        values.push_back(header->second);
    return values;
}

class LoopbackServer final : public HttpServer {
public:
    explicit LoopbackServer(HttpHandler handler) : handler_(std::move(handler)) {
        // The library's own choice lets a second server have a port that is taken.
        server_.set_socket_options([](socket_t socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        server_.new_task_queue = [] { return new httplib::ThreadPool(THREADS); };
        server_.set_keep_alive_max_count(1);
        server_.set_keep_alive_timeout(LONGEST_SILENCE);
        server_.set_read_timeout(LONGEST_SILENCE);
        server_.set_write_timeout(LONGEST_WRITE);
        server_.set_tcp_nodelay(true);
        server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            answer(request, response);
            return httplib::Server::HandlerResponse::Handled;
        });
    }
    ~LoopbackServer() override {
        if (!thread_.joinable())
            return;
        server_.stop();
        thread_.join();
    }
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;

    bool listen(int port) {
        port_ = port == 0                              ? server_.bind_to_any_port(LOOPBACK)
                : server_.bind_to_port(LOOPBACK, port) ? port
                                                       : -1;
        if (port_ <= 0)
            return false;
        thread_ = std::thread([this] { server_.listen_after_bind(); });
        while (!server_.is_running()) // else stop() would do nothing
            std::this_thread::yield();
        return true;
    }
    int port() const override { return port_; }

private:
    void answer(const httplib::Request& request, httplib::Response& response) const {
        HttpRequest asked{request.method,
                          request.path,
                          {},
                          header_values(request, "Host"),
                          header_values(request, "Origin")};
        for (const auto& [name, value] : request.params)
            asked.query.emplace(name, value);
        HttpResponse answered = handler_(asked);
        response.status = answered.status;
        for (const auto& [name, value] : answered.headers)
            response.set_header(name, value);
        response.set_content(std::move(answered.body), answered.type);
    }

    HttpHandler handler_;
    httplib::Server server_;
    int port_ = -1;
    std::thread thread_;
};

class LinkedHttp final : public HttpLibrary {
public:
    std::unique_ptr<HttpServer> listen(int port, HttpHandler handler) const override {
        auto server = std::make_unique<LoopbackServer>(std::move(handler));
        if (!server->listen(port))
            return nullptr;
        return server;
    }
};

} // namespace

} // namespace clrt

/// Named by HTTP_LIBRARY_ENTRY.
extern "C" __attribute__((visibility("default"))) const clrt::HttpLibrary* clrt_http_library_1() {
    static const clrt::LinkedHttp http;
    return &http;
}
