// SPDX-License-Identifier: Apache-2.0
// Values that follow from several options.
#include "options/options.h"

namespace clrt {

int effective_max_depth(const TransportOptions& transport) {
    const int usual = integrator_row(transport.integrator).depth.usual;
    return takes_option(transport.integrator, TAKES_MAX_DEPTH) ? transport.max_depth.value_or(usual) : usual;
}

bool is_adaptive(const Options& options) {
    return options.sampling.adaptive &&
           integrator_row(options.transport.integrator).film == FilmAccess::GATHER;
}

bool has_transparent_background(const LightOptions& light) {
    return light.background && light.background->is_transparent;
}

} // namespace clrt
