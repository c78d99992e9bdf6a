// SPDX-License-Identifier: Apache-2.0
// Values of events for people: choices by their names, lengths and positions in scene units.
#pragma once

#include "replay/replay.h"

#include <string>
#include <vector>

namespace clrt {

/// A choice in words: "front", "refraction", `12 of "wall", material "white"`.
std::string choice_text(const TraceEvent& event, const Scene& scene);

/// The numbers of an event in scene units.
std::vector<double> event_values(const SampleTrace& trace, const TraceEvent& event, const Scene& scene);

/// The numbers of an event as the kernel has them, hexadecimal.
std::vector<std::string> event_hex(const SampleTrace& trace, const TraceEvent& event);

} // namespace clrt
