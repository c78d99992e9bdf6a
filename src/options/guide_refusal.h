// SPDX-License-Identifier: Apache-2.0
// What path guiding does not go with.
#pragma once

#include "options/options.h"

#include <optional>

namespace clrt {

/// An option that keeps a render from being guided.
struct GuideRefusal {
    const char* option; ///< its name
    const char* reason; ///< why
};

/// None where the options let paths be guided.
std::optional<GuideRefusal> guide_refusal(const Options& options);

/// Whether the render may be guided: by `--guide on`, or by `--guide auto` if it is worthwhile.
bool may_guide(const Options& options);

} // namespace clrt
