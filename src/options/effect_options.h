// SPDX-License-Identifier: Apache-2.0
// Which effects are simulated.
#pragma once

#include <cstdint>
#include <optional>

namespace clrt {

struct EffectOptions {
    bool all = false;                  ///< --effects all: the full kernel
    std::optional<std::uint64_t> list; ///< --effects LIST: these and no others
    std::uint64_t off = 0;             ///< --effects -NAME: taken away
};

} // namespace clrt
