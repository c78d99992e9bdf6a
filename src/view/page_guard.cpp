// SPDX-License-Identifier: Apache-2.0
#include "view/page_guard.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <stdexcept>
#include <sys/random.h>

namespace clrt {

namespace {

constexpr size_t TOKEN_BYTES = 16;

/// The same time for every text of the length, so that no prefix of a token can be found out.
bool equal_secrets(const std::string& a, const std::string& b) {
    if (a.size() != b.size())
        return false;
    unsigned difference = 0;
    for (size_t i = 0; i < a.size(); ++i)
        difference |= unsigned(a[i] ^ b[i]);
    return difference == 0;
}

} // namespace

std::string random_token() {
    std::array<std::uint8_t, TOKEN_BYTES> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
        throw std::runtime_error("the system gives no random numbers for the page's address");
    std::string token;
    for (const std::uint8_t byte : bytes)
        token += fmt::format("{:02x}", byte);
    return token;
}

std::string page_url(const PageAddress& address) {
    return fmt::format("http://127.0.0.1:{}/{}/", address.port, address.token);
}

HttpResponse text_response(int status, const std::string& text) {
    return {status, "text/plain; charset=utf-8", text + "\n", {}};
}

std::optional<HttpResponse> page_refusal(const PageAddress& address, const HttpRequest& request) {
    const std::string hosts[] = {fmt::format("127.0.0.1:{}", address.port),
                                 fmt::format("localhost:{}", address.port)};
    const bool is_host_ours = request.hosts.size() == 1 && std::find(std::begin(hosts), std::end(hosts),
                                                                     request.hosts[0]) != std::end(hosts);
    if (!is_host_ours)
        return text_response(403, "expected the address that clrt printed, found another host");
    if (request.origins.size() > 1 ||
        (request.origins.size() == 1 && request.origins[0] != "http://" + request.hosts[0]))
        return text_response(403, "expected a request of clrt's own page, found another origin");
    const std::string prefix = request.path.substr(0, address.token.size() + 2);
    if (!equal_secrets(prefix, "/" + address.token + "/"))
        return text_response(404, "expected the whole address that clrt printed");
    return std::nullopt;
}

std::string asked_name(const PageAddress& address, const HttpRequest& request) {
    return request.path.substr(address.token.size() + 2);
}

} // namespace clrt
