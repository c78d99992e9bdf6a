// SPDX-License-Identifier: Apache-2.0
// How --threads and --cache reach the drivers: by their environment variables.
#include "device/device.h"
#include "device/driver_cache_folder.h"
#include "device/program.h"
#include "options/options.h"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

using namespace clrt;

namespace {

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "unset";
}

/// Variables of CPU drivers that take the number of threads, and those that turn a driver's cache off, with
/// the value that does: from the drivers' manuals.
const std::vector<const char*> THREADS = {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT",
                                          "POCL_MAX_COMPUTE_UNITS", "CL_CONFIG_CPU_TBB_NUM_WORKERS"};
const std::vector<std::pair<const char*, const char*>> CACHES = {{"POCL_KERNEL_CACHE", "0"},
                                                                 {"CUDA_CACHE_DISABLE", "1"}};

class DriverQuirks : public testing::Test {
protected:
    void SetUp() override { clear(); }
    void TearDown() override { clear(); }

    static void clear() {
        for (const char* name : THREADS)
            unsetenv(name);
        for (const auto& [name, off] : CACHES)
            unsetenv(name);
    }
    static void expect_threads(const char* value) {
        for (const char* name : THREADS)
            EXPECT_EQ(variable(name), value) << name;
    }
    /// Off or untouched.
    static void expect_caches(bool are_off) {
        for (const auto& [name, off] : CACHES)
            EXPECT_EQ(variable(name), are_off ? off : "unset") << name;
    }
};

} // namespace

TEST_F(DriverQuirks, ThreadsAreSetForEveryCpuDriver) {
    DeviceOptions options;
    set_driver_environment(options);
    expect_threads("unset");
    options.threads = 3;
    set_driver_environment(options);
    expect_threads("3");
    expect_caches(false);
}

TEST_F(DriverQuirks, ThreadsAskedForReplaceThoseOfTheEnvironment) {
    for (const char* name : THREADS)
        setenv(name, "7", 1);
    DeviceOptions options;
    set_driver_environment(options);
    expect_threads("7");
    options.threads = 2;
    set_driver_environment(options);
    expect_threads("2");
}

TEST_F(DriverQuirks, CacheOffTurnsEveryDriversCacheOff) {
    DeviceOptions options;
    for (const Toggle kept : {Toggle::AUTO, Toggle::ON}) {
        options.cache = kept;
        set_driver_environment(options);
        expect_caches(false);
    }
    options.cache = Toggle::OFF;
    set_driver_environment(options);
    expect_caches(true);
    expect_threads("unset");
}

TEST_F(DriverQuirks, OnlyPoclAndNvidiaCacheByThemselves) {
    for (const auto& [suffix, caches] :
         {std::pair{"POCL", true}, {"NV", true}, {"INTEL", false}, {"OCLG", false}, {"", false}}) {
        DeviceInfo device;
        device.icd_suffix = suffix;
        EXPECT_EQ(driver_caches_programs(device), caches) << suffix;
    }
}

TEST_F(DriverQuirks, LlvmpipeGetsAnFmaOfOurs) {
    DeviceInfo device;
    device.platform = "rusticl";
    device.name = "llvmpipe (LLVM 15.0.6, 256 bits)";
    EXPECT_NE(build_options(device, Precision::SINGLE).find("-DCLRT_SOFTWARE_FMA=1"), std::string::npos);
    device.name = "AMD Radeon";
    EXPECT_EQ(build_options(device, Precision::SINGLE).find("FMA"), std::string::npos);
}

TEST_F(DriverQuirks, ARunThatKeepsNoProgramsHasAFolderOfItsOwn) {
    const char* const name = "POCL_CACHE_DIR";
    const char* const set_before = std::getenv(name);
    const std::string before = set_before ? set_before : "";
    unsetenv(name);
    auto folder = DriverCacheFolder::make_for_uncached_run();
    const std::string place = variable(name);
    EXPECT_TRUE(std::filesystem::is_directory(place)) << place;
    EXPECT_EQ(DriverCacheFolder::make_for_uncached_run(), nullptr) << "one is named";
    EXPECT_EQ(variable(name), place);
    folder.reset();
    EXPECT_FALSE(std::filesystem::exists(place));
    EXPECT_EQ(variable(name), "unset");
    if (set_before)
        setenv(name, before.c_str(), 1);
}

TEST_F(DriverQuirks, ThePlatformListIsMadeWithTheThreadsAskedFor) {
    DeviceOptions options;
    options.threads = 1;
    set_driver_environment(options);
    for (const PlatformInfo& platform : list_platforms())
        for (const DeviceInfo& device : platform.devices)
            if (device.icd_suffix == "POCL" && device.type == "CPU") {
                EXPECT_EQ(device.compute_units, 1u) << device.name;
            }
}
