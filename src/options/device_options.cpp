// SPDX-License-Identifier: Apache-2.0
#include "options/device_options.h"

#include <cstdlib>
#include <sstream>

namespace clrt {

std::vector<std::string> device_names(const DeviceOptions& options) {
    const char* const variable = std::getenv("CLRT_DEVICE");
    const std::string asked = options.name.empty() && variable ? variable : options.name;
    if (asked.find(',') == asked.npos)
        return {options.name}; // the variable's name is looked up where it can be named in messages
    std::vector<std::string> names;
    std::istringstream text(asked + ",");
    for (std::string name; std::getline(text, name, ',');)
        names.push_back(name);
    return names;
}

bool shares_picture(const DeviceOptions& options) {
    return device_names(options).size() > 1;
}

} // namespace clrt
