// SPDX-License-Identifier: Apache-2.0
#include "probes/probe_device.h"

#include <utility>

namespace clrt {

ProbeDevice::ProbeDevice(Device device, std::string kernels_folder)
    : Device(std::move(device)), kernels_folder_(std::move(kernels_folder)) {}

KernelFiles ProbeDevice::kernels() const {
    return kernels_folder_.empty() ? embedded_kernel_files() : read_kernel_files(kernels_folder_);
}

} // namespace clrt
