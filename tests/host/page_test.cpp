// SPDX-License-Identifier: Apache-2.0
// --serve: who is let through, and what is answered. Without a server: tests/cli/view_command_test.py has
// one.
#include "output/tonemap.h"
#include "view/page_answers.h"
#include "view/page_guard.h"
#include "view/page_picture.h"
#include "view/show_pace.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace clrt {

namespace {

const PageAddress ADDRESS{"0123456789abcdef0123456789abcdef", 4711};

HttpRequest request_of(const std::string& name, const std::string& method = "GET") {
    return {method, "/" + ADDRESS.token + "/" + name, {}, {"127.0.0.1:4711"}, {}};
}

/// The status that a request gets; 0 where it may be answered.
int refusal_of(const HttpRequest& request) {
    const auto refusal = page_refusal(ADDRESS, request);
    return refusal ? refusal->status : 0;
}

SnapshotPointer three_pixels() {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->width = 3;
    snapshot->height = 1;
    snapshot->x0 = 10;
    snapshot->y0 = 20;
    snapshot->rgb = {0, 0, 0, 0.25f, 0.5f, 1, 4, 4, 4};
    snapshot->errors = {0, 0.02f, 2};
    snapshot->error = FilmError{0.2, 0.1, 0.3};
    snapshot->samples = 64;
    return snapshot;
}

class PageAnswer : public testing::Test {
protected:
    HttpResponse ask(const std::string& name, const std::map<std::string, std::string>& query = {},
                     const std::string& method = "GET") {
        HttpRequest request = request_of(name, method);
        request.query = query;
        return page_answer(board, facts, request, asked_name(ADDRESS, request));
    }
    nlohmann::json state() { return nlohmann::json::parse(ask("state", {{"page", "a"}}).body); }

    PageBoard board;
    PageFacts facts;
};

} // namespace

TEST(PageGuard, TheAddressThatIsPrintedIsLetThrough) {
    EXPECT_EQ(page_url(ADDRESS), "http://127.0.0.1:4711/0123456789abcdef0123456789abcdef/");
    EXPECT_EQ(refusal_of(request_of("")), 0);
    EXPECT_EQ(asked_name(ADDRESS, request_of("state")), "state");
    HttpRequest by_name = request_of("");
    by_name.hosts = {"localhost:4711"};
    by_name.origins = {"http://localhost:4711"};
    EXPECT_EQ(refusal_of(by_name), 0);
}

TEST(PageGuard, ForeignHostsAreNotLetThrough) {
    using Hosts = std::vector<std::string>;
    for (const Hosts& hosts : {Hosts{}, Hosts{"example.org"}, Hosts{"example.org:4711"}, Hosts{"127.0.0.1"},
                               Hosts{"127.0.0.1:4712"}, Hosts{"127.0.0.1:47110"}, Hosts{"127.0.0.1:4711."},
                               Hosts{"localhost.example.org:4711"}, Hosts{"0.0.0.0:4711"}, Hosts{""},
                               Hosts{"127.0.0.1:4711", "127.0.0.1:4711"}}) {
        HttpRequest request = request_of("");
        request.hosts = hosts;
        EXPECT_EQ(refusal_of(request), 403) << (hosts.empty() ? "none" : hosts[0]);
    }
}

TEST(PageGuard, ForeignOriginsAreNotLetThrough) {
    using Origins = std::vector<std::string>;
    for (const Origins& origins :
         {Origins{"http://example.org"}, Origins{"null"}, Origins{"https://127.0.0.1:4711"},
          Origins{"http://127.0.0.1"}, Origins{"http://127.0.0.1:4712"}, Origins{"http://localhost:4711"},
          Origins{""}, Origins{"http://127.0.0.1:4711", "http://127.0.0.1:4711"}}) {
        HttpRequest request = request_of("stop", "POST");
        request.origins = origins;
        EXPECT_EQ(refusal_of(request), 403) << origins[0];
    }
}

TEST(PageGuard, WithoutTheTokenThereIsNothing) {
    for (const std::string path :
         {"", "/", "/state", "/favicon.ico", "/0123456789abcdef0123456789abcdef",
          "/0123456789abcdef0123456789abcdeF/", "//0123456789abcdef0123456789abcde/",
          "/0123456789abcdef0123456789abcdef0/", "0123456789abcdef0123456789abcdef/"}) {
        HttpRequest request = request_of("");
        request.path = path;
        EXPECT_EQ(refusal_of(request), 404) << path;
    }
}

TEST(PageGuard, TokensAreLongAndNeverTheSame) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_NE(token, random_token());
}

TEST_F(PageAnswer, ThePageHasANonceOfItsOwnAndAPolicy) {
    const HttpResponse page = ask(""), other = ask("");
    EXPECT_EQ(page.body.find("@NONCE@"), std::string::npos);
    EXPECT_NE(page.body, other.body) << "the nonce";
    const auto policy = std::find_if(page.headers.begin(), page.headers.end(), [](const auto& header) {
                            return header.first == "Content-Security-Policy";
                        })->second;
    for (const char* part :
         {"default-src 'none'", "connect-src 'self'", "frame-ancestors 'none'", "script-src 'nonce-"})
        EXPECT_NE(policy.find(part), std::string::npos) << policy;
    EXPECT_EQ(policy.find("unsafe"), std::string::npos);
    for (const char* foreign : {"https:", "//cdn", "src=\"", "@import", "innerHTML", "eval("})
        EXPECT_EQ(page.body.find(foreign), std::string::npos) << foreign;
}

TEST_F(PageAnswer, OtherNamesAndMethodsAreRefused) {
    EXPECT_EQ(ask("nothing").status, 404);
    EXPECT_EQ(ask("state/").status, 404);
    for (const char* deed : {"stop", "save", "goodbye"})
        EXPECT_EQ(ask(deed).status, 405) << deed << " is no link";
    for (const char* thing : {"", "state", "picture.bmp", "error.bmp", "path"})
        EXPECT_EQ(ask(thing, {}, "POST").status, 405) << thing;
}

TEST_F(PageAnswer, TheStateTellsWhatIsKnown) {
    EXPECT_TRUE(state()["picture"].is_null());
    EXPECT_TRUE(state()["progress"]["fraction"].is_null());
    EXPECT_TRUE(state()["end"].is_null());
    board.set_title("a\xff.obj"); // no text
    ProgressState progress{"render", 0.25, 16, 2e6, 0.1, false, ProgressTarget{0.02, 30, 24, -1}};
    board.set_progress(progress, 10);
    board.set_snapshot(three_pixels(), 1.5);
    board.set_message("saved");
    board.set_end("done");
    const nlohmann::json json = state();
    EXPECT_EQ(json["progress"]["seconds_to_go"], nullptr) << "the error comes first";
    EXPECT_EQ(json["progress"]["target"]["seconds"], 30);
    EXPECT_EQ(json["progress"]["target"]["high"], nullptr);
    EXPECT_EQ(json["picture"]["version"], 1);
    EXPECT_EQ(json["picture"]["x"], 10);
    EXPECT_EQ(json["picture"]["exposure"], 1.5);
    EXPECT_EQ(json["picture"]["error"]["high"], 0.3);
    EXPECT_EQ(json["message"], "saved");
    EXPECT_EQ(json["end"], "done");
    EXPECT_EQ(json["tonemaps"].size(), 5u);
}

TEST_F(PageAnswer, ThePictureIsThatOfThePng) {
    EXPECT_EQ(ask("picture.bmp").status, 404);
    board.set_snapshot(three_pixels(), 0);
    const std::string bmp = ask("picture.bmp", {{"exposure", "-1"}, {"tonemap", "aces"}}).body;
    ASSERT_EQ(bmp.size(), 54u + 12) << "rows are padded to four bytes";
    EXPECT_EQ(bmp.substr(0, 2), "BM");
    const auto colour = display_colour({0.25, 0.5, 1}, 0.5, Tonemap::ACES);
    for (size_t c = 0; c < 3; ++c)
        EXPECT_EQ(std::uint8_t(bmp[54 + 3 + c]), colour[2 - c]);
    facts.tonemap = Tonemap::ACES;
    board.set_snapshot(three_pixels(), -1);
    EXPECT_EQ(ask("picture.bmp").body, bmp) << "the run's own look is the default";
    for (const char* odd : {"x", "", "1e9", "nan", "-1x"})
        EXPECT_EQ(ask("picture.bmp", {{"exposure", odd}, {"tonemap", "odd"}}).body, bmp) << odd;
}

TEST(PagePicture, LargeOnesAreThinnedOut) {
    Snapshot snapshot;
    snapshot.width = 7;
    snapshot.height = 5;
    for (int i = 0; i < 3 * 7 * 5; ++i)
        snapshot.rgb.push_back(float(i / 3) / 64);
    const std::string bmp = page_picture(snapshot, 0, Tonemap::NONE, 12);
    ASSERT_EQ(bmp.size(), 54u + 3 * 12) << "4 x 3";
    EXPECT_EQ(bmp[18], 4);
    EXPECT_EQ(bmp[22], char(-3));
    for (size_t y = 0; y < 3; ++y)
        for (size_t x = 0; x < 4; ++x) {
            const double shown = double(2 * y * 7 + 2 * x) / 64;
            EXPECT_EQ(std::uint8_t(bmp[54 + 12 * y + 3 * x]),
                      display_colour({shown, shown, shown}, 1, Tonemap::NONE)[0]);
        }
    EXPECT_EQ(page_error_map(snapshot, 12).size(), bmp.size());
}

TEST_F(PageAnswer, TheErrorMapGoesFromATenthToTenTimesTheError) {
    board.set_snapshot(three_pixels(), 0);
    const nlohmann::json scale = state()["picture"]["scale"];
    EXPECT_NEAR(double(scale["low"]), 0.02, 1e-12);
    EXPECT_NEAR(double(scale["high"]), 2, 1e-12);
    const std::string bmp = ask("error.bmp").body;
    const auto colour_at = [&](size_t pixel) {
        char text[8];
        std::snprintf(text, sizeof text, "#%02x%02x%02x", std::uint8_t(bmp[54 + 3 * pixel + 2]),
                      std::uint8_t(bmp[54 + 3 * pixel + 1]), std::uint8_t(bmp[54 + 3 * pixel]));
        return std::string(text);
    };
    EXPECT_EQ(colour_at(0), "#000000") << "no error is known to be there";
    EXPECT_EQ(colour_at(1), scale["colours"].front());
    EXPECT_EQ(colour_at(2), scale["colours"].back());
}

TEST_F(PageAnswer, PathsAreAskedOfTheRenderInTheWindow) {
    const auto error_of = [&](const std::map<std::string, std::string>& query) {
        return nlohmann::json::parse(ask("path", query).body)["error"];
    };
    EXPECT_EQ(error_of({{"x", "10"}, {"y", "20"}}), "there is no picture yet");
    board.set_snapshot(three_pixels(), 0);
    EXPECT_EQ(error_of({{"x", "13"}, {"y", "20"}}), "expected a pixel of the picture");
    EXPECT_EQ(error_of({{"x", "10"}}), "expected a pixel of the picture");
    EXPECT_EQ(error_of({{"x", "10"}, {"y", "20"}}), "paths are known while the picture is rendered");
    facts.no_paths = "chains";
    EXPECT_EQ(error_of({{"x", "10"}, {"y", "20"}}), "chains");

    facts.no_paths = "";
    board.set_answering(true);
    std::thread render([&] {
        bool is_answered = false;
        while (!is_answered) {
            board.wait_for_question(std::chrono::milliseconds(10));
            board.answer_questions([&](const PathQuestion& question) {
                is_answered = true;
                return ::clrt::PathAnswer{
                    "text", "[" + std::to_string(question.x + question.y + int(question.sample)) + "]", ""};
            });
        }
    });
    const auto json = nlohmann::json::parse(ask("path", {{"x", "12"}, {"y", "20"}, {"sample", "5"}}).body);
    render.join();
    EXPECT_EQ(json["error"], nullptr);
    EXPECT_EQ(json["record"], nlohmann::json::parse("[37]"));

    // A question that waits when the render ends is answered, too.
    std::thread end([&] {
        board.wait_for_question(std::chrono::seconds(5));
        board.set_answering(false);
    });
    EXPECT_EQ(error_of({{"x", "12"}, {"y", "20"}}), "paths are known while the picture is rendered");
    end.join();
}

TEST_F(PageAnswer, SavingIsAskedForOnce) {
    EXPECT_FALSE(board.take_saving());
    EXPECT_EQ(ask("save", {}, "POST").status, 202);
    EXPECT_TRUE(board.take_saving());
    EXPECT_FALSE(board.take_saving());
}

TEST_F(PageAnswer, PicturesAreMadeForPagesInSightAndTheEndWaitsForAll) {
    EXPECT_FALSE(board.is_watched());
    const auto all_are_gone = [&] { return board.wait_for_goodbyes(std::chrono::milliseconds(30)); };
    EXPECT_TRUE(all_are_gone()) << "nobody came";
    ask("state", {{"page", "a"}, {"away", "1"}});
    EXPECT_FALSE(board.is_watched());
    EXPECT_FALSE(all_are_gone());
    ask("state", {{"page", "a"}});
    EXPECT_TRUE(board.is_watched());
    ask("goodbye", {{"page", "a"}}, "POST");
    EXPECT_TRUE(all_are_gone());
}

TEST(ShowPace, TakesATwentiethOfTheRenderAtMost) {
    ShowPace::Clock::time_point now{};
    using std::chrono::milliseconds;
    ShowPace pace([&] { return now; });
    EXPECT_TRUE(pace.is_due()) << "the first samples";
    const auto show = [&](milliseconds cost) {
        pace.begin();
        now += cost;
        pace.end();
    };
    show(milliseconds(1));
    now += milliseconds(499);
    EXPECT_FALSE(pace.is_due());
    now += milliseconds(1);
    EXPECT_TRUE(pace.is_due());
    show(milliseconds(100));
    now += milliseconds(1899);
    EXPECT_FALSE(pace.is_due());
    now += milliseconds(1);
    EXPECT_TRUE(pace.is_due());
}

} // namespace clrt
