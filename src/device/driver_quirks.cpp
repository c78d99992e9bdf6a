// SPDX-License-Identifier: Apache-2.0
// All that clrt knows about particular drivers on the host's side, each with its reason.
#include "device/device.h"

#include "options/device_options.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>

namespace clrt {

namespace {

/// Platforms that keep compiled programs on disk by themselves, by their ICD suffix: the identification that
/// cl_khr_icd defines for vendors.
const char* const CACHING_DRIVERS[] = {
    "POCL", // keeps kernels by source and work-group size; reading its binaries costs one more full compile
    "NV",   // keeps compiled programs in its compute cache
};

/// Environment variables that limit a CPU driver's threads.
const char* const THREAD_VARIABLES[] = {
    "POCL_MAX_PTHREAD_COUNT",        // PoCL up to 3.1
    "POCL_CPU_MAX_CU_COUNT",         // PoCL from 4.0
    "POCL_MAX_COMPUTE_UNITS",        // PoCL from 7.0
    "CL_CONFIG_CPU_TBB_NUM_WORKERS", // Intel's CPU runtime
};

/// Environment variables that turn a driver's own cache off.
struct CacheVariable {
    const char* name;
    const char* off;
};

const CacheVariable CACHE_VARIABLES[] = {
    {"POCL_KERNEL_CACHE", "0"},  // PoCL
    {"CUDA_CACHE_DISABLE", "1"}, // NVIDIA
};

} // namespace

bool driver_caches_programs(const DeviceInfo& device) {
    return std::find(std::begin(CACHING_DRIVERS), std::end(CACHING_DRIVERS), device.icd_suffix) !=
           std::end(CACHING_DRIVERS);
}

bool driver_inlines_slow_fma(const DeviceInfo& device) {
    // Mesa's llvmpipe has no fma, and rusticl puts its integer routine wherever there is one: a kernel with
    // 500 of them took 27 seconds of the processor before its own compiler began, against 1.3.
    return device.platform == "rusticl" && device.name.rfind("llvmpipe", 0) == 0;
}

bool may_lack_cache_folder(const PlatformInfo& platform) {
    // PoCL makes its cache folder before it lists a device, and lists none where it cannot. PoCL 3.1 looks
    // for a place again when it is asked again.
    return platform.devices.empty() && platform.icd_suffix == "POCL";
}

void set_driver_environment(const DeviceOptions& options) {
    constexpr int REPLACE = 1;
    if (options.threads > 0)
        for (const char* variable : THREAD_VARIABLES)
            setenv(variable, std::to_string(options.threads).c_str(), REPLACE);
    if (options.cache == Toggle::OFF)
        for (const CacheVariable& variable : CACHE_VARIABLES)
            setenv(variable.name, variable.off, REPLACE);
}

} // namespace clrt
