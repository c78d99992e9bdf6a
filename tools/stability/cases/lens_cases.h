// SPDX-License-Identifier: Apache-2.0
// What lens and shutter have to keep: cases of the group of cameras.
#pragma once

#include "stability/stability_case.h"

namespace clrt {

void lens_radius_zero(CaseRun& run);
void odd_focus(CaseRun& run);
void blur_circle(CaseRun& run);
void shutter_zero(CaseRun& run);

} // namespace clrt
