// SPDX-License-Identifier: Apache-2.0
// --serve and --display-server: what they take, and what they refuse.
#include "host/command_line_support.h"

#include <gtest/gtest.h>

namespace clrt {

TEST(ViewOption, PortsAndHostsArrive) {
    EXPECT_FALSE(is_viewed(parse({}).view));
    const ViewOptions page = parse({"--serve", "8080"}).view;
    EXPECT_EQ(page.serve_port, 8080);
    EXPECT_FALSE(page.serve_stays);
    EXPECT_TRUE(parse({"--serve", "0,stay"}).view.serve_stays);
    const ViewOptions tev = parse({"--display-server", "[::1]:14158"}).view;
    EXPECT_EQ(tev.display_server->host, "::1");
    EXPECT_EQ(tev.display_server->port, 14158);
    const Options both = parse({"--serve", "1", "--display-server", "box:2", "--spp", "8"});
    EXPECT_EQ(both.run.resumable_command, (std::vector<std::string>{"clrt", "--spp=8", "--", "scene.obj"}))
        << "who sees a run is of that run alone";
}

TEST(ViewOption, WhatIsNoPortOrHostIsRefused) {
    for (const char* text : {"-1", "65536", ",stay", "0,leave", "0,stay,stay", "tev", "8080 "})
        EXPECT_EQ(refusal({"--serve", text, "s.obj"})
                      .find("option --serve: expected a whole number from 0 to 65535"),
                  0u)
            << text;
    for (const char* text :
         {"localhost", ":14158", "::1:14158", "[::1:14158", "http://localhost:14158", "a b:1"})
        EXPECT_EQ(refusal({"--display-server", text, "s.obj"})
                      .find("option --display-server: expected HOST:PORT such as localhost:14158"),
                  0u)
            << text;
    for (const char* text : {"localhost:0", "localhost:65536", "localhost:tev", "localhost:"})
        EXPECT_EQ(refusal({"--display-server", text, "s.obj"})
                      .find("option --display-server: expected a whole number from 1 to 65535"),
                  0u)
            << text;
}

TEST(ViewOption, OnlyARenderIsSeen) {
    for (const std::string other : {"--explain", "--ledger", "--pixel=1,2"})
        for (const std::string view : {"--serve=0", "--display-server=localhost:14158"}) {
            const auto name = [](const std::string& option) { return option.substr(0, option.find('=')); };
            EXPECT_EQ(refusal({view, other, "s.obj"}),
                      "options " + name(view) + " and " + name(other) +
                          ": expected one of them, found both; there is no picture to be seen");
        }
}

} // namespace clrt
