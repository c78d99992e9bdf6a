// SPDX-License-Identifier: Apache-2.0
// Which device a name means, on made-up machines.
#include "device/device.h"
#include "error.h"

#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace clrt;
using testing::HasSubstr;

namespace {

DeviceInfo device(const std::string& name, const std::string& type) {
    DeviceInfo info;
    info.name = name;
    info.type = type;
    info.compute_units = 4;
    info.memory_bytes = size_t{8} << 30;
    info.largest_buffer_bytes = size_t{2} << 30;
    info.driver = "1.0";
    return info;
}

/// Numbers platforms and devices as list_platforms() does.
std::vector<PlatformInfo> machine(std::vector<PlatformInfo> platforms) {
    for (size_t p = 0; p < platforms.size(); ++p) {
        platforms[p].index = static_cast<int>(p);
        for (size_t d = 0; d < platforms[p].devices.size(); ++d) {
            platforms[p].devices[d].platform_index = static_cast<int>(p);
            platforms[p].devices[d].device_index = static_cast<int>(d);
            platforms[p].devices[d].platform = platforms[p].name;
        }
    }
    return platforms;
}

const PlatformInfo CLOVER{0, "Clover", "Mesa", "MESA", {}, "no devices"};
const PlatformInfo POCL{0,
                        "Portable Computing Language",
                        "The pocl project",
                        "POCL",
                        {device("pthread-skylake-avx512-Intel(R) Xeon(R) Processor", "CPU")},
                        ""};
const PlatformInfo NVIDIA{
    0,
    "NVIDIA CUDA",
    "NVIDIA Corporation",
    "NV",
    {device("NVIDIA GeForce RTX 3060", "GPU"), device("NVIDIA GeForce GTX 1650", "GPU")},
    ""};
const PlatformInfo INTEL{
    0, "Intel(R) OpenCL", "Intel(R) Corporation", "INTEL", {device("Intel(R) Xeon(R) Processor", "CPU")}, ""};

/// The chosen device as "P:D".
std::string choose(const std::vector<PlatformInfo>& platforms, const std::string& spec,
                   std::string* said = nullptr) {
    std::string notice;
    const DeviceInfo chosen = choose_device(platforms, spec, notice);
    if (said)
        *said = notice;
    return std::to_string(chosen.platform_index) + ":" + std::to_string(chosen.device_index);
}

/// The message of the DeviceError that a choice ends with.
std::string refusal(const std::vector<PlatformInfo>& platforms, const std::string& spec) {
    try {
        return "chose " + choose(platforms, spec);
    } catch (const DeviceError& error) {
        return error.what();
    }
}

class DeviceChoose : public testing::Test {
protected:
    void SetUp() override { unsetenv("CLRT_DEVICE"); }
    void TearDown() override { unsetenv("CLRT_DEVICE"); }

    const std::vector<PlatformInfo> all_ = machine({CLOVER, NVIDIA, POCL, INTEL});
};

} // namespace

TEST_F(DeviceChoose, PlatformsAnswerToNameVendorAndSuffixInAnyCase) {
    EXPECT_EQ(choose(all_, "portable"), "2:0");
    EXPECT_EQ(choose(all_, "pocl"), "2:0");
    EXPECT_EQ(choose(all_, "POCL"), "2:0");
    EXPECT_EQ(choose(all_, "The Pocl Project"), "2:0");
    EXPECT_EQ(choose(all_, "cuda"), "1:0");
    EXPECT_EQ(choose(all_, "nv"), "1:0");
    const PlatformInfo named_apart{0, "Simulator", "Someone", "oclg", {device("Simulated", "CPU")}, ""};
    EXPECT_EQ(choose(machine({POCL, named_apart}), "OCLG"), "1:0");
}

TEST_F(DeviceChoose, IntelMeansThePlatformThoughPoclsDeviceIsNamedIntel) {
    EXPECT_EQ(choose(all_, "intel"), "3:0");
}

TEST_F(DeviceChoose, DeviceNamesCountOnlyWhenNoPlatformMatches) {
    EXPECT_EQ(choose(machine({CLOVER, NVIDIA, POCL}), "intel"), "2:0");
    EXPECT_EQ(choose(all_, "gtx 1650"), "1:1");
}

TEST_F(DeviceChoose, AnEmptyPlatformDoesNotLendItsNameToDevicesOfOthers) {
    PlatformInfo empty = INTEL;
    empty.devices.clear();
    empty.note = "no devices";
    const std::string message = refusal(machine({POCL, empty}), "intel");
    EXPECT_THAT(message, HasSubstr("platform 1 (Intel(R) OpenCL), which has nothing to offer"));
    EXPECT_THAT(message, HasSubstr("0:0"));
}

TEST_F(DeviceChoose, AnEmptyPlatformIsPassedOverWhenAnotherMatches) {
    PlatformInfo rusticl{0, "rusticl", "Mesa/X.org", "MESA", {device("llvmpipe", "CPU")}, ""};
    EXPECT_EQ(choose(machine({CLOVER, rusticl}), "mesa"), "1:0");
}

TEST_F(DeviceChoose, TypesMeanTheFirstOfTheirKind) {
    std::string notice;
    EXPECT_EQ(choose(all_, "gpu", &notice), "1:0");
    EXPECT_THAT(notice, HasSubstr("--device 1:1 (NVIDIA GeForce GTX 1650)"));
    EXPECT_EQ(choose(all_, "CPU", &notice), "2:0");
    EXPECT_THAT(notice, HasSubstr("--device 3:0"));
    EXPECT_THAT(refusal(machine({POCL}), "gpu"), HasSubstr("--device gpu: there is no such device"));
}

TEST_F(DeviceChoose, TypesAreNoPartsOfNames) {
    PlatformInfo named_cpu = NVIDIA;
    named_cpu.name = "CPU emulator";
    EXPECT_EQ(choose(machine({named_cpu, POCL}), "cpu"), "1:0");
}

TEST_F(DeviceChoose, IndicesCountEmptyPlatforms) {
    EXPECT_EQ(choose(all_, "1:1"), "1:1");
    EXPECT_EQ(choose(all_, "2:0"), "2:0");
    for (const char* absent : {"0:0", "1:2", "4:0"})
        EXPECT_THAT(refusal(all_, absent), HasSubstr("there is no device of this index")) << absent;
    for (const char* no_index : {"1:", ":1", "1:0:0", "-1:0", "99999999999:0"})
        EXPECT_THAT(refusal(all_, no_index), HasSubstr("no platform and no device is named like this"))
            << no_index;
}

TEST_F(DeviceChoose, SeveralDevicesOfOnePlatformGiveTheFirstAndANotice) {
    std::string notice;
    EXPECT_EQ(choose(all_, "nvidia", &notice), "1:0");
    EXPECT_EQ(notice,
              "--device nvidia means 2 devices; taking the first, 1:0 NVIDIA GeForce RTX 3060. Others: "
              "--device 1:1 (NVIDIA GeForce GTX 1650)");
    EXPECT_EQ(choose(all_, "pocl", &notice), "2:0");
    EXPECT_EQ(notice, "");
}

TEST_F(DeviceChoose, SeveralPlatformsAreRefusedWithTheTable) {
    for (const char* ambiguous : {"opencl", "a"}) {
        const std::string message = refusal(
            machine({INTEL, NVIDIA, POCL, PlatformInfo{0, "An OpenCL", "A", "A", {device("x", "GPU")}, ""}}),
            ambiguous);
        EXPECT_THAT(message, HasSubstr("several platforms")) << ambiguous;
        EXPECT_THAT(message, HasSubstr("3:0")) << ambiguous;
    }
    EXPECT_THAT(refusal(machine({POCL, PlatformInfo{0, "P", "P", "P", {device("Xeon", "CPU")}, ""}}), "xeon"),
                HasSubstr("several platforms"));
}

TEST_F(DeviceChoose, UnknownNamesAreRefusedWithTheTable) {
    const std::string message = refusal(all_, "radeon");
    EXPECT_THAT(message, HasSubstr("--device radeon: no platform and no device is named like this"));
    EXPECT_THAT(message, HasSubstr("2:0    Portable Computing Language"));
    EXPECT_THAT(message, HasSubstr("platform 0 (Clover): no devices"));
}

TEST_F(DeviceChoose, TheDefaultIsTheFirstGpuElseTheFirstCpuElseAnything) {
    EXPECT_EQ(choose(machine({POCL, INTEL, NVIDIA}), ""), "2:0");
    EXPECT_EQ(choose(machine({CLOVER, POCL, INTEL}), ""), "1:0");
    EXPECT_EQ(choose(machine({PlatformInfo{0, "F", "F", "F", {device("fpga", "accelerator")}, ""}}), ""),
              "0:0");
}

TEST_F(DeviceChoose, TheEnvironmentIsAskedWhenNoNameIsGiven) {
    setenv("CLRT_DEVICE", "pocl", 1);
    EXPECT_EQ(choose(all_, ""), "2:0");
    EXPECT_EQ(choose(all_, "intel"), "3:0");
    setenv("CLRT_DEVICE", "radeon", 1);
    EXPECT_THAT(refusal(all_, ""), HasSubstr("CLRT_DEVICE=radeon: no platform"));
    setenv("CLRT_DEVICE", "", 1);
    EXPECT_EQ(choose(all_, ""), "1:0");
}

TEST_F(DeviceChoose, AMachineWithoutDevicesIsToldWhatToInstall) {
    EXPECT_THAT(refusal({}, ""), HasSubstr("pocl-opencl-icd"));
    EXPECT_THAT(refusal({}, "pocl"), HasSubstr("pocl-opencl-icd"));
    EXPECT_THAT(refusal(machine({CLOVER}), "0:0"), HasSubstr("pocl-opencl-icd"));
}

TEST_F(DeviceChoose, TheTableHasALineADeviceAndNotesBelow) {
    const std::string table = format_device_table(machine({CLOVER, POCL}));
    EXPECT_EQ(table,
              "index  platform                     device                                             type  "
              "units  memory   largest buffer  fp64  driver\n"
              "1:0    Portable Computing Language  pthread-skylake-avx512-Intel(R) Xeon(R) Processor  CPU   "
              "4      8.0 GiB  2.0 GiB         no    1.0\n"
              "platform 0 (Clover): no devices\n");
}
