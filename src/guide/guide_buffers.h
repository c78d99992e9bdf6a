// SPDX-License-Identifier: Apache-2.0
// A guide on the device.
#pragma once

#include "device/program.h"
#include "guide/guide.h"

namespace clrt {

/// What guided kernels read, and the sums that they add to. Refers to the device.
class GuideBuffers {
public:
    /// Takes memory for as many cells as there can be, and for gains of so many tiles. Throws DeviceError.
    GuideBuffers(const Device& device, size_t tiles);
    /// Binds the arguments of a kernel that guides.
    void bind(Kernel& kernel) const;
    /// Writes a guide and the sums of its cells; none: zeros.
    void write(const Guide& guide, const std::vector<std::uint64_t>& sums = {}) const;
    /// Reads the sums of so many cells, GUIDE_SUMS each.
    std::vector<std::uint64_t> read_sums(size_t cells) const;
    /// Sets what the tiles' gains weigh, and the gains to 0.
    void write_weights(const std::vector<float>& weights) const;
    /// The sum of all tiles' gains.
    double read_gain() const;

private:
    const Device& device_;
    size_t tiles_;
    cl::Buffer links_, cells_, sums_, weights_, gains_;
};

/// Bytes that guide and sums take on a device.
size_t guide_device_bytes();

} // namespace clrt
