// SPDX-License-Identifier: Apache-2.0
// Which device a name means. A function of the list alone, so that it is tested with made-up machines.
#include "device/device.h"

#include "error.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>

namespace clrt {

namespace {

using Matches = std::vector<DeviceInfo>;

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// True if `text` holds `part`, which is in lower case.
bool contains(const std::string& text, const std::string& part) {
    return lower_case(text).find(part) != std::string::npos;
}

std::string index_of(const DeviceInfo& device) {
    return fmt::format("{}:{}", device.platform_index, device.device_index);
}

/// All devices in list order for which `wanted(device)` holds.
template <class Predicate>
Matches devices_where(const std::vector<PlatformInfo>& platforms, Predicate wanted) {
    Matches result;
    for (const PlatformInfo& platform : platforms)
        std::copy_if(platform.devices.begin(), platform.devices.end(), std::back_inserter(result), wanted);
    return result;
}

[[noreturn]] void fail(const std::vector<PlatformInfo>& platforms, const std::string& what) {
    std::string table = format_device_table(platforms);
    table.pop_back(); // its last line end
    throw DeviceError(what + "\n" + table);
}

/// The first match; the others are named in `notice`.
DeviceInfo first_of(const Matches& matches, const std::string& asked, std::string& notice) {
    if (matches.size() > 1) {
        notice = fmt::format("{} means {} devices; taking the first, {} {}. Others:", asked, matches.size(),
                             index_of(matches[0]), matches[0].name);
        for (size_t i = 1; i < matches.size(); ++i)
            notice +=
                fmt::format("{} --device {} ({})", i > 1 ? "," : "", index_of(matches[i]), matches[i].name);
    }
    return matches[0];
}

/// The two numbers of "P:D".
std::optional<std::pair<int, int>> parse_index(const std::string& spec) {
    const size_t colon = spec.find(':');
    const auto is_number = [](const std::string& text) {
        return !text.empty() && text.size() < 6 &&
               std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    };
    if (colon == std::string::npos || !is_number(spec.substr(0, colon)) || !is_number(spec.substr(colon + 1)))
        return std::nullopt;
    return std::pair(std::stoi(spec.substr(0, colon)), std::stoi(spec.substr(colon + 1)));
}

/// No name given: the first GPU, else the first CPU, else whatever there is.
DeviceInfo default_device(const std::vector<PlatformInfo>& platforms, std::string& notice) {
    for (const char* type : {"GPU", "CPU"}) {
        const Matches matches = devices_where(platforms, [&](const DeviceInfo& d) { return d.type == type; });
        if (!matches.empty())
            return first_of(matches, fmt::format("the default device (the first {})", type), notice);
    }
    return first_of(devices_where(platforms, [](const DeviceInfo&) { return true; }), "the default device",
                    notice);
}

/// Devices of the platforms that `part` names. Nothing if it names none; throws if all it names are empty.
Matches devices_by_platform(const std::vector<PlatformInfo>& platforms, const std::string& part,
                            const std::string& asked) {
    Matches matches;
    const PlatformInfo* empty = nullptr;
    for (const PlatformInfo& platform : platforms) {
        if (!contains(platform.name, part) && !contains(platform.vendor, part) &&
            !contains(platform.icd_suffix, part))
            continue;
        matches.insert(matches.end(), platform.devices.begin(), platform.devices.end());
        if (platform.devices.empty())
            empty = &platform;
    }
    if (matches.empty() && empty)
        fail(platforms, fmt::format("{} means platform {} ({}), which has nothing to offer. Choose one of:",
                                    asked, empty->index, empty->name));
    return matches;
}

} // namespace

DeviceInfo choose_device(const std::vector<PlatformInfo>& platforms, const std::string& spec,
                         std::string& notice) {
    notice.clear();
    const Matches all = devices_where(platforms, [](const DeviceInfo&) { return true; });
    if (all.empty())
        fail(platforms, "There is no OpenCL device to render on.");

    const char* from_environment = std::getenv("CLRT_DEVICE");
    const bool use_environment = spec.empty() && from_environment;
    const std::string wanted = lower_case(use_environment ? from_environment : spec);
    if (wanted.empty())
        return default_device(platforms, notice);
    const std::string asked =
        use_environment ? fmt::format("CLRT_DEVICE={}", from_environment) : fmt::format("--device {}", spec);

    // A type or an index is exact.
    Matches matches;
    if (wanted == "cpu" || wanted == "gpu") {
        matches = devices_where(platforms, [&](const DeviceInfo& d) { return lower_case(d.type) == wanted; });
        if (matches.empty())
            fail(platforms, fmt::format("{}: there is no such device. Choose one of:", asked));
        return first_of(matches, asked, notice);
    }
    if (const auto index = parse_index(wanted)) {
        matches = devices_where(platforms, [&](const DeviceInfo& d) {
            return d.platform_index == index->first && d.device_index == index->second;
        });
        if (matches.empty())
            fail(platforms, fmt::format("{}: there is no device of this index. Choose one of:", asked));
        return matches[0];
    }

    // A name means a platform; only where it means none, a device.
    matches = devices_by_platform(platforms, wanted, asked);
    if (matches.empty())
        matches = devices_where(platforms, [&](const DeviceInfo& d) { return contains(d.name, wanted); });
    if (matches.empty())
        fail(platforms,
             fmt::format("{}: no platform and no device is named like this. Choose one of:", asked));
    if (matches.front().platform_index != matches.back().platform_index)
        fail(platforms,
             fmt::format("{} means devices of several platforms. Choose one by its index:", asked));
    return first_of(matches, asked, notice);
}

} // namespace clrt
