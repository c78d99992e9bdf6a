// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stability/stability_case.h"

namespace clrt {

/// G01 of the grazing cases.
void grazed_plane(CaseRun& run);

} // namespace clrt
