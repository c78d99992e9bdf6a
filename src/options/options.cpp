// SPDX-License-Identifier: Apache-2.0
// Values that follow from several options.
#include "options/options.h"

namespace clrt {

int effective_max_depth(const TransportOptions& transport) {
    switch (transport.integrator) {
    case Integrator::RAYCAST:
        return 2;
    case Integrator::WHITTED:
        return transport.max_depth.value_or(DEFAULT_WHITTED_DEPTH);
    case Integrator::PATH:
        break;
    }
    return transport.max_depth.value_or(DEFAULT_PATH_DEPTH);
}

bool has_transparent_background(const LightOptions& light) {
    return light.background && light.background->is_transparent;
}

} // namespace clrt
