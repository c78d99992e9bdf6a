// SPDX-License-Identifier: Apache-2.0
// How far a guide has come, in the header of a film file.
#pragma once

#include "guide/guide_progress.h"

#include <nlohmann/json.hpp>

namespace clrt {

/// Everything but what the cells have learnt, of which it holds the numbers of nodes and cells.
nlohmann::ordered_json guide_header(const GuideProgress& guide);

/// The same back, with room for nodes, cells and sums. Throws nlohmann::json::exception where something is
/// missing, of another type, or more than a guide can have.
GuideProgress guide_of_header(const nlohmann::ordered_json& header);

/// Whether the trees that were read behind it can be those of a guide: links lead on, to nodes and cells that
/// there are.
bool is_possible(const GuideProgress& guide);

} // namespace clrt
