// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_bytes.h"

namespace clrt {

namespace {

/// The six bits of a sign; -1: none of base64.
int base64_bits(char c) {
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    const char lower = char(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

} // namespace

std::optional<std::string> decode_base64(std::string_view text) {
    while (!text.empty() && text.back() == '=')
        text.remove_suffix(1);
    if (text.size() % 4 == 1)
        return std::nullopt;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    u32 bits = 0;
    int count = 0;
    for (const char c : text) {
        const int six = base64_bits(c);
        if (six < 0)
            return std::nullopt;
        bits = bits << 6 | u32(six);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(char(bits >> count & 0xff));
        }
    }
    return bytes;
}

std::string decode_percent(std::string_view text) {
    std::string bytes;
    for (size_t i = 0; i < text.size(); ++i) {
        const int high = i + 2 < text.size() && text[i] == '%' ? hex_digit(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
        if (low < 0) {
            bytes.push_back(text[i]);
        } else {
            bytes.push_back(char(16 * high + low));
            i += 2;
        }
    }
    return bytes;
}

} // namespace clrt
