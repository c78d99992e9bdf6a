// SPDX-License-Identifier: Apache-2.0
// A guide on the device.
#pragma once

#include "device/program.h"
#include "guide/guide.h"

namespace clrt {

/// What guided kernels read, and the sums that they add to. Refers to the device.
class GuideBuffers {
public:
    /// Takes memory for as many cells as there can be. Throws DeviceError.
    explicit GuideBuffers(const Device& device);
    /// Binds the arguments of a kernel that guides.
    void bind(Kernel& kernel) const;
    /// Writes a guide and the sums of its cells; none: zeros.
    void write(const Guide& guide, const std::vector<std::uint64_t>& sums = {}) const;
    /// Reads the sums of so many cells, GUIDE_SUMS each.
    std::vector<std::uint64_t> read_sums(size_t cells) const;

private:
    const Device& device_;
    cl::Buffer nodes_, cells_, sums_;
};

/// Bytes that they take on a device.
size_t guide_device_bytes();

} // namespace clrt
