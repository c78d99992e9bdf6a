// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/text_encoding.h"

#include <cstddef>
#include <cstdint>

namespace clrt {

namespace {

constexpr std::uint32_t REPLACEMENT = 0xfffd;

enum class ByteOrder { NONE, LITTLE, BIG };

unsigned byte_at(const std::string& bytes, size_t i) {
    return static_cast<unsigned char>(bytes[i]);
}

ByteOrder find_order(const std::string& bytes) {
    if (bytes.size() < 2)
        return ByteOrder::NONE;
    if (byte_at(bytes, 0) == 0xff && byte_at(bytes, 1) == 0xfe)
        return ByteOrder::LITTLE;
    if (byte_at(bytes, 0) == 0xfe && byte_at(bytes, 1) == 0xff)
        return ByteOrder::BIG;
    if (bytes.size() < 4)
        return ByteOrder::NONE;
    if (bytes[0] && !bytes[1] && bytes[2] && !bytes[3])
        return ByteOrder::LITTLE;
    return !bytes[0] && bytes[1] && !bytes[2] && bytes[3] ? ByteOrder::BIG : ByteOrder::NONE;
}

void append_utf8(std::string& text, std::uint32_t c) {
    if (c < 0x80) {
        text += char(c);
        return;
    }
    const int following = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    constexpr std::uint32_t FIRST_BITS[] = {0, 0xc0, 0xe0, 0xf0};
    text += char(FIRST_BITS[following] | c >> (6 * following));
    for (int i = following - 1; i >= 0; --i)
        text += char(0x80 | (c >> (6 * i) & 0x3f));
}

bool is_high_surrogate(std::uint32_t unit) {
    return (unit & 0xfc00) == 0xd800;
}

bool is_low_surrogate(std::uint32_t unit) {
    return (unit & 0xfc00) == 0xdc00;
}

} // namespace

std::string as_utf8(std::string bytes) {
    const ByteOrder order = find_order(bytes);
    if (order == ByteOrder::NONE)
        return bytes;
    const size_t low = order == ByteOrder::LITTLE ? 0 : 1, units = bytes.size() / 2;
    const auto unit = [&](size_t i) -> std::uint32_t {
        return byte_at(bytes, 2 * i + low) | byte_at(bytes, 2 * i + 1 - low) << 8;
    };
    std::string text;
    text.reserve(units);
    // The mark itself becomes UTF-8's, which readers skip.
    for (size_t i = 0; i < units; ++i) {
        std::uint32_t c = unit(i);
        if (is_high_surrogate(c) && i + 1 < units && is_low_surrogate(unit(i + 1)))
            c = 0x10000 + ((c & 0x3ff) << 10 | (unit(++i) & 0x3ff));
        else if (is_high_surrogate(c) || is_low_surrogate(c))
            c = REPLACEMENT;
        append_utf8(text, c);
    }
    return text;
}

} // namespace clrt
