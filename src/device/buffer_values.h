// SPDX-License-Identifier: Apache-2.0
// Arrays written to buffers and read back, waiting for the end.
#pragma once

#include "device/device.h"
#include "device/opencl_error.h"

#include <string>
#include <vector>

namespace clrt {

/// Writes values to the beginning of a buffer. `doing` says what for, in the message of a DeviceError.
template <class T>
void write_values(const Device& device, const std::string& doing, const cl::Buffer& buffer,
                  const std::vector<T>& values) {
    check_opencl(doing, [&] {
        device.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
    });
}

/// Reads `count` values from number `first` on. Throws DeviceError likewise.
template <class T>
std::vector<T> read_values(const Device& device, const std::string& doing, const cl::Buffer& buffer,
                           size_t first, size_t count) {
    std::vector<T> values(count);
    check_opencl(doing, [&] {
        device.queue.enqueueReadBuffer(buffer, CL_TRUE, first * sizeof(T), count * sizeof(T), values.data());
    });
    return values;
}

} // namespace clrt
