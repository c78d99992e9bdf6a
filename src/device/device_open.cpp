// SPDX-License-Identifier: Apache-2.0
// Opens a device: its context and its queue.
#include "device/device.h"

#include "device/opencl_error.h"

#include <fmt/format.h>

namespace clrt {

namespace {

/// The handle of the device that `info` describes: the list of platforms keeps its order within a process.
cl::Device find_handle(const DeviceInfo& info) {
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    const size_t platform = static_cast<size_t>(info.platform_index),
                 index = static_cast<size_t>(info.device_index);
    std::vector<cl::Device> devices;
    if (platform < platforms.size())
        platforms[platform].getDevices(CL_DEVICE_TYPE_ALL, &devices);
    if (index >= devices.size())
        throw DeviceError(fmt::format("Device {}:{} ({}) is gone. See --list-devices for what there is.",
                                      info.platform_index, info.device_index, info.name));
    return devices[index];
}

} // namespace

Device open_device(const DeviceInfo& info) {
    return check_opencl(
        fmt::format("opening device {}:{} ({})", info.platform_index, info.device_index, info.name), [&] {
            Device device;
            device.info = info;
            device.handle = find_handle(info);
            device.context = cl::Context(device.handle);
            device.queue = cl::CommandQueue(device.context, device.handle, CL_QUEUE_PROFILING_ENABLE);
            return device;
        });
}

} // namespace clrt
