// SPDX-License-Identifier: Apache-2.0
// What choices that touch every kernel cost: whole pictures, rendered in turns with and without.
#pragma once

#include "stability/probe_set.h"

#include <functional>
#include <string>
#include <vector>

namespace clrt {

/// A picture rendered by other kernels than clrt's own, against clrt's.
struct RenderCost {
    std::string choice; ///< "the compiler may contract a b + c"
    std::string scene;  ///< of those that clrt ships
    ProbeTime time; ///< device_seconds() of a picture: naive is clrt's, single the other one's, ratio other
                    ///< over clrt's
    double difference = 0; ///< RMS difference of the pictures over clrt's mean; same random numbers
    double noise = 0;      ///< relative error of clrt's picture, to compare with
    std::string error;     ///< why there are no figures; empty: there are
};

/// Rounds of a timing of whole pictures.
constexpr int PICTURE_ROUNDS = 7;

/// Renders all of them, a minute or two in PICTURE_ROUNDS; `tell` hears which one is next.
std::vector<RenderCost> measure_render_costs(const ProbeDevice& device, int rounds,
                                             const std::function<void(const std::string&)>& tell);

} // namespace clrt
