// SPDX-License-Identifier: Apache-2.0
// How --threads and --cache reach the drivers: by their environment variables.
#include "app/options.h"
#include "device/device.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <string>

using namespace clrt;

namespace {

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "unset";
}

class DriverQuirks : public testing::Test {
protected:
    void SetUp() override { clear(); }
    void TearDown() override { clear(); }

    static void clear() {
        for (const char* name :
             {"POCL_MAX_PTHREAD_COUNT", "CL_CONFIG_CPU_TBB_NUM_WORKERS", "POCL_KERNEL_CACHE"})
            unsetenv(name);
    }
};

} // namespace

TEST_F(DriverQuirks, ThreadsAreSetForCpuDrivers) {
    Options options;
    options.threads = 3;
    set_driver_environment(options);
    EXPECT_EQ(variable("POCL_MAX_PTHREAD_COUNT"), "3");
    EXPECT_EQ(variable("CL_CONFIG_CPU_TBB_NUM_WORKERS"), "3");
    EXPECT_EQ(variable("POCL_KERNEL_CACHE"), "unset");
}

TEST_F(DriverQuirks, CacheOffTurnsTheDriversCacheOff) {
    Options options;
    for (const Toggle kept : {Toggle::AUTO, Toggle::ON}) {
        options.cache = kept;
        set_driver_environment(options);
        EXPECT_EQ(variable("POCL_KERNEL_CACHE"), "unset");
    }
    options.cache = Toggle::OFF;
    set_driver_environment(options);
    EXPECT_EQ(variable("POCL_KERNEL_CACHE"), "0");
    EXPECT_EQ(variable("POCL_MAX_PTHREAD_COUNT"), "unset");
}

TEST_F(DriverQuirks, ThePlatformListIsMadeWithTheThreadsAskedFor) {
    Options options;
    options.threads = 1;
    set_driver_environment(options);
    for (const PlatformInfo& platform : list_platforms())
        for (const DeviceInfo& device : platform.devices)
            if (device.icd_suffix == "POCL" && device.type == "CPU") {
                EXPECT_EQ(device.compute_units, 1u) << device.name;
            }
}
