// SPDX-License-Identifier: Apache-2.0
// Whether a device takes a buffer, before anything is made of it.
#pragma once

#include "device/device.h"

#include <cstddef>

namespace clrt {

/// Throws DeviceError where a picture's buffer of so many bytes exceeds what the device allows for one, or its
/// memory. `name`: of the buffer, in the message, which asks for a smaller picture.
void check_picture_buffer(const DeviceInfo& device, const char* name, size_t bytes);

} // namespace clrt
