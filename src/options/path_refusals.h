// SPDX-License-Identifier: Apache-2.0
// What path guiding and path reuse do not go with.
#pragma once

#include "options/options.h"

#include <optional>

namespace clrt {

/// An option that keeps the paths of a render from being guided or reused.
struct PathRefusal {
    const char* option; ///< its name
    const char* reason; ///< why
};

/// None where the options let paths be guided.
std::optional<PathRefusal> guide_refusal(const Options& options);

/// None where the options let paths be reused.
std::optional<PathRefusal> reuse_refusal(const Options& options);

/// Whether the render may be guided: by `--guide on`, or by `--guide auto` if it is worthwhile.
bool may_guide(const Options& options);

} // namespace clrt
