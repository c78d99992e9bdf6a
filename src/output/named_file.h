// SPDX-License-Identifier: Apache-2.0
// A file and its part in a run.
#pragma once

#include <string>

namespace clrt {

/// A file that a run reads or writes.
struct NamedFile {
    std::string name; ///< of its part, as messages say it: "the texture"; of a result, the option: "--stats"
    std::string path;
};

} // namespace clrt
