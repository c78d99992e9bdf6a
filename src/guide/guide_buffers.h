// SPDX-License-Identifier: Apache-2.0
// The guide on the device.
#pragma once

#include "device/program.h"
#include "guide/guide.h"

namespace clrt {

/// A guide, and its buffers on a device. Refers to the device.
class GuideBuffers {
public:
    /// Has learnt nothing. Throws DeviceError where the device has no memory for it.
    GuideBuffers(const Device& device, double extent);
    /// Binds the arguments of a kernel that guides.
    void bind(Kernel& kernel) const;
    /// Learns what the paths since the last time have found.
    void advance();

private:
    void write() const;

    const Device& device_;
    Guide guide_;
    cl::Buffer nodes_, cells_, sums_;
};

} // namespace clrt
