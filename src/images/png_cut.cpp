// SPDX-License-Identifier: Apache-2.0
#include "images/png_cut.h"

#include <string_view>

namespace clrt {

namespace {

constexpr std::string_view SIGNATURE("\x89PNG\r\n\x1a\n", 8);
constexpr std::uint64_t HEAD_BYTES = 8, CHECKSUM_BYTES = 4;

/// The next bytes, fewer at the end of the file.
std::string take(std::istream& file, std::uint64_t count) {
    std::string bytes(count, '\0');
    file.read(bytes.data(), std::streamsize(count));
    bytes.resize(size_t(file.gcount()));
    return bytes;
}

/// Four bytes, most significant first.
std::uint64_t big_endian(const std::string& bytes) {
    std::uint64_t value = 0;
    for (size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

} // namespace

std::optional<std::string> png_cut(std::istream& file, std::uint64_t size) {
    if (take(file, SIGNATURE.size()) != SIGNATURE)
        return std::nullopt;
    bool had_pixels = false;
    for (std::uint64_t position = SIGNATURE.size();;) {
        file.seekg(std::streamoff(position));
        const std::string head = take(file, HEAD_BYTES);
        const bool is_whole = head.size() == HEAD_BYTES;
        const bool has_pixels = is_whole && head.substr(4) == "IDAT";
        const std::uint64_t end = position + HEAD_BYTES + (is_whole ? big_endian(head) + CHECKSUM_BYTES : 0);
        if (end > size && (has_pixels || !had_pixels))
            return "expected " + std::to_string(end) + " bytes or more, found " + std::to_string(size);
        if (end > size || head.substr(4) == "IEND")
            return std::nullopt;
        had_pixels = had_pixels || has_pixels;
        position = end;
    }
}

} // namespace clrt
