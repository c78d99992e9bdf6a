// SPDX-License-Identifier: Apache-2.0
#include "options/integrators.h"

#include "kernels/shared/path_types.h"

#include <algorithm>
#include <iterator>

namespace clrt {

const IntegratorRow& integrator_row(Integrator integrator) {
    return *std::find_if(std::begin(INTEGRATOR_ROWS), std::end(INTEGRATOR_ROWS),
                         [&](const IntegratorRow& row) { return row.value == integrator; });
}

bool takes_option(Integrator integrator, IntegratorOption option) {
    return (integrator_row(integrator).takes & option) != 0;
}

unsigned light_tree_kinds(Integrator integrator) {
    switch (integrator_row(integrator).connections) {
    case Connections::NO_LIGHT:
    case Connections::EVERY_LIGHT:
        return 0;
    case Connections::EVERY_LIGHT_BY_TREE:
        return KIND_AREA;
    case Connections::ONE_LIGHT:
        break;
    }
    return KINDS_ALL;
}

bool connects_through_slabs(Integrator integrator) {
    return integrator == Integrator::PATH || integrator == Integrator::PATH_LIGHT ||
           integrator == Integrator::BDPT;
}

bool walks_chains(Integrator integrator) {
    return integrator == Integrator::MLT;
}

std::vector<std::string> integrators_with(IntegratorOption option) {
    std::vector<std::string> names;
    for (const IntegratorRow& row : INTEGRATOR_ROWS)
        if (row.takes & option)
            names.emplace_back(row.name);
    return names;
}

std::string integrator_stem(Integrator integrator) {
    std::string stem = name_of(integrator);
    std::replace(stem.begin(), stem.end(), '+', '_');
    return stem;
}

std::string integrator_file(Integrator integrator) {
    return "integrators/" + integrator_stem(integrator) + ".cl";
}

std::string integrator_kernel(Integrator integrator) {
    return "render_" + integrator_stem(integrator);
}

} // namespace clrt
