// SPDX-License-Identifier: Apache-2.0
// An HTTP server for this machine alone, by cpp-httplib. Few runs want one, and it brings OpenSSL along, so
// it is loaded when the first does. It may be missing: it is built where its library is there.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// What a client asks for. Bodies are not read.
struct HttpRequest {
    std::string method;                       ///< "GET"
    std::string path;                         ///< decoded, without what stands behind '?'
    std::map<std::string, std::string> query; ///< what stands there, decoded; of equal names one
    std::vector<std::string> hosts, origins;  ///< the values of these headers, each as often as it is given
};

struct HttpResponse {
    int status = 200;
    std::string type; ///< of the body: "text/html; charset=utf-8"
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers; ///< further ones
};

/// Answers every request; called by several threads at once. Must not throw.
using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

/// Listens and answers in threads of its own from its construction to its destruction, which waits until
/// everything that was asked is answered.
class HttpServer {
public:
    virtual ~HttpServer() = default;
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;
    /// Where it listens.
    virtual int port() const = 0;

protected:
    HttpServer() = default;
};

/// What the loaded library offers.
class HttpLibrary {
public:
    /// Listens on this port of 127.0.0.1; 0: on one that is free. Null where the port cannot be had.
    virtual std::unique_ptr<HttpServer> listen(int port, HttpHandler handler) const = 0;

protected:
    ~HttpLibrary() = default;
};

/// The library, loaded at the first call; threads may call it. Throws std::runtime_error where it is not
/// there.
const HttpLibrary& http_library();

/// The only function that the loaded file exports, of this type and name. The number changes with this
/// header.
using HttpLibraryEntry = const HttpLibrary*();
constexpr const char* HTTP_LIBRARY_ENTRY = "clrt_http_library_1";

} // namespace clrt
