// SPDX-License-Identifier: Apache-2.0
// OpenCL devices: what there is, which one a name means, and an open one.
#pragma once

#include "device/opencl.h"

#include <memory>
#include <string>
#include <vector>

namespace clrt {

struct DeviceOptions;
class DriverCacheFolder;
class CompileAhead;

/// What clrt asks a device about itself; nothing is guessed from names.
struct DeviceInfo {
    int platform_index = 0, device_index = 0; ///< as `clinfo -l` counts, empty platforms included
    std::string platform, platform_vendor, icd_suffix;
    std::string name, vendor, driver, version;
    std::string type; ///< "CPU", "GPU", "accelerator", "other"
    unsigned compute_units = 0;
    size_t memory_bytes = 0, largest_buffer_bytes = 0;
    bool fp64 = false;
    bool int64_atomics = false;              ///< cl_khr_int64_base_atomics: of splats
    bool correctly_rounded_division = false; ///< CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT
    std::vector<std::string> extensions;
    std::shared_ptr<const DriverCacheFolder> cache_folder; ///< that had to be made for its driver, or null
};

/// A platform, or the reason why it has nothing to offer.
struct PlatformInfo {
    int index = 0;
    std::string name, vendor, icd_suffix;
    std::vector<DeviceInfo> devices;
    std::string note; ///< why devices is empty, or what had to be done for them; else empty
};

/// Sets the environment variables by which drivers take --threads and --cache off. Drivers read them once, so
/// call it before anything else of OpenCL.
void set_driver_environment(const DeviceOptions& options);

/// True if the device's driver keeps compiled programs on disk by itself, so that a cache of ours only costs.
bool driver_caches_programs(const DeviceInfo& device);

/// True if every fma of a kernel becomes a long routine in its driver, so that clrt brings its own
/// (kernels/numerics/software_fma.h).
bool driver_inlines_slow_fma(const DeviceInfo& device);

/// True for a platform that may list no device because its driver has no place for its cache.
bool may_lack_cache_folder(const PlatformInfo& platform);

/// All platforms in `clinfo -l` order. Empty and failing platforms are listed with a note, never thrown. A
/// driver that cannot make its cache folder gets a temporary one, which its note says.
/// No ICD loader entry at all gives an empty list. Throws DeviceError where a limit of the address space
/// leaves drivers too little (address_space.h).
std::vector<PlatformInfo> list_platforms();

/// The table that --list-devices prints, one line a device, notes below.
std::string format_device_table(const std::vector<PlatformInfo>& platforms);

/// Finds the device that `spec` means (INTERFACE.md, Devices; empty: CLRT_DEVICE, else first GPU, else CPU).
/// Throws DeviceError with the table when nothing matches or several platforms do. A choice among several
/// devices of one platform is said in `notice`.
DeviceInfo choose_device(const std::vector<PlatformInfo>& platforms, const std::string& spec,
                         std::string& notice);

/// A device with its context and one in-order queue with profiling.
struct Device {
    DeviceInfo info;
    cl::Device handle;
    cl::Context context;
    cl::CommandQueue queue;
    std::shared_ptr<CompileAhead> ahead; ///< compiles what will be wanted (compile_ahead.h), or null
};

/// Opens a device. Throws DeviceError.
Device open_device(const DeviceInfo& info);

/// Bytes of a buffer from `offset` on, and whence they come.
struct BufferPiece {
    size_t offset = 0;
    const void* data = nullptr;
    size_t bytes = 0;
};

/// Makes a read-only buffer of these pieces, none of which is empty; what lies between them is undefined.
/// `name` is how an error names it. No piece gives a buffer of one dummy element (OpenCL has no empty
/// buffers). Throws DeviceError naming the buffer, its size and the limit when it exceeds the device's
/// largest allocation or memory.
cl::Buffer upload_pieces(const Device& device, const char* name, const std::vector<BufferPiece>& pieces);

/// The same for a vector.
template <class T>
cl::Buffer upload_buffer(const Device& device, const char* name, const std::vector<T>& data) {
    if (data.empty())
        return upload_pieces(device, name, {});
    return upload_pieces(device, name, {{0, data.data(), data.size() * sizeof(T)}});
}

/// Makes a zeroed read-write buffer; errors as in upload_pieces.
cl::Buffer create_buffer(const Device& device, const char* name, size_t bytes);

} // namespace clrt
