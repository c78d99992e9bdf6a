// SPDX-License-Identifier: Apache-2.0
#include "support/test_device.h"

#include <cstdlib>

namespace clrt {

std::string test_device_name() {
    const char* const name = std::getenv("CLRT_TEST_DEVICE");
    return name ? name : "pocl";
}

std::string test_kernels_folder() {
    const char* const folder = std::getenv("CLRT_TEST_KERNELS");
    return folder ? folder : "";
}

bool tests_are_long() {
    return std::getenv("CLRT_TEST_LONG") != nullptr;
}

bool tests_take_needed_effects() {
    const char* const effects = std::getenv("CLRT_TEST_EFFECTS");
    return effects && std::string(effects) == "needed";
}

const ProbeDevice& test_device() {
    // Never freed: at exit some drivers are gone before our statics.
    static const ProbeDevice* const device = [] {
        std::string notice;
        return new ProbeDevice(open_device(choose_device(list_platforms(), test_device_name(), notice)),
                               test_kernels_folder());
    }();
    return *device;
}

KernelFiles kernels_under_test() {
    const std::string folder = test_kernels_folder();
    return folder.empty() ? embedded_kernel_files() : read_kernel_files(folder);
}

} // namespace clrt
