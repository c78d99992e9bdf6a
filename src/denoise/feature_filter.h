// SPDX-License-Identifier: Apache-2.0
// The denoiser that needs nothing: regression on features (kernels/denoise/regression.h), the same bits on
// every device that keeps the rules.
#pragma once

#include "denoise/denoise.h"
#include "device/program.h"

#include <vector>

namespace clrt {

/// The compiled filter. Refers to the device.
class FeatureFilter {
public:
    /// Compiles it; of the request, what concerns programs counts. Throws KernelBuildError.
    FeatureFilter(const Device& device, const DenoiseRequest& request);

    /// A half's candidates, one for each notion of how much like each other colours must be. Throws
    /// DeviceError.
    std::vector<DenoiseCandidate> candidates(const HalfPicture& half);

private:
    DenoiseCandidate candidate(const HalfPicture& half, float noise);
    void run(Kernel& kernel, size_t columns, size_t lines);

    const Device& device_;
    Program program_;
    Kernel fit_, apply_;
};

} // namespace clrt
