// SPDX-License-Identifier: Apache-2.0
// Text files in UTF-16, as PowerShell and some Windows programs write them -> UTF-8.
#pragma once

#include <string>

namespace clrt {

/// The text as UTF-8. UTF-16 is known by its byte order mark or, without one, by a zero byte in both of the
/// first two characters; anything else is returned as it is. Half of a surrogate pair becomes U+FFFD.
std::string as_utf8(std::string bytes);

} // namespace clrt
