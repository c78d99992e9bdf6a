// SPDX-License-Identifier: Apache-2.0
// Options that are on, off, or decided by the program.
#pragma once

namespace clrt {

enum class Toggle { AUTO, ON, OFF };

} // namespace clrt
