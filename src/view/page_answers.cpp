// SPDX-License-Identifier: Apache-2.0
#include "view/page_answers.h"

#include "console/signals.h"
#include "view/page_guard.h"
#include "view/page_picture.h"

#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

using StateJson = nlohmann::ordered_json;

/// Stops that the page can ask for.
constexpr double LARGEST_PAGE_EXPOSURE = 100;
constexpr const char* NONCE_MARK = "@NONCE@";

StateJson known(double value) {
    return value >= 0 ? StateJson(value) : StateJson(nullptr);
}

template <class T>
StateJson known(const std::optional<T>& value) {
    return value ? StateJson(*value) : StateJson(nullptr);
}

StateJson progress_json(const PageState& state) {
    const ProgressState& progress = state.progress;
    StateJson json{{"phase", progress.phase},
                   {"fraction", known(progress.fraction)},
                   {"seconds", state.phase_seconds},
                   {"seconds_to_go", known(seconds_to_go(progress, state.phase_seconds))},
                   {"spp", progress.spp},
                   {"rays_per_second", known(progress.rays_per_second)},
                   {"error", known(progress.error)},
                   {"target", nullptr}};
    if (const auto& target = progress.target)
        json["target"] = {{"error", target->error},
                          {"seconds", target->seconds},
                          {"low", target->low},
                          {"high", known(target->high)}};
    return json;
}

StateJson picture_json(const PageState& state) {
    if (!state.snapshot)
        return nullptr;
    const Snapshot& snapshot = *state.snapshot;
    StateJson json{{"version", state.version},
                   {"width", snapshot.width},
                   {"height", snapshot.height},
                   {"x", snapshot.x0},
                   {"y", snapshot.y0},
                   {"spp", snapshot.samples},
                   {"seconds", snapshot.seconds},
                   {"exposure", state.exposure_ev},
                   {"error", nullptr},
                   {"scale", nullptr}};
    if (snapshot.error)
        json["error"] = {{"value", snapshot.error->relative_rmse},
                         {"low", known(snapshot.error->low)},
                         {"high", known(snapshot.error->high)}};
    if (const std::optional<ErrorScale> scale = error_scale(snapshot))
        json["scale"] = {{"low", scale->low}, {"high", scale->high}, {"colours", scale->colours}};
    return json;
}

/// A number of the query, or `otherwise` where it is none in the range.
template <class T>
T query_number(const HttpRequest& request, const char* name, T low, T high, T otherwise) {
    const auto found = request.query.find(name);
    if (found == request.query.end())
        return otherwise;
    const std::string& text = found->second;
    T value{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    return fault == std::errc() && end == text.data() + text.size() && value >= low && value <= high
               ? value
               : otherwise;
}

/// A page's name: what it calls itself, cut.
std::string page_name(const HttpRequest& request) {
    const auto found = request.query.find("page");
    return found == request.query.end() ? "" : found->second.substr(0, 32);
}

HttpResponse the_page() {
    HttpResponse response{200, "text/html; charset=utf-8", page_files().at("page.html"), {}};
    const std::string nonce = random_token(), mark = NONCE_MARK;
    for (size_t at = response.body.find(mark); at != std::string::npos; at = response.body.find(mark, at))
        response.body.replace(at, mark.size(), nonce);
    add_page_headers(nonce, response);
    return response;
}

HttpResponse the_picture(PageBoard& board, const PageFacts& facts, const HttpRequest& request) {
    const PageState state = board.look(page_name(request));
    if (!state.snapshot)
        return text_response(404, "there is no picture yet");
    const double exposure =
        query_number(request, "exposure", -LARGEST_PAGE_EXPOSURE, LARGEST_PAGE_EXPOSURE, state.exposure_ev);
    const auto asked = request.query.find("tonemap");
    const Tonemap tonemap = asked == request.query.end()
                                ? facts.tonemap
                                : find_named<Tonemap>(asked->second).value_or(facts.tonemap);
    return {200, "image/bmp", page_picture(*state.snapshot, exposure, tonemap), {}};
}

HttpResponse the_error_map(PageBoard& board, const HttpRequest& request) {
    const PageState state = board.look(page_name(request));
    if (!state.snapshot)
        return text_response(404, "there is no picture yet");
    return {200, "image/bmp", page_error_map(*state.snapshot), {}};
}

HttpResponse the_path(PageBoard& board, const PageFacts& facts, const HttpRequest& request) {
    const PageState state = board.look(page_name(request));
    PathQuestion question;
    question.x = query_number(request, "x", 0, 1 << 16, -1);
    question.y = query_number(request, "y", 0, 1 << 16, -1);
    question.sample = query_number<std::uint32_t>(request, "sample", 0, UINT32_MAX, 0);
    PathAnswer answer;
    if (!facts.no_paths.empty())
        answer.error = facts.no_paths;
    else if (!state.snapshot)
        answer.error = "there is no picture yet";
    else if (question.x < state.snapshot->x0 || question.x >= state.snapshot->x0 + state.snapshot->width ||
             question.y < state.snapshot->y0 || question.y >= state.snapshot->y0 + state.snapshot->height)
        answer.error = "expected a pixel of the picture";
    else
        answer = board.ask(question);
    StateJson json{{"error", answer.error.empty() ? StateJson(nullptr) : StateJson(answer.error)},
                   {"text", answer.text},
                   {"record", nullptr},
                   {"guided", state.snapshot && state.snapshot->guided_from &&
                                  question.sample >= *state.snapshot->guided_from}};
    if (!answer.json.empty())
        json["record"] = StateJson::parse(answer.json);
    return {200, "application/json", json.dump(), {}};
}

/// What a request asks to be done.
HttpResponse do_what_is_asked(PageBoard& board, const HttpRequest& request, const std::string& name) {
    if (name == "goodbye") {
        board.goodbye(page_name(request));
        return text_response(200, "goodbye");
    }
    if (name == "save") {
        board.ask_to_save();
        return text_response(202, "saves after this pass");
    }
    board.ask_to_stop();
    request_stop();
    return text_response(202, "stops and saves");
}

HttpResponse method_refusal(const char* allowed) {
    HttpResponse response = text_response(405, std::string("expected the method ") + allowed);
    response.headers.emplace_back("Allow", allowed);
    return response;
}

} // namespace

std::string state_json(const PageState& state, const PageFacts& facts) {
    StateJson json{{"title", state.title},           {"progress", progress_json(state)},
                   {"picture", picture_json(state)}, {"tonemap", name_of(facts.tonemap)},
                   {"tonemaps", StateJson::array()}, {"error_target", known(facts.error)},
                   {"can_save", facts.can_save},     {"no_paths", facts.no_paths},
                   {"message", state.message},       {"is_stopping", state.is_stopping},
                   {"stays", facts.stays},           {"end", known(state.end)}};
    for (const auto& row : NAMES<Tonemap>)
        json["tonemaps"].push_back(row.name);
    // File names may hold bytes that are no text.
    return json.dump(-1, ' ', false, StateJson::error_handler_t::replace);
}

HttpResponse page_answer(PageBoard& board, const PageFacts& facts, const HttpRequest& request,
                         const std::string& name) {
    const bool is_deed = name == "stop" || name == "save" || name == "goodbye";
    const bool is_thing =
        name.empty() || name == "state" || name == "picture.bmp" || name == "error.bmp" || name == "path";
    if (!is_deed && !is_thing)
        return text_response(404, "there is nothing of this name");
    if (request.method != (is_deed ? "POST" : "GET"))
        return method_refusal(is_deed ? "POST" : "GET");
    if (is_deed)
        return do_what_is_asked(board, request, name);
    if (name.empty())
        return the_page();
    if (name == "state")
        return {200,
                "application/json",
                state_json(board.look(page_name(request), request.query.count("away") > 0), facts),
                {}};
    if (name == "path")
        return the_path(board, facts, request);
    return name == "error.bmp" ? the_error_map(board, request) : the_picture(board, facts, request);
}

void add_page_headers(const std::string& nonce, HttpResponse& response) {
    const std::string policy = "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" +
                               nonce +
                               "'; img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; "
                               "form-action 'none'; frame-ancestors 'none'";
    response.headers.emplace_back("Content-Security-Policy", nonce.empty() ? "default-src 'none'" : policy);
    for (const auto& [name, value] : {std::pair{"X-Content-Type-Options", "nosniff"},
                                      {"X-Frame-Options", "DENY"},
                                      {"Referrer-Policy", "no-referrer"},
                                      {"Cross-Origin-Opener-Policy", "same-origin"},
                                      {"Cross-Origin-Resource-Policy", "same-origin"},
                                      {"Cache-Control", "no-store"}})
        response.headers.emplace_back(name, value);
}

} // namespace clrt
