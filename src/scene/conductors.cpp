// SPDX-License-Identifier: Apache-2.0
#include "scene/conductors.h"

#include "scene/conductor_table.h"

namespace clrt {

std::optional<ConductorIndex> find_conductor(const std::string& name) {
    for (const NamedConductor& conductor : CONDUCTORS)
        if (name == conductor.name)
            return conductor.index;
    return std::nullopt;
}

std::vector<std::string> conductor_names() {
    std::vector<std::string> names;
    for (const NamedConductor& conductor : CONDUCTORS)
        names.emplace_back(conductor.name);
    return names;
}

glm::dvec3 conductor_head_on(const ConductorIndex& index) {
    const glm::dvec3 below = index.eta - 1.0, above = index.eta + 1.0, k2 = index.k * index.k;
    return (below * below + k2) / (above * above + k2);
}

} // namespace clrt
