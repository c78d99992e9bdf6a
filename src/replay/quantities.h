// SPDX-License-Identifier: Apache-2.0
// What the events of a sample's record mean (kernels/shared/trace_types.h).
#pragma once

#include "kernels/shared/trace_types.h"

namespace clrt {

/// In which unit of the normalised frame a quantity is, for its way to scene units.
enum class TraceUnit { NONE, LENGTH, POSITION };

/// What can be wrong with a quantity besides NaN.
enum class TraceSign { ANY, NOT_NEGATIVE };

/// One row of the table.
struct Quantity {
    u32 id;           ///< TRACE_*
    const char* name; ///< in reports
    const char* key;  ///< in JSON
    int values;       ///< real numbers; of a choice, integers
    TraceUnit unit = TraceUnit::NONE;
    TraceSign sign = TraceSign::ANY;
    bool is_carried = false; ///< goes on to the next vertex or into the film: where a fault stays
};

/// The row of a quantity. Throws std::out_of_range for a number that no kernel writes.
const Quantity& quantity(u32 id);

/// Whether a quantity decides how the path goes on; else it is a real number.
inline bool is_choice(u32 id) {
    return id < TRACE_CHOICES_END;
}

} // namespace clrt
