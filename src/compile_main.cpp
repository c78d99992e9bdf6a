// SPDX-License-Identifier: Apache-2.0
// clrt-compile: compiles a program that clrt will want, into the cache where it will look for it
// (device/compile_ahead.h). What to compile comes on stdin. clrt runs it, nobody else has to.
#include "device/compile_ahead.h"
#include "exit_code.h"

#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <iterator>
#include <spdlog/spdlog.h>
#include <string>
#include <sys/prctl.h>

int main(int argc, char**) {
    if (argc > 1) {
        std::fputs("clrt-compile: clrt runs it by itself; there is nothing to do for you\n", stderr);
        return clrt::EXIT_USAGE;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL); // what is compiled is of use to the run alone that asked for it
    spdlog::set_level(spdlog::level::off);
    try {
        clrt::compile_from_text(
            std::string(std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "clrt-compile: %s\n", error.what());
        return clrt::EXIT_DEVICE; // clrt compiles it itself then, and says what is wrong
    }
    return clrt::EXIT_DONE;
}
