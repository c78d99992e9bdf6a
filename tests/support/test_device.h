// SPDX-License-Identifier: Apache-2.0
// What tests run on, as ctest's environment says.
#pragma once

#include "probes/probe_device.h"

#include <string>

namespace clrt {

/// CLRT_TEST_DEVICE: the device that tests run on, as --device takes it; "pocl" where it is not set.
std::string test_device_name();

/// CLRT_TEST_KERNELS: the folder of the kernels under test, so that faults can be planted without a build;
/// empty: those inside the test.
std::string test_kernels_folder();

/// CLRT_TEST_LONG: whether the longer forms of tests are asked for.
bool tests_are_long();

/// CLRT_TEST_EFFECTS=needed: whether scenes are rendered by the small programs of just the effects that they
/// call for. They have the bits of the full one (render/effect_masks_test), which is the choice where many
/// tests share it.
bool tests_take_needed_effects();

/// test_device_name() with the kernels under test, opened once a process.
const ProbeDevice& test_device();

/// The kernels under test; opens no device.
KernelFiles kernels_under_test();

} // namespace clrt
