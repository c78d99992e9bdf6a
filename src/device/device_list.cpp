// SPDX-License-Identifier: Apache-2.0
// Asks every platform and device about itself, and prints the table of --list-devices.
#include "device/device.h"

#include "console/address_space.h"
#include "device/driver_cache_folder.h"
#include "device/opencl_error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <sstream>

namespace clrt {

namespace {

/// Drivers pad their strings with blanks, line ends or zero bytes.
std::string trimmed(const std::string& text) {
    const char* const padding = " \t\r\n";
    const std::string visible = text.c_str();
    const size_t first = visible.find_first_not_of(padding);
    if (first == std::string::npos)
        return {};
    return visible.substr(first, visible.find_last_not_of(padding) - first + 1);
}

std::vector<std::string> split_words(const std::string& text) {
    std::istringstream words(text);
    return {std::istream_iterator<std::string>(words), {}};
}

std::string type_name(cl_device_type type) {
    if (type & CL_DEVICE_TYPE_GPU)
        return "GPU";
    if (type & CL_DEVICE_TYPE_CPU)
        return "CPU";
    return type & CL_DEVICE_TYPE_ACCELERATOR ? "accelerator" : "other";
}

DeviceInfo describe_device(const cl::Device& device, const PlatformInfo& platform, int index) {
    DeviceInfo info;
    info.platform_index = platform.index;
    info.device_index = index;
    info.platform = platform.name;
    info.platform_vendor = platform.vendor;
    info.icd_suffix = platform.icd_suffix;
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.largest_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.correctly_rounded_division =
        (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    info.extensions = split_words(trimmed(device.getInfo<CL_DEVICE_EXTENSIONS>()));
    const auto has = [&](const char* name) {
        return std::find(info.extensions.begin(), info.extensions.end(), name) != info.extensions.end();
    };
    info.fp64 = has("cl_khr_fp64");
    info.int64_atomics = has("cl_khr_int64_base_atomics");
    return info;
}

/// The suffix by which the ICD extension identifies a vendor; empty where the platform does not say.
std::string icd_suffix(const cl::Platform& platform) {
    try {
        cl::string suffix;
        platform.getInfo(CL_PLATFORM_ICD_SUFFIX_KHR, &suffix);
        return trimmed(suffix);
    } catch (const cl::Error&) {
        return {};
    }
}

PlatformInfo describe_platform(const cl::Platform& platform, int index) {
    PlatformInfo info;
    info.index = index;
    info.icd_suffix = icd_suffix(platform);
    try {
        info.name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        info.vendor = trimmed(platform.getInfo<CL_PLATFORM_VENDOR>());
        std::vector<cl::Device> devices;
        platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        for (const cl::Device& device : devices)
            info.devices.push_back(describe_device(device, info, static_cast<int>(info.devices.size())));
        if (devices.empty())
            info.note = "no devices";
    } catch (const cl::Error& error) {
        info.devices.clear();
        info.note = error.err() == CL_DEVICE_NOT_FOUND ? "no devices"
                                                       : opencl_error_text(error, "describing the platform");
    }
    return info;
}

/// All platforms, as they answer now.
std::vector<PlatformInfo> ask_platforms() {
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        return {}; // the ICD loader reports an empty vendors folder as CL_PLATFORM_NOT_FOUND_KHR
    }
    std::vector<PlatformInfo> result;
    for (const cl::Platform& platform : platforms)
        result.push_back(describe_platform(platform, static_cast<int>(result.size())));
    return result;
}

/// Gives a platform, whose devices need it, the folder.
void use_cache_folder(PlatformInfo& platform, const std::shared_ptr<const DriverCacheFolder>& folder) {
    platform.note = "its cache folder cannot be made (variable POCL_CACHE_DIR, else XDG_CACHE_HOME, else "
                    ".cache in HOME): kernels are compiled for this run alone, into a temporary folder";
    for (DeviceInfo& device : platform.devices)
        device.cache_folder = folder;
}

std::string gibibytes(size_t bytes) {
    return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

constexpr size_t COLUMNS = 9;
using Row = std::array<std::string, COLUMNS>;

Row table_row(const DeviceInfo& device) {
    return {fmt::format("{}:{}", device.platform_index, device.device_index),
            device.platform,
            device.name,
            device.type,
            std::to_string(device.compute_units),
            gibibytes(device.memory_bytes),
            gibibytes(device.largest_buffer_bytes),
            device.fp64 ? "yes" : "no",
            device.driver};
}

} // namespace

std::vector<PlatformInfo> list_platforms() {
    if (const std::string obstacle = address_space_obstacle(DRIVER_BYTES, "an OpenCL driver");
        !obstacle.empty())
        throw DeviceError(obstacle);
    std::vector<PlatformInfo> platforms = ask_platforms();
    if (std::none_of(platforms.begin(), platforms.end(), may_lack_cache_folder))
        return platforms;
    const auto folder = DriverCacheFolder::make();
    if (!folder) {
        for (PlatformInfo& platform : platforms)
            if (may_lack_cache_folder(platform))
                platform.note +=
                    "; neither its cache folder nor one in the temporary folder can be made: set "
                    "POCL_CACHE_DIR or TMPDIR to a folder that can be written";
        return platforms;
    }
    std::vector<PlatformInfo> again = ask_platforms();
    for (size_t i = 0; i < std::min(platforms.size(), again.size()); ++i)
        if (may_lack_cache_folder(platforms[i]) && !again[i].devices.empty())
            use_cache_folder(again[i], folder);
    return again;
}

std::string format_device_table(const std::vector<PlatformInfo>& platforms) {
    if (platforms.empty())
        return "No OpenCL platform was found. Install a driver for your device; on Debian, "
               "`apt install pocl-opencl-icd` makes the CPU one.\n";
    std::vector<Row> rows = {
        {"index", "platform", "device", "type", "units", "memory", "largest buffer", "fp64", "driver"}};
    std::string notes;
    for (const PlatformInfo& platform : platforms) {
        for (const DeviceInfo& device : platform.devices)
            rows.push_back(table_row(device));
        if (!platform.note.empty())
            notes += fmt::format("platform {} ({}): {}\n", platform.index, platform.name, platform.note);
    }
    if (rows.size() == 1) {
        const bool has_pocl = std::any_of(platforms.begin(), platforms.end(), may_lack_cache_folder);
        return std::string("No OpenCL device was found.") +
               (has_pocl ? "" : " On Debian, `apt install pocl-opencl-icd` makes the CPU one.") + "\n" +
               notes;
    }

    std::array<size_t, COLUMNS> widths{};
    for (const Row& row : rows)
        for (size_t column = 0; column < COLUMNS; ++column)
            widths[column] = std::max(widths[column], row[column].size());
    std::string table;
    for (const Row& row : rows) {
        for (size_t column = 0; column + 1 < COLUMNS; ++column)
            table += fmt::format("{:<{}}  ", row[column], widths[column]);
        table += row.back() + '\n';
    }
    return table + notes;
}

} // namespace clrt
