// SPDX-License-Identifier: Apache-2.0
#include "stability/catalogue.h"

namespace clrt {

const std::vector<StabilityCase>& sample_cases() {
    static const std::vector<StabilityCase> cases = {};
    return cases;
}

} // namespace clrt
