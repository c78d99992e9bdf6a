// SPDX-License-Identifier: Apache-2.0
// How a device computes: whether it keeps the rules that the same bits everywhere rest on (DESIGN.md section
// 4).
#pragma once

#include "device/device.h"
#include "device/program.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// Facts of a device and its compiler, measured on some thousand operands under the options of --precision
/// single.
struct DeviceFacts {
    /// Every rule by name and whether it holds. All but "sums in order" are needed for the same bits.
    std::vector<std::pair<std::string, bool>> rules;
    /// Largest errors in units in the last place: of division and square root, then of real_functions.h and
    /// real.h.
    std::vector<std::pair<std::string, double>> errors_ulp;
};

/// Compiles a small program and asks the device. Throws KernelBuildError or DeviceError.
DeviceFacts measure_device_facts(const Device& device);

/// The facts from the cache's folder, where earlier runs have left them; else measured, and kept there unless
/// the cache is off.
DeviceFacts device_facts(const Device& device, const ProgramCache& cache);

/// True if the device gives the pictures that every other such device gives, to the last bit.
bool promises_bits(const DeviceFacts& facts);

/// Rules that the same bits need and that the device breaks; empty where it breaks none.
std::vector<std::string> broken_rules(const DeviceFacts& facts);

/// One line, such as "division 0.50 ulp, square root 0.50 ulp, ...; all rules kept, but sums in order".
std::string describe_facts(const DeviceFacts& facts);

/// Two lines for every device: its index, whether it promises the bits, its facts. A device that cannot be
/// asked says why.
std::string format_facts(const std::vector<PlatformInfo>& platforms, const ProgramCache& cache);

/// {"rules": {name: bool}, "errors_ulp": {name: number}}, and back; facts_from_json throws what the parser
/// throws.
nlohmann::ordered_json facts_json(const DeviceFacts& facts);
DeviceFacts facts_from_json(const nlohmann::ordered_json& json);

} // namespace clrt
