// SPDX-License-Identifier: Apache-2.0
// Whether a PNG ends before its pixels do. libpng finds that too, but prints lines of its own.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>

namespace clrt {

/// Where a PNG of `size` bytes ends within a chunk that its pixels need: what was expected there, in words.
/// Nothing for other files, and where no chunk is cut off, or only one behind pixels. The stream is at the
/// file's first byte; chunk heads alone are read (PNG specification, 5.3).
std::optional<std::string> png_cut(std::istream& file, std::uint64_t size);

} // namespace clrt
