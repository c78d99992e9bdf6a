// SPDX-License-Identifier: Apache-2.0
// What a fuzz target is: a function that reads any bytes as a kind of input. It returns for good and for bad
// input alike; a broken promise ends the process. Both drivers call it: that of the test suite (driver.cpp)
// and libFuzzer.
#pragma once

#include "probes/scratch_folder.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// Reads one input; libFuzzer's name and type.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size);

namespace clrt {

/// Ends the process if what a reader promises does not hold.
inline void promise(bool holds, const char* what) {
    if (holds)
        return;
    std::fprintf(stderr, "broken promise: %s\n", what);
    std::abort();
}

/// The input as text.
inline std::string_view as_text(const std::uint8_t* data, size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// The folder for the files of a target; one for the whole process.
inline const ScratchFolder& fuzz_folder() {
    static const ScratchFolder folder;
    return folder;
}

} // namespace clrt
