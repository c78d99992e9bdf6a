// SPDX-License-Identifier: Apache-2.0
// Numbers in bytes, and bytes in text.
#pragma once

#include "kernels/shared/types.h"

#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace clrt {

/// The little-endian number at a byte; the caller knows that it is there. Hosts are little-endian, as
/// OpenCL's shared structs demand.
template <typename T>
T little_endian(std::string_view bytes, size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// What base64 text (RFC 4648, section 4, padded or not) stands for; nothing where it is none.
std::optional<std::string> decode_base64(std::string_view text);

/// Text with %XX replaced by the bytes that they stand for; other signs stay.
std::string decode_percent(std::string_view text);

} // namespace clrt
