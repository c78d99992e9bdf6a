// SPDX-License-Identifier: Apache-2.0
// Film files: what a run keeps to go on from.
#pragma once

#include <string>

namespace clrt {

/// Between two film files of one run.
constexpr double DEFAULT_CHECKPOINT_SECONDS = 300;

struct FilmFileOptions {
    std::string checkpoint_path;                            ///< film file to write; empty: none
    double checkpoint_seconds = DEFAULT_CHECKPOINT_SECONDS; ///< between two of them
    std::string resume_path;                                ///< film file to go on from; empty: none
    bool force = false; ///< --checkpoint may replace films that hold more, and what is no film
};

} // namespace clrt
