// SPDX-License-Identifier: Apache-2.0
// Values that follow from several options.
#include "app/options.h"

namespace clrt {

int effective_max_depth(const Options& options) {
    switch (options.integrator) {
    case Integrator::RAYCAST:
        return 2;
    case Integrator::WHITTED:
        return options.max_depth.value_or(DEFAULT_WHITTED_DEPTH);
    case Integrator::PATH:
        break;
    }
    return options.max_depth.value_or(DEFAULT_PATH_DEPTH);
}

bool has_transparent_background(const Options& options) {
    return options.light.background && options.light.background->is_transparent;
}

} // namespace clrt
