// SPDX-License-Identifier: Apache-2.0
// Options that are on, off, or decided by the program.
#pragma once

#include "options/names.h"

namespace clrt {

enum class Toggle { AUTO, ON, OFF };

template <>
inline constexpr Named<Toggle> NAMES<Toggle>[] = {
    {Toggle::AUTO, "auto"}, {Toggle::ON, "on"}, {Toggle::OFF, "off"}};

} // namespace clrt
