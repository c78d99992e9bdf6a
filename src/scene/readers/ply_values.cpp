// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/ply_values.h"

#include "error.h"
#include "scene/readers/gltf_bytes.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

namespace clrt {

namespace {

template <typename T>
double number_in(const char* bytes) {
    return double(little_endian<T>({bytes, sizeof(T)}, 0));
}

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

} // namespace

void PlyValues::fail(const std::string& expected, const std::string& found) const {
    const bool is_text = header_.format == PlyFormat::ASCII;
    throw SceneError(path_, is_text ? line_ : 0,
                     fmt::format("{}expected {}, found {}", is_text ? "" : fmt::format("byte {}: ", at_),
                                 expected, found));
}

double PlyValues::next(PlyType type) {
    return header_.format == PlyFormat::ASCII ? next_word() : next_binary(type);
}

size_t PlyValues::next_count(PlyType type) {
    const double count = next(type);
    if (!(count >= 0 && count == std::floor(count)))
        fail("the length of a list", fmt::format("{}", count));
    return size_t(std::min(count, 1e15)); // more than any file holds
}

double PlyValues::next_word() {
    for (; at_ < bytes_.size() && is_blank(bytes_[at_]); ++at_)
        line_ += bytes_[at_] == '\n';
    const size_t begin = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_]))
        ++at_;
    std::string_view word = bytes_.substr(begin, at_ - begin);
    if (word.empty())
        fail("a number", "the end of the file");
    const std::string_view digits = word.front() == '+' ? word.substr(1) : word;
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) // as strtod gives it: infinite, or 0
        return digits.find("e-") != digits.npos || digits.find("E-") != digits.npos ? 0 : HUGE_VAL;
    if (error != std::errc() || end != digits.data() + digits.size())
        fail("a number", clrt::quoted(word));
    return value;
}

double PlyValues::next_binary(PlyType type) {
    const size_t size = ply_size(type);
    if (bytes_.size() - at_ < size)
        fail("a number", "the end of the file");
    char value[sizeof(double)] = {};
    std::copy_n(bytes_.data() + at_, size, value);
    if (header_.format == PlyFormat::BIG)
        std::reverse(value, value + size);
    at_ += size;
    switch (type) {
    case PlyType::INT8:
        return number_in<std::int8_t>(value);
    case PlyType::UINT8:
        return number_in<std::uint8_t>(value);
    case PlyType::INT16:
        return number_in<std::int16_t>(value);
    case PlyType::UINT16:
        return number_in<std::uint16_t>(value);
    case PlyType::INT32:
        return number_in<std::int32_t>(value);
    case PlyType::UINT32:
        return number_in<std::uint32_t>(value);
    case PlyType::FLOAT32:
        return number_in<float>(value);
    case PlyType::FLOAT64:
        return number_in<double>(value);
    }
    return 0;
}

} // namespace clrt
